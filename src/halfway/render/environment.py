"""Environments from files: OpenEXR, of one or many layers, and Radiance pictures of any orientation and packing.

    #?RADIANCE                     any name behind the #?
    FORMAT=32-bit_rle_rgbe         and other lines, which are passed over
                                   an empty line
    -Y 512 +X 1024                 512 rows from the top, each of 1024 pixels from the left; +Y, -X and columns first are the others

and pixels of four bytes r g b e, (r g b) 2^(e - 136): one after another; or with runs, where 1 1 1 n stands for the pixel before it n
times more, times 256 for each such pixel before this; or in rows of a newer kind, which begin with 2 2 and the number of columns.

Source: G. Ward, "Real Pixels", Graphics Gems II, 1991; "Radiance File Formats".

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

import re
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ..errors import RenderError
from .assets import require_file

LARGEST_PICTURE = 1 << 27
"""Pixels of an environment, at most: 16,384 x 8,192."""
_PIXELS_PER_BYTE = 1024  # what an even picture is packed to, at most
_HEADER_BYTES = 1 << 16
_HDR = re.compile(
    rb"#\?.*?\n\r?\n([-+][XY]) +(\d{1,9}) +([-+][XY]) +(\d{1,9})[ \t]*\r?\n", re.DOTALL
)
_EXR_ATTRIBUTE = re.compile(rb"([^\0]{1,255})\0[^\0]{1,255}\0(.{4})", re.DOTALL)
_COLOURS = ("r", "g", "b", "red", "green", "blue")
_WHOLE = ("combined", "beauty", "rgba")
"""What programs call the layer of the whole picture; Blender the first."""


def read_environment(path: Path) -> np.ndarray:
    """Radiance of a latitude-longitude picture, float32, shape (height, width, 3), linear RGB; below 0 counts as 0.

    Raises
    ------
    RenderError
        When there is no such file, it is damaged or no picture in colour, or a value is missing.
    """
    suffix = require_file(path, "environment", (".hdr", ".exr"))
    content = path.read_bytes()
    try:
        radiance = _hdr(content) if suffix == ".hdr" else _exr(path, content)
    except _Fault as fault:
        raise RenderError(
            f"{path} {fault}. Save it again, or convert it with another program."
        ) from fault
    n_missing = np.count_nonzero(~np.isfinite(radiance).all(axis=-1))
    if n_missing or radiance.max() <= 0:
        raise RenderError(
            f"{path} has {n_missing:,} of {radiance[..., 0].size:,} pixels that are no number or infinite, and radiance up to "
            f"{np.nanmax(radiance, initial=0):g}: expected none, and some light. Give those pixels a value."
        )
    return np.maximum(radiance, 0)


class _Fault(ValueError):  # noqa: N818
    """What is wrong, as the end of a sentence."""


def _exr(path: Path, content: bytes) -> np.ndarray:
    for window in _windows(content):
        left, top, right, bottom = struct.unpack("<4i", window)
        _require_modest(max(0, right - left + 1) * max(0, bottom - top + 1), content)
    try:
        bitmap: Any = mi.Bitmap(str(path))
        names = [field.name for field in bitmap.struct_()]
    except (RuntimeError, MemoryError, UnicodeDecodeError) as error:
        raise _Fault("is damaged, or of a kind that is not read: expected OpenEXR") from error
    values = np.array(bitmap).reshape(bitmap.height(), bitmap.width(), len(names))
    return values[..., _channels(names)].astype(np.float32)


def _windows(content: bytes) -> Iterator[bytes]:
    """The dataWindow of each part; attributes that claim more bytes than there are would be believed by the reader."""
    at, has_parts = 8, content[5:6] >= b"\x10"
    while content[at : at + 1] != b"\0":
        attribute = _EXR_ATTRIBUTE.match(content, at)
        end = attribute.end() + int.from_bytes(attribute[2], "little") if attribute else 0
        if attribute is None or end > len(content):
            raise _Fault("is damaged: expected an OpenEXR header that fits into the file")
        if attribute[1] == b"dataWindow":
            yield content[end - 16 : end]
        at = end + 1 if has_parts and content[end : end + 1] == b"\0" else end


def _channels(names: Sequence[str]) -> list[int]:
    """Which channels are R, G and B: bare, else of the layer of the whole picture, else of the only one in colour; or grey."""
    if "Y" in names and set(names) <= {"Y", "A"}:
        return [names.index("Y")] * 3
    layers: dict[str, dict[str, int]] = {}
    for i, name in enumerate(names):
        layer, _, channel = name.rpartition(".")
        if channel.lower() in _COLOURS:
            layers.setdefault(layer, {})[channel[0].lower()] = i
    coloured = [layer for layer, found in layers.items() if len(found) == len("rgb")]
    bare = [layer for layer in coloured if not layer]
    whole = [layer for layer in coloured if layer.rpartition(".")[2].lower() in _WHOLE]
    only = next((some for some in (bare, whole, coloured) if len(some) == 1), None)
    if only is None:
        said = ", ".join(names)
        raise _Fault(
            f"has the channels {said[:200]}: expected R, G and B, or one layer that has them"
        )
    return [layers[only[0]][colour] for colour in "rgb"]


def _hdr(content: bytes) -> np.ndarray:
    header = _HDR.match(content, 0, _HEADER_BYTES)
    if header is None or header[1][1:] == header[3][1:]:
        raise _Fault(
            "does not begin as a Radiance picture: expected #?RADIANCE ... and a size such as -Y 512 +X 1024"
        )
    if b"32-bit_rle_xyze" in header[0]:
        raise _Fault("has pixels in XYZ: expected RGB (FORMAT=32-bit_rle_rgbe)")
    first, second = int(header[2]), int(header[4])
    _require_modest(first * second, content)
    body = content[header.end() :]
    newer = 8 <= second < 1 << 15 and body.startswith(_row_head(second))
    rgbe = (_rows if newer else _pixels)(body, first, second)
    radiance = np.ldexp(rgbe[..., :3].astype(np.float32), rgbe[..., 3:].astype(int) - 136)
    return _upright(np.where(rgbe[..., 3:], radiance, 0), header[1], header[3])


def _row_head(n_columns: int) -> bytes:
    """How a row with the newer runs begins."""
    return b"\2\2" + n_columns.to_bytes(4, "big")[2:]


def _rows(body: bytes, n_rows: int, n_columns: int) -> np.ndarray:
    """Bytes of pixels in rows of four planes: all r, then g, b, e; behind n are n bytes, or behind 128 + n one that stands n times."""
    head, size = _row_head(n_columns), 4 * n_columns
    planes = bytearray()
    at = 0
    try:
        for row in range(n_rows):
            at += len(head) if body.startswith(head, at) else len(body)
            while len(planes) < size * (row + 1):
                n = body[at]
                planes += (
                    body[at + 1 : at + 2] * (n - 128) if n > 128 else body[at + 1 : at + 1 + n]
                )
                at += 2 if n > 128 else 1 + n
    except IndexError:
        pass  # the file is at its end
    if len(planes) != size * n_rows:
        raise _Fault(f"holds {len(planes) // 4:,} pixels: expected {n_rows:,} x {n_columns:,}")
    return np.moveaxis(np.frombuffer(planes, np.uint8).reshape(n_rows, 4, n_columns), 1, 2)


def _pixels(body: bytes, n_rows: int, n_columns: int) -> np.ndarray:
    """Bytes of pixels that are written one after another, with runs of whole pixels."""
    rgbe = np.frombuffer(body, np.uint8, len(body) // 4 * 4).reshape(-1, 4)
    run = (rgbe[:, :3] == 1).all(axis=1)
    pixel = np.maximum.accumulate(np.where(run, -1, np.arange(len(run))))  # that a run repeats
    place = np.arange(len(run)) - pixel - 1
    times = np.where(run, rgbe[:, 3].astype(np.int64) << 8 * np.clip(place, 0, 3), 1)
    n_pixels = int(times.sum())
    if n_pixels < n_rows * n_columns or (len(pixel) and pixel[0] < 0):
        raise _Fault(f"holds {n_pixels:,} pixels: expected {n_rows:,} x {n_columns:,}")
    ends = np.minimum(np.cumsum(times), n_rows * n_columns)
    return rgbe[np.repeat(pixel, np.diff(ends, prepend=0))].reshape(n_rows, n_columns, 4)


def _upright(picture: np.ndarray, first: bytes, second: bytes) -> np.ndarray:
    """Rows from the top, pixels from the left, of a picture with these axes in the order of the file."""
    if first.endswith(b"X"):
        picture = picture.swapaxes(0, 1)
    axes = {first, second}
    return picture[:: -1 if b"+Y" in axes else 1, :: -1 if b"-X" in axes else 1]


def _require_modest(n_pixels: int, content: bytes) -> None:
    """Refuse a picture that states none, or more pixels than its bytes can stand for, before memory is taken for them."""
    most = min(LARGEST_PICTURE, _PIXELS_PER_BYTE * len(content))
    if not 0 < n_pixels <= most:
        raise _Fault(
            f"states {n_pixels:,} pixels in {len(content):,} bytes: expected 1 to {most:,}"
        )
