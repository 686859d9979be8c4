r"""PLY files of triangles, text or binary.

    ply
    format binary_little_endian 1.0            or binary_big_endian, or ascii
    element vertex N                           then each property of a vertex, in order
    property float x
    element face M
    property list uchar int vertex_indices     a count (3) and as many indices
    end_header

and then the elements, in the header's order. Sizes are checked against the file before memory is taken, and indices against the
vertices: the renderer's own reader believes both, and a wrong one ends the process.

Source: G. Turk, "The PLY Polygon File Format", 1994.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RenderError
from .mesh import Mesh, outward

_TYPES = {
    name: code
    for code, names in {
        "i1": "char int8", "u1": "uchar uint8", "i2": "short int16", "u2": "ushort uint16",
        "i4": "int int32", "u4": "uint uint32", "f4": "float float32", "f8": "double float64",
    }.items()
    for name in names.split()
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_INDICES = ("vertex_indices", "vertex_index")
_LONGEST_HEADER = 1 << 16


class _PlyError(ValueError):
    """What is wrong, as the end of a sentence."""


@dataclass(frozen=True)
class _Element:
    name: str
    size: int
    dtype: np.dtype
    """Of one row; the list of a face is a count and three indices."""


def read_ply(path: Path) -> Mesh:
    """The triangles of a PLY file, y up in the file, faces turned outward.

    Raises
    ------
    RenderError
        When it is no PLY file, is truncated, has other faces than triangles, or names vertices that it has not.
    """
    try:
        return outward(*_arrays(path.read_bytes()))
    except _PlyError as error:
        raise RenderError(
            f"{path} {error}. Export it again, or convert it with another program."
        ) from error


def _arrays(content: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, normals (empty where there are none) and faces."""
    elements, order, start = _header(content)
    rows = _text_rows(content[start:], elements) if order == "" else _rows(content, start, elements)
    if not {"vertex", "face"} <= set(rows):
        raise _PlyError("has no vertices or no faces: expected both")
    vertices, faces = rows["vertex"], rows["face"]
    if (faces["count"] != 3).any():
        raise _PlyError("has faces of other than three corners: expected triangles")
    indices = faces["corners"].astype(np.int64)
    if not len(indices) or indices.min() < 0 or indices.max() >= len(vertices):
        span = f"{indices.min()} to {indices.max()}" if len(indices) else "none"
        raise _PlyError(
            f"has {len(indices):,} triangles of vertices {span}: expected some, of vertices 0 to {len(vertices) - 1:,}"
        )
    names = vertices.dtype.names or ()
    positions, normals = (
        np.stack([vertices[axis] for axis in axes], axis=-1).astype(float) if set(axes) <= set(names) else np.zeros((0, 3))
        for axes in (("x", "y", "z"), ("nx", "ny", "nz"))
    )  # fmt: skip
    if not len(positions) or not np.isfinite(positions).all():
        raise _PlyError("has vertices without a finite place: expected finite x, y and z")
    return positions, normals, indices


def _header(content: bytes) -> tuple[list[_Element], str, int]:
    """The elements, the byte order ("" for text), and where the data begin."""
    end = content.find(b"end_header", 0, _LONGEST_HEADER)
    start = content.find(b"\n", end) + 1
    lines = content[: max(end, 0)].decode("ascii", errors="replace").split("\n")
    if not content.startswith(b"ply") or end < 0 or not start:
        raise _PlyError("does not begin as a PLY file: expected ply ... end_header")
    order, elements = None, list[_Element]()
    fields: list[tuple[str, str] | tuple[str, str, int]] = []
    for words in map(str.split, lines[1:]):
        match words:
            case ["format", kind, "1.0"] if kind in _ORDERS:
                order = _ORDERS[kind]
            case ["element", name, size] if size.isdecimal() and len(size) < 19:
                fields = []
                elements.append(_Element(name, int(size), np.dtype([])))
            case ["property", "list", count, index, name] if elements and {count, index} <= _TYPES.keys() and name in _INDICES:  # fmt: skip
                fields += [("count", _TYPES[count]), ("corners", _TYPES[index], 3)]
            case ["property", type_, name] if elements and type_ in _TYPES:
                fields.append((name, _TYPES[type_]))
            case ["comment" | "obj_info", *_] | []:
                continue
            case _:
                raise _PlyError(f"has the line {' '.join(words)[:60]!r} in its header, which is none that is read")  # fmt: skip
        if elements and fields:
            elements[-1] = _with_fields(elements[-1], fields, order or "")
    if order is None:
        raise _PlyError("states no format: expected ascii, binary_little_endian or binary_big_endian")  # fmt: skip
    return elements, order, start


def _with_fields(element: _Element, fields: list, order: str) -> _Element:
    names = [field[0] for field in fields]
    if len(set(names)) < len(names):
        raise _PlyError(f"names a property of {element.name[:20]!r} twice")
    dtype = np.dtype([(name, order + code, *shape) for name, code, *shape in fields])
    return _Element(element.name, element.size, dtype)


def _rows(content: bytes, start: int, elements: list[_Element]) -> dict[str, np.ndarray]:
    rows: dict[str, np.ndarray] = {}
    for element in elements:
        end = start + element.size * element.dtype.itemsize
        if end > len(content):
            raise _PlyError(
                f"ends after {len(content):,} bytes, its header says {end:,} or more: it is truncated, or has other faces than triangles"
            )
        if element.dtype.itemsize:
            rows[element.name] = np.frombuffer(content, element.dtype, element.size, start)
        start = end
    return rows


def _text_rows(content: bytes, elements: list[_Element]) -> dict[str, np.ndarray]:
    """The same of text, a number for each value."""
    try:
        values = np.array(content.split(), np.float64)
    except ValueError as error:
        raise _PlyError("has something else than numbers after its header") from error
    rows: dict[str, np.ndarray] = {}
    start = 0
    for element in elements:
        flat = np.dtype([(name, "f8", *element.dtype[name].shape) for name in element.dtype.names or ()])  # fmt: skip
        width = flat.itemsize // 8
        end = start + element.size * width
        if end > len(values):
            raise _PlyError(
                f"has {len(values):,} numbers, its header says {end:,} or more: it is truncated, or has other faces than triangles"
            )
        if width:
            rows[element.name] = values[start:end].view(flat)
        start = end
    return rows
