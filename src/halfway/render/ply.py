r"""PLY files of polygons, text or binary.

    ply
    format binary_little_endian 1.0            or binary_big_endian, or ascii
    element vertex N                           then each property of a vertex, in order
    property float x
    element face M
    property list uchar int vertex_indices     a count and as many indices
    end_header

and then the elements, in the header's order. Elements and properties of other names, such as colours, are passed over. A
text is read as the same bytes with a double for every number. Sizes are checked against the file before memory is taken: the renderer's
own reader believes them, and a wrong one ends the process.

Source: G. Turk, "The PLY Polygon File Format", 1994.
"""

import re
import struct
from typing import NamedTuple

import numpy as np

from .polygons import MeshFault, Polygons

_TYPES = {
    name: code
    for code, names in {
        "i1": "char int8", "u1": "uchar uint8", "i2": "short int16", "u2": "ushort uint16",
        "i4": "int int32", "u4": "uint uint32", "f4": "float float32", "f8": "double float64",
    }.items()
    for name in names.split()
}  # fmt: skip
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">"}
_HEADER = re.compile(
    rb"ply[ \t]*(?:\r\n|\n|\r)(.*?)[\r\n]end_header[ \t]*(?:\r\n|\n|\r)", re.DOTALL
)
_TEXTURES = ("u", "v"), ("s", "t"), ("texture_u", "texture_v")
"""What programs call texture coordinates."""
_LONGEST_HEADER = 1 << 16
LARGEST_INDEX = 1 << 32


class _Property(NamedTuple):
    name: str
    dtype: np.dtype
    length: np.dtype | None
    """Of a list: the type of the number that says how long it is."""

    @property
    def least(self) -> int:
        """Bytes in a row, or more."""
        return (self.dtype if self.length is None else self.length).itemsize


class _Element(NamedTuple):
    name: str
    size: int
    properties: list[_Property]


class _Column(NamedTuple):
    """Where a property stands in each row of its element."""

    property: _Property
    offsets: np.ndarray


def parse_ply(content: bytes) -> Polygons:
    """The polygons of a PLY file; a `MeshFault` where it is none, is truncated, or has no vertices or faces."""
    elements, data = _header(content)
    columns: dict[str, dict[str, _Column]] = {}
    end = 0
    for element in elements:
        columns[element.name], end = _columns(data, end, element)
    vertex, face = (columns.get(name, {}) for name in ("vertex", "face"))
    faces = face.get("vertex_indices") or face.get("vertex_index")
    if faces is None or not {"x", "y", "z"} <= set(vertex):
        raise MeshFault("has no vertices x, y, z or no faces vertex_indices: expected both")
    points, normals = (
        np.stack([_scalars(data, vertex[axis]) for axis in axes], axis=-1).astype(float)
        if set(axes) <= set(vertex)
        else np.zeros((0, 3))
        for axes in (("x", "y", "z"), ("nx", "ny", "nz"))
    )
    scalars = {name for name, column in vertex.items() if column.property.length is None}
    uv = next((names for names in _TEXTURES if set(names) <= scalars), ())
    textures = np.stack([_scalars(data, vertex[name]) for name in uv] or [np.zeros(0)] * 2, axis=-1)
    corners, sizes = _lists(data, faces)
    nothing = np.full(len(corners), -1)
    of_normal = corners if len(normals) else nothing
    of_texture = corners if len(textures) else nothing
    return Polygons(points, normals, corners, of_normal, sizes, textures.astype(float), of_texture)


def _header(content: bytes) -> tuple[list[_Element], bytes]:
    """The elements, and the data as bytes that they describe."""
    header = _HEADER.match(content, 0, _LONGEST_HEADER)
    if header is None:
        raise MeshFault("does not begin as a PLY file: expected ply ... end_header")
    lines = [line.split() for line in header[1].decode("ascii", errors="replace").splitlines()]
    data = content[header.end() :]
    match next((line for line in lines if line[:1] == ["format"]), []):
        case ["format", "ascii", "1.0"]:
            return _elements(lines, None), _numbers(data)
        case ["format", kind, "1.0"] if kind in _ORDERS:
            return _elements(lines, _ORDERS[kind]), data
        case line:
            raise MeshFault(
                f"is of the format {' '.join(line[1:])[:60]!r}: expected ascii, {' or '.join(_ORDERS)}, 1.0"
            )


def _elements(lines: list[list[str]], order: str | None) -> list[_Element]:
    """What the header describes; without a byte order, as doubles."""

    def dtype(name: str) -> np.dtype:
        return np.dtype(order + _TYPES[name] if order else "<f8")

    elements: list[_Element] = []
    for words in lines:
        match words:
            case ["element", name, size] if size.isdecimal() and len(size) < 19:
                elements.append(_Element(name, int(size), []))
            case ["property", "list", count, type_, name] if (
                elements and {count, type_} <= _TYPES.keys()
            ):
                elements[-1].properties.append(_Property(name, dtype(type_), dtype(count)))
            case ["property", type_, name] if elements and type_ in _TYPES:
                elements[-1].properties.append(_Property(name, dtype(type_), None))
            case ["comment" | "obj_info" | "format", *_] | []:
                continue
            case _:
                raise MeshFault(
                    f"has the line {' '.join(words)[:60]!r} in its header, which is none that is read"
                )
    return elements


def _numbers(text: bytes) -> bytes:
    """The numbers of a text, as doubles."""
    try:
        return np.array(text.split(), "<f8").tobytes()
    except ValueError as error:
        raise MeshFault("has something else than numbers after its header") from error


def _columns(data: bytes, start: int, element: _Element) -> tuple[dict[str, _Column], int]:
    """Where the properties of an element stand that starts there, and where it ends."""
    properties = element.properties
    if len({p.name for p in properties}) < len(properties):
        raise MeshFault(f"names a property of {element.name[:20]!r} twice")
    least = [p.least for p in properties]
    end = start + element.size * sum(least)
    _require_room(data, end)
    if any(p.length is not None for p in properties):
        offsets, end = _walk(data, start, element)
    else:
        rows = start + sum(least) * np.arange(element.size if properties else 0)
        offsets = [rows + before for before in np.cumsum(least) - least]
    columns = map(_Column, properties, offsets)
    return {column.property.name: column for column in columns}, end


def _walk(data: bytes, start: int, element: _Element) -> tuple[list[np.ndarray], int]:
    """The offsets of each property, and the end, of an element whose rows differ in length."""
    steps = [(p.dtype.itemsize, _reader(p.length)) for p in element.properties]
    offsets: list[list[int]] = [[] for _ in steps]
    at = start
    for _ in range(element.size):
        for column, (size, count) in zip(offsets, steps, strict=True):
            column.append(at)
            if count is None:
                at += size
                continue
            _require_room(data, at + count.size)
            n = count.unpack_from(data, at)[0]
            if not 0 <= n <= len(data):
                raise MeshFault(
                    f"has a list of {n} values: expected none or more, and no more than the file has"
                )
            at += count.size + size * int(n)
    _require_room(data, at)
    return [np.array(column, np.int64) for column in offsets], at


def _reader(dtype: np.dtype | None) -> struct.Struct | None:
    if dtype is None:
        return None
    return struct.Struct((">" if dtype.byteorder == ">" else "<") + dtype.char)


def _require_room(data: bytes, end: int) -> None:
    if end > len(data):
        raise MeshFault(
            f"has {len(data) / end:.1%} of what its header says, or less: it is truncated"
        )


def _values(data: bytes, dtype: np.dtype, offsets: np.ndarray) -> np.ndarray:
    """The numbers of a type that stand at these offsets."""
    everywhere = np.ndarray(max(len(data) - dtype.itemsize + 1, 0), dtype, data, strides=(1,))
    return everywhere[offsets]


def _scalars(data: bytes, column: _Column) -> np.ndarray:
    if column.property.length is not None:
        raise MeshFault(f"has a list {column.property.name} for each vertex: expected a number")
    return _values(data, column.property.dtype, column.offsets)


def _lists(data: bytes, column: _Column) -> tuple[np.ndarray, np.ndarray]:
    """The values of all lists, one after another, and how many each has."""
    dtype, count = column.property.dtype, column.property.length
    if count is None:
        raise MeshFault(f"has one {column.property.name} for each face: expected a list")
    sizes = _values(data, count, column.offsets).astype(np.int64)
    nth = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    values = _values(
        data, dtype, np.repeat(column.offsets + count.itemsize, sizes) + dtype.itemsize * nth
    )
    # What is no number is no index.
    return np.where(np.abs(values) < LARGEST_INDEX, values, -1).astype(np.int64), sizes
