"""What a file is, by its first bytes and its size; never by its suffix."""

import math
import struct
from itertools import product

import numpy as np

HEAD_BYTES = 512
"""How many first bytes tell what a file is."""

HDF5 = b"\x89HDF\r\n\x1a\n"
TENSOR_FILE = b"tensor_file\0"
ZIP = (b"PK\x03\x04", b"PK\x05\x06")

MERL_HEADER = struct.Struct("<3i")
MERL_SAMPLES = "little-endian float64"
_ORDERS = {"little-endian": MERL_HEADER, "big-endian": struct.Struct(">3i")}
_SAMPLE_BYTES = {"float64": 8, "float32": 4}
LARGEST_AXIS = 1 << 16
"""Cells along one axis of a MERL table, at most, unless the file's size agrees. Four letters of text are more."""

CSAIL_HEADER = struct.Struct("<16i")
UTIA_BYTES = 3 * 8 * (6 * 48) ** 2

_KNOWN = {
    HDF5: "is an HDF5 file",
    TENSOR_FILE: "is a tensor file",
    ZIP[0]: "is a zip",
    ZIP[1]: "is an empty zip",
    b"\x93NUMPY": "is a NumPy array",
    b"\x89PNG": "is a picture",
    b"\xff\xd8\xff": "is a picture",
    b"%PDF": "is a PDF",
    b"\x1f\x8b": "is compressed by gzip",
}


def kind(head: bytes, n_bytes: int) -> str | None:
    """What a file with these first bytes claims to be: ``"merl"``, ``"nbrdf"``, ``"rgl"``, ``"csail"``,
    ``"utia"``, ``"zip"``, or None of these.
    """
    if head.startswith(HDF5):
        return "nbrdf"
    if head.startswith(TENSOR_FILE):
        return "rgl"
    if head.startswith(ZIP):
        return "zip"
    if _like_csail(head):
        return "csail"
    if _like_merl(head, n_bytes):
        return "merl"
    return "utia" if n_bytes == UTIA_BYTES and _like_reflectances(head) else None


def description(head: bytes) -> str | None:
    """What these first bytes are, as the end of a sentence: "is text"; None where nobody could tell."""
    if not head:
        return "is empty"
    for magic, what in _KNOWN.items():
        if head.startswith(magic):
            return what
    return "is text" if _is_text(head) else None


def merl_bytes(sizes: tuple[int, ...]) -> int:
    """Bytes of a MERL file whose header states these sizes: three int32 and three channels of float64."""
    n_theta_h, n_theta_d, n_phi_d = sizes
    return MERL_HEADER.size + 24 * n_theta_h * n_theta_d * n_phi_d


def merl_like(head: bytes, n_bytes: int) -> str | None:
    """How the file would be a MERL table: `MERL_SAMPLES`, as they are, or in another order or type; None if not."""
    for (order, sizes_as), (samples, n) in product(_ORDERS.items(), _SAMPLE_BYTES.items()):
        sizes = sizes_as.unpack_from(head)
        if min(sizes) > 0 and MERL_HEADER.size + 3 * n * math.prod(sizes) == n_bytes:
            return f"{order} {samples}"
    return None


def _like_merl(head: bytes, n_bytes: int) -> bool:
    if len(head) < MERL_HEADER.size:
        return False
    # A header of small numbers is taken for a MERL table even where it is wrong, so that the reader can say what is.
    small = all(abs(n) <= LARGEST_AXIS for n in MERL_HEADER.unpack_from(head))
    return small or merl_like(head, n_bytes) is not None


def _like_csail(head: bytes) -> bool:
    """A header that a MERL table cannot have: where its samples are, there are flags, and the number of channels."""
    if len(head) < CSAIL_HEADER.size:
        return False
    numbers = CSAIL_HEADER.unpack_from(head)
    sizes, kind, bins, half, channels = numbers[:4], *(numbers[i] for i in (6, 7, 9, 10))
    return all(0 < n <= LARGEST_AXIS for n in sizes) and (kind, bins, channels) == (1, 0, 3) and half in (0, 1)  # fmt: skip


def _like_reflectances(head: bytes) -> bool:
    """Float64 numbers of a size that a BRDF may have."""
    numbers = np.abs(np.frombuffer(head[: len(head) // 8 * 8], "<f8"))
    return bool(((numbers == 0) | ((numbers > 1e-9) & (numbers < 1e6))).all())


def _is_text(head: bytes) -> bool:
    try:
        # The cut may fall inside a character.
        text = head.decode("utf-8", errors="strict" if len(head) < HEAD_BYTES else "ignore")
    except UnicodeDecodeError:
        return False
    return all(c.isprintable() or c in "\t\r\n\f\ufeff" for c in text)
