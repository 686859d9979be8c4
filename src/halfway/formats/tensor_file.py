r"""Tensor files: the container of RGL's `.bsdf` materials. Named arrays in one file, little endian.

    b"tensor_file\0"  u8 1  u8 0  u32 n_fields         the 1 is not looked at: Mitsuba takes any, and others write some
    per field:  u16 length, name, u16 n_dimensions, u8 type, u64 offset, u64 size[n_dimensions]
    the data of each field at its offset, aligned to 8 bytes

Nothing that a file says is believed: offsets, shapes and sizes are checked against its length before a byte is
read, so a damaged or hostile file costs no more memory than its own size.

Source: the reader that comes with the RGL database (rgl-epfl/brdf-loader).
"""

import math
import struct
from collections.abc import Mapping
from io import BufferedIOBase
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..errors import FormatError
from ..files import replacing

MAGIC = b"tensor_file\0"

_DTYPES = {
    code: np.dtype(name)
    for code, name in enumerate(
        ["u1", "i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f2", "<f4", "<f8"], start=1
    )
}
_CODES = {dtype: code for code, dtype in _DTYPES.items()}
_ALIGNMENT = 8
_MAX_FIELDS = 1024
_MAX_DIMENSIONS = 8
_MAX_NAME = 64


class _Field(NamedTuple):
    name: str
    dtype: np.dtype
    offset: int
    shape: tuple[int, ...]

    @property
    def n_bytes(self) -> int:
        return math.prod(self.shape) * self.dtype.itemsize


def read_tensors(file: BufferedIOBase, label: str) -> dict[str, np.ndarray]:
    """The fields of a tensor file by name, as read-only arrays; ``label`` is what messages call it.

    Raises
    ------
    FormatError
        When the file is no tensor file, is truncated, or states fields that it cannot hold.
    """
    start = file.read(len(MAGIC))
    # Of a file that is something else, only these few bytes are read.
    content = start + file.read() if start == MAGIC else start
    return {field.name: _array(content, field) for field in _fields(content, label)}


def write_tensor_file(path: Path, fields: Mapping[str, np.ndarray]) -> None:
    """Write the arrays of ``fields`` as a tensor file; whole or not at all."""
    arrays = {name: np.ascontiguousarray(array) for name, array in fields.items()}
    position = len(_header(arrays, dict.fromkeys(arrays, 0)))
    offsets: dict[str, int] = {}
    for name, array in arrays.items():
        offsets[name] = position = _aligned(position)
        position += array.nbytes
    with replacing(path) as temporary, temporary.open("wb") as file:
        file.write(_header(arrays, offsets))
        for name, array in arrays.items():
            file.write(b"\0" * (offsets[name] - file.tell()))
            file.write(array.data)


def _header(arrays: Mapping[str, np.ndarray], offsets: Mapping[str, int]) -> bytes:
    parts = [MAGIC, struct.pack("<BBI", 1, 0, len(arrays))]
    for name, array in arrays.items():
        encoded = name.encode()
        code = _CODES[array.dtype.newbyteorder("<")]
        parts += [struct.pack("<H", len(encoded)), encoded]
        parts += [struct.pack("<HBQ", array.ndim, code, offsets[name])]
        parts += [struct.pack(f"<{array.ndim}Q", *array.shape)]
    return b"".join(parts)


def _aligned(position: int) -> int:
    return -(-position // _ALIGNMENT) * _ALIGNMENT


def _array(content: bytes, field: _Field) -> np.ndarray:
    flat = np.frombuffer(content, field.dtype, math.prod(field.shape), field.offset)
    return flat.reshape(field.shape)


def _fields(content: bytes, name: str) -> list[_Field]:
    header = _Header(content, name)
    n_fields = header.start()
    fields: dict[str, _Field] = {}
    for _ in range(n_fields):
        field = header.field()
        if field.name in fields:
            raise FormatError(
                f"{name} has two fields named {field.name!r}: a tensor file names each field once. It is damaged."
            )
        fields[field.name] = field
    return list(fields.values())


class _Header:
    """The header's values, one after the other, never past the end."""

    def __init__(self, content: bytes, name: str) -> None:
        self._content = content
        self._name = name
        self._position = 0

    def start(self) -> int:
        """The number of fields."""
        if not self._content.startswith(MAGIC):
            raise FormatError(
                f"{self._name} does not begin as a tensor file ({self._content[:12]!r}): expected {MAGIC!r}. "
                "It is no .bsdf file of the RGL database."
            )
        self._position = len(MAGIC)
        major, minor, n_fields = self._unpack("<BBI")
        if minor != 0:
            raise FormatError(
                f"{self._name} is a tensor file of version {major}.{minor}: only 1.0 is known, and "
                "Mitsuba reads none that does not end in 0."
            )
        if n_fields > _MAX_FIELDS:
            raise FormatError(
                f"{self._name} claims {n_fields} fields: at most {_MAX_FIELDS} are read, a material has about 12. "
                "It is damaged."
            )
        return n_fields

    def field(self) -> _Field:
        (length,) = self._unpack("<H")
        field_name = self._take(length).decode("utf-8", errors="backslashreplace")
        if length > _MAX_NAME or not field_name.isprintable():
            raise FormatError(
                f"{self._name} has a field named {field_name[:20]!r} ({length:,} bytes): expected at most {_MAX_NAME} "
                "printable characters. It is damaged."
            )
        n_dimensions, code, offset = self._unpack("<HBQ")
        if n_dimensions > _MAX_DIMENSIONS:
            raise FormatError(
                f"{self._name}: field {field_name!r} has {n_dimensions} dimensions: at most {_MAX_DIMENSIONS} are "
                "read. It is damaged."
            )
        if code not in _DTYPES:
            raise FormatError(
                f"{self._name}: field {field_name!r} has type {code}: types run from 1 to {len(_DTYPES)}. It is damaged."
            )
        field = _Field(field_name, _DTYPES[code], offset, self._unpack(f"<{n_dimensions}Q"))
        # A size may not exceed the file either where another size is 0 and the field takes no byte.
        if max((field.offset + field.n_bytes, *field.shape)) > len(self._content):
            raise FormatError(
                f"{self._name}: field {field_name!r} of shape {' x '.join(map(str, field.shape))} ends at byte "
                f"{field.offset + field.n_bytes}, the file at {len(self._content)}: it is truncated or damaged; "
                "compare it with the original download."
            )
        return field

    def _unpack(self, format_: str) -> tuple[int, ...]:
        return struct.unpack(format_, self._take(struct.calcsize(format_)))

    def _take(self, n_bytes: int) -> bytes:
        end = self._position + n_bytes
        if end > len(self._content):
            raise FormatError(
                f"{self._name} ends after {len(self._content)} bytes, inside its header: it is truncated; "
                "compare it with the original download."
            )
        taken = self._content[self._position : end]
        self._position = end
        return taken
