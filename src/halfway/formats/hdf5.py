r"""HDF5, as much of it as Keras writes: groups, arrays of floats, and attributes that are lists of strings.

    superblock, version 0      b"\x89HDF\r\n\x1a\n" ... the address of the root's object header
    object header, version 1   messages: what an object is, one after the other, in one block or several
        1 dataspace            the shape
        3 datatype             float32 or float64 (little endian), strings of a fixed length
        8 layout               where the array is, in one piece
        12 attribute           name, datatype, dataspace, value
        16 continuation        where more messages are
        17 symbol table        a group: the addresses of its B-tree and of the heap of its names
    B-tree, version 1          nodes of nodes, and in the end of lists of (name, object header)

Everything else (chunks, filters, links to other files, newer layouts) is refused. The C library reads all of HDF5 and
trusts what it reads: one wrong byte can make it go round for ever, which nothing in this process can stop. Here an object's
blocks and a group's nodes may not be longer together than the file, so that nothing goes round.

Source: The HDF Group, "HDF5 File Format Specification Version 2.0".
"""

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

MAGIC = b"\x89HDF\r\n\x1a\n"

_DATASPACE, _DATATYPE, _LAYOUT, _ATTRIBUTE, _CONTINUATION, _SYMBOL_TABLE = 1, 3, 8, 12, 16, 17
_CONTIGUOUS = 1
_MAX_DIMENSIONS = 8
_LONGEST_NAME = 1024
# Class and version, three bytes of flags, size; then where sign, exponent and mantissa are.
_FLOATS = {
    bytes.fromhex("11201f0004000000 0000200017080017 7f000000"): "<f4",
    bytes.fromhex("11203f0008000000 00004000340b0034 ff030000"): "<f8",
}


class Hdf5Error(ValueError):
    """The file is damaged, or holds what is not read here; the message is the end of a sentence."""


@dataclass(frozen=True)
class Hdf5Object:
    """A group or an array."""

    _bytes: "_Bytes"
    _address: int

    def __getitem__(self, path: str) -> "Hdf5Object":
        """What a group holds under ``path``, names with ``/`` between."""
        inner = self
        for name in filter(None, path.split("/")):
            if name not in inner._members:
                raise Hdf5Error(f"there is no {path[:100]!r}")
            inner = Hdf5Object(self._bytes, inner._members[name])
        return inner

    def __contains__(self, name: str) -> bool:
        return name in self._members

    @property
    def names(self) -> tuple[str, ...]:
        """What a group holds, by name; none where this is no group."""
        return tuple(self._members)

    def strings(self, attribute: str, *, most: int) -> list[str] | None:
        """The strings of an attribute, ``most`` of them or fewer; None where there is no such attribute."""
        for kind, message in self._messages:
            if kind == _ATTRIBUTE:
                name, datatype, shape, value = _attribute(message)
                if name == attribute:
                    if math.prod(shape) > most:
                        raise Hdf5Error(
                            f"{name} lists {math.prod(shape):,}: at most {most} are read"
                        )
                    return _strings(self._bytes, datatype, math.prod(shape), value)
        return None

    def array(self) -> np.ndarray:
        """The values, float32 or float64."""
        shape = _shape(self._message(_DATASPACE))
        datatype = self._message(_DATATYPE)
        layout = self._message(_LAYOUT)
        version, kind, address, _ = layout.unpack(0, "<BBQQ")
        if (version, kind) != (3, _CONTIGUOUS):
            raise Hdf5Error("an array is stored in chunks or in another layout than Keras uses")
        dtype = _FLOATS.get(datatype.take(0, min(20, len(datatype))))
        if dtype is None:
            raise Hdf5Error("an array holds something else than little-endian float32 or float64")
        if max(shape, default=1) > len(self._bytes) or not math.prod(shape):
            raise Hdf5Error("an array is empty or longer than the file")
        content = self._bytes.take(address, math.prod(shape) * np.dtype(dtype).itemsize)
        return np.frombuffer(content, dtype).reshape(shape)

    def _message(self, wanted: int) -> "_Bytes":
        for kind, message in self._messages:
            if kind == wanted:
                return message
        raise Hdf5Error("an object is no array")

    @cached_property
    def _messages(self) -> list[tuple[int, "_Bytes"]]:
        """The object header's messages, with their types."""
        version, _, _, _, n_bytes = self._bytes.unpack(self._address, "<BBHII")
        if version != 1:
            raise Hdf5Error("an object has a header of another version than Keras writes")
        blocks = [(self._address + 16, n_bytes)]
        messages: list[tuple[int, _Bytes]] = []
        left = len(self._bytes)
        for start, n_bytes in blocks:
            left -= n_bytes
            if left < 0:
                raise Hdf5Error("an object's header is longer than the file")
            for kind, message in _messages(self._bytes.part(start, n_bytes)):
                messages.append((kind, message))
                if kind == _CONTINUATION:
                    start, n_bytes = message.unpack(0, "<QQ")
                    blocks.append((start, n_bytes))
        return messages

    @cached_property
    def _members(self) -> dict[str, int]:
        """Addresses of the object headers of what a group holds, by name."""
        tables = [message for kind, message in self._messages if kind == _SYMBOL_TABLE]
        if not tables:
            return {}
        tree, heap = tables[0].unpack(0, "<QQ")
        signature, _, n_bytes, _, at = self._bytes.unpack(heap, "<4s4sQQQ")
        if signature != b"HEAP":
            raise Hdf5Error("a group has no heap of names")
        names = self._bytes.part(at, n_bytes)
        return {names.text(name): header for name, header in _entries(self._bytes, tree)}


def read_hdf5(content: bytes) -> Hdf5Object:
    """The root of the file with this content.

    Raises
    ------
    Hdf5Error
        Here and from all that is asked of the root: when the file is damaged, or uses more of HDF5 than is read here.
    """
    whole = _Bytes(content)
    magic, version, *_ = whole.unpack(0, "<8sB")
    if magic != MAGIC or version != 0 or whole.unpack(13, "<BB") != (8, 8):
        raise Hdf5Error("its superblock is of another version than Keras writes")
    (root,) = whole.unpack(64, "<Q")
    return Hdf5Object(whole, root)


@dataclass(frozen=True)
class _Bytes:
    """Some of the file's bytes; nothing beyond them is read."""

    content: bytes = field(repr=False)

    def __len__(self) -> int:
        return len(self.content)

    def take(self, start: int, n_bytes: int) -> bytes:
        if start + n_bytes > len(self.content):
            raise Hdf5Error(
                f"byte {start + n_bytes} is asked for where there are {len(self.content)}"
            )
        return self.content[start : start + n_bytes]

    def part(self, start: int, n_bytes: int) -> "_Bytes":
        return _Bytes(self.take(start, n_bytes))

    def unpack(self, start: int, format_: str) -> tuple[Any, ...]:
        return struct.unpack(format_, self.take(start, struct.calcsize(format_)))

    def text(self, start: int) -> str:
        """The characters up to the next 0."""
        end = self.content.find(b"\0", start, start + _LONGEST_NAME)
        if end < 0:
            raise Hdf5Error("a name has no end")
        return self.content[start:end].decode("utf-8", errors="backslashreplace")


def _messages(block: _Bytes) -> Iterator[tuple[int, _Bytes]]:
    at = 0
    while at + 8 <= len(block):
        kind, n_bytes = block.unpack(at, "<HH")
        yield kind, block.part(at + 8, n_bytes)
        at += 8 + n_bytes


def _entries(whole: _Bytes, tree: int) -> Iterator[tuple[int, int]]:
    """Where a group's names are in its heap, and their object headers, from the leaves of its B-tree."""
    nodes = [tree]
    left = len(whole)
    for node in nodes:
        signature, kind, _, n = whole.unpack(node, "<4sBBH")
        left -= 8 + 16 * n
        if left < 0:
            raise Hdf5Error("a group's B-tree is longer than the file")
        if signature == b"SNOD":
            for i in range(n):
                name, header = whole.unpack(node + 8 + 40 * i, "<QQ")
                yield name, header
        elif signature == b"TREE" and kind == 0:
            nodes.extend(whole.unpack(node + 32 + 16 * i, "<Q")[0] for i in range(n))
        else:
            raise Hdf5Error("a group has no B-tree of names")


def _attribute(message: _Bytes) -> tuple[str, _Bytes, tuple[int, ...], _Bytes]:
    """Name, datatype, shape and value. Version 1 pads its parts to 8 bytes; version 3 does not, and says the alphabet."""
    version, _, *sizes = message.unpack(0, "<BBHHH")
    if version not in (1, 3):
        raise Hdf5Error("an attribute is of another version than Keras writes")
    at = 8 if version == 1 else 9
    parts: list[_Bytes] = []
    for n_bytes in sizes:
        parts.append(message.part(at, n_bytes))
        at += -(-n_bytes // 8) * 8 if version == 1 else n_bytes
    name, datatype, dataspace = parts
    return name.text(0), datatype, _shape(dataspace), message.part(at, len(message) - at)


def _shape(dataspace: _Bytes) -> tuple[int, ...]:
    version, n_dimensions = dataspace.unpack(0, "<BB")
    if version not in (1, 2) or n_dimensions > _MAX_DIMENSIONS:
        raise Hdf5Error("a shape is of another version than Keras writes, or has many dimensions")
    return dataspace.unpack(8 if version == 1 else 4, f"<{n_dimensions}Q")


def _strings(whole: _Bytes, datatype: _Bytes, n: int, value: _Bytes) -> list[str]:
    """Strings of a fixed length, padded by 0, or each in a heap that the whole file shares."""
    if n == 0:
        return []
    kind, flags, n_bytes = datatype.unpack(0, "<B3sI")
    match kind & 15, flags[0] & 15:
        case (3, _):
            strings = [value.take(i * n_bytes, n_bytes).rstrip(b"\0") for i in range(n)]
        case (9, 1):
            strings = [_shared(whole, *value.unpack(16 * i, "<IQI")) for i in range(n)]
        case _:
            raise Hdf5Error("a list of names holds something else than strings")
    return [string.decode("utf-8", errors="backslashreplace") for string in strings]


def _shared(whole: _Bytes, n_bytes: int, heap: int, wanted: int) -> bytes:
    """The first bytes of an object in a global heap, which numbers its objects; 0 is what is free at its end."""
    signature, _, end = whole.unpack(heap, "<4s4sQ")
    if signature != b"GCOL":
        raise Hdf5Error("a list of names leads to no heap")
    at = 16
    while at + 16 <= end:
        index, _, _, size = whole.unpack(heap + at, "<HHIQ")
        if index == wanted:
            return whole.take(heap + at + 16, min(n_bytes, size))
        if index == 0:
            break
        at += 16 + -(-size // 8) * 8
    raise Hdf5Error("a list of names leads nowhere")
