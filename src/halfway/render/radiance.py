"""Radiance pictures, of any orientation and packing.

    #?RADIANCE                     any name behind the #?
    FORMAT=32-bit_rle_rgbe         and other lines, which are passed over
                                   an empty line
    -Y 512 +X 1024                 512 rows from the top, each of 1024 pixels from the left; +Y, -X and columns first are the others

and pixels of four bytes r g b e, (r g b) 2^(e - 136): one after another; or with runs, where 1 1 1 n stands for the pixel before it n
times more, times 256 for each such pixel before this; or in rows of a newer kind, which begin with 2 2 and the number of columns.

Source: G. Ward, "Real Pixels", Graphics Gems II, 1991; "Radiance File Formats".
"""

import re

import numpy as np

LARGEST_PICTURE = 1 << 27
"""Pixels of an environment, at most: 16,384 x 8,192."""
_PIXELS_PER_BYTE = 1024  # what an even picture is packed to, at most
_LONGEST_HEADER = 1 << 16
_HEADER = re.compile(
    rb"#\?.*?\n\r?\n([-+][XY]) +(\d{1,9}) +([-+][XY]) +(\d{1,9})[ \t]*\r?\n", re.DOTALL
)


class PictureFault(ValueError):  # noqa: N818 (it is caught where the file's name is known)
    """What is wrong with a picture, as the end of a sentence."""


def parse_radiance(content: bytes) -> np.ndarray:
    """Radiance, float32, shape (height, width, 3), linear RGB; a `PictureFault` where it is no such picture, or not whole."""
    header = _HEADER.match(content, 0, _LONGEST_HEADER)
    if header is None or header[1][1:] == header[3][1:]:
        raise PictureFault(
            "does not begin as a Radiance picture: expected #?RADIANCE ... and a size such as -Y 512 +X 1024"
        )
    if b"32-bit_rle_xyze" in header[0]:
        raise PictureFault("has pixels in XYZ: expected RGB (FORMAT=32-bit_rle_rgbe)")
    first, second = int(header[2]), int(header[4])
    require_modest(first * second, content)
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
        raise PictureFault(
            f"holds {len(planes) // 4:,} pixels: expected {n_rows:,} x {n_columns:,}"
        )
    return np.moveaxis(np.frombuffer(planes, np.uint8).reshape(n_rows, 4, n_columns), 1, 2)


def _pixels(body: bytes, n_rows: int, n_columns: int) -> np.ndarray:
    """Bytes of pixels that are written one after another, with runs of whole pixels."""
    rgbe = np.frombuffer(body, np.uint8, len(body) // 4 * 4).reshape(-1, 4)
    run = (rgbe[:, :3] == 1).all(axis=1)
    pixel = np.maximum.accumulate(np.where(run, -1, np.arange(len(run))))  # that a run repeats
    nth = np.arange(len(run)) - pixel - 1
    times = np.where(run, rgbe[:, 3].astype(np.int64) << 8 * np.clip(nth, 0, 3), 1)
    n_pixels = int(times.sum())
    if n_pixels < n_rows * n_columns or (len(pixel) and pixel[0] < 0):
        raise PictureFault(f"holds {n_pixels:,} pixels: expected {n_rows:,} x {n_columns:,}")
    ends = np.minimum(np.cumsum(times), n_rows * n_columns)
    return rgbe[np.repeat(pixel, np.diff(ends, prepend=0))].reshape(n_rows, n_columns, 4)


def _upright(picture: np.ndarray, first: bytes, second: bytes) -> np.ndarray:
    """Rows from the top, pixels from the left, of a picture with these axes in the order of the file."""
    if first.endswith(b"X"):
        picture = picture.swapaxes(0, 1)
    axes = {first, second}
    return picture[:: -1 if b"+Y" in axes else 1, :: -1 if b"-X" in axes else 1]


def require_modest(n_pixels: int, content: bytes) -> None:
    """Refuse a picture that states none, or more pixels than its bytes can stand for, before memory is taken for them."""
    most = min(LARGEST_PICTURE, _PIXELS_PER_BYTE * len(content))
    if not 0 < n_pixels <= most:
        raise PictureFault(
            f"states {n_pixels:,} pixels in {len(content):,} bytes: expected 1 to {most:,}"
        )
