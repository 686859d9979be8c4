"""Pictures as files: tone mapping, strips, contact sheets, animations.

A picture is linear RGB radiance, float32, shape (height, width, 3). What a screen shows is its sRGB coding (IEC
61966-2-1) after an exposure in stops, clipped at white; nothing else is done to the colours:

    s = to_srgb(2^exposure x)                   (`halfway.colour`)

8-bit pictures (uint8, the same shape) are taken as already coded.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import chain, zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..colour import to_srgb
from ..errors import OutputError
from ..files import replacing, suffix_of

PAPER = 255
INK = (70, 70, 70)
WRITTEN = (".png", ".jpg", ".jpeg", ".webp", ".exr")
MOST_STOPS = 64
"""Of an exposure, up or down."""
MOST_FPS = 240
ANIMATED = (".webp", ".gif", ".mp4")


def require_exposure(exposure: float) -> None:
    """Refuse one that shows nothing.

    Raises
    ------
    OutputError
        Says what is expected.
    """
    if not abs(exposure) <= MOST_STOPS:
        raise OutputError(
            f"an exposure of {exposure:g} stops shows nothing: expected {-MOST_STOPS} to {MOST_STOPS}."
        )


def to_8_bit(image: np.ndarray, *, exposure: float = 0.0) -> np.ndarray:
    """The 8-bit sRGB coding of a linear picture, ``exposure`` stops brighter."""
    require_exposure(exposure)
    if image.dtype == np.uint8:
        return image
    return np.round(255 * to_srgb(image * np.float32(2.0**exposure))).astype(np.uint8)


def write(path: Path | str, image: np.ndarray, *, exposure: float = 0.0) -> None:
    """Write a picture; the suffix says how. ``.exr`` keeps linear radiance (float32) and takes no exposure.

    Raises
    ------
    OutputError
        When the suffix is of no known kind, or the file cannot be written.
    """
    path = Path(path)
    suffix = suffix_of(path, WRITTEN, what="kind of picture")
    if image.dtype == np.uint8:
        require_8_bit(path)
    with replacing(path) as temporary:
        if suffix == ".exr":
            _write_exr(temporary, image)
        else:
            Image.fromarray(to_8_bit(image, exposure=exposure)).save(temporary, quality=92)


def require_8_bit(path: Path) -> None:
    """Refuse a file of linear radiance for what has labels: strips and sheets.

    Raises
    ------
    OutputError
        Says what is expected.
    """
    if path.suffix.lower() == ".exr":
        raise OutputError(
            f"{path} is for linear pictures: strips and sheets are 8-bit. Write .png, or a folder with --format exr."
        )


def strip(
    images: Sequence[np.ndarray], *, labels: Sequence[str] = (), exposure: float = 0.0
) -> np.ndarray:
    """Pictures side by side in one row, 8-bit, each with its label under it."""
    return sheet(images, labels=labels, columns=len(images), exposure=exposure)


def sheet(
    images: Sequence[np.ndarray],
    *,
    labels: Sequence[str] = (),
    columns: int | None = None,
    exposure: float = 0.0,
) -> np.ndarray:
    """Pictures row by row, 8-bit, each with its label under it; about as wide as high unless ``columns`` says."""
    if not images:
        raise OutputError("a contact sheet of no pictures: expected one or more.")
    columns = columns or max(1, round(len(images) ** 0.5))
    tiles = [
        _labelled(to_8_bit(image, exposure=exposure), label if labels else None)
        for image, label in zip_longest(images, labels, fillvalue="")
        if isinstance(image, np.ndarray)
    ]
    gap = max(2, tiles[0].shape[1] // 64)
    rows = [tiles[i : i + columns] for i in range(0, len(tiles), columns)]
    rows[-1] += [np.full_like(tiles[0], PAPER)] * (len(rows[0]) - len(rows[-1]))
    return _spaced([_spaced(row, gap, axis=1) for row in rows], gap, axis=0)


def animate(
    path: Path | str, images: Iterable[np.ndarray], *, fps: float = 12, exposure: float = 0.0
) -> None:
    """Write pictures as an animation: ``.webp`` or ``.gif``, which repeat, or ``.mp4`` (H.264; needs the extra ``video``).

    Raises
    ------
    OutputError
        When the suffix is of no known kind, there are no pictures, ``fps`` is out of range, or the file cannot be written.
    """
    path = Path(path)
    suffix = suffix_of(path, ANIMATED, what="kind of animation")
    if not 0 < fps <= MOST_FPS:
        raise OutputError(f"{fps} frames per second are no animation: expected 1 to {MOST_FPS}.")
    coded = (to_8_bit(image, exposure=exposure) for image in images)
    first = next(coded, None)
    if first is None:
        raise OutputError(f"{path} would be an animation of no pictures: expected one or more.")
    write_frames = _write_mp4 if suffix == ".mp4" else _write_loop
    with replacing(path) as temporary:
        write_frames(temporary, chain([first], coded), fps)


def _write_loop(path: Path, frames: Iterable[np.ndarray], fps: float) -> None:
    """Through Pillow, for ever. WebP drops frames that look alike to its quality: at the highest a slow route keeps its steps."""
    first, *rest = map(Image.fromarray, frames)
    options: dict[str, Any] = (
        {"quality": 100, "method": 4} if path.suffix.lower() == ".webp" else {}
    )
    first.save(
        path, save_all=True, append_images=rest, duration=round(1000 / fps), loop=0, **options
    )


def _write_mp4(path: Path, frames: Iterable[np.ndarray], fps: float) -> None:
    """H.264 through PyAV, once; an odd last row or column is left out, as the format takes none."""
    try:
        import av
    except ImportError as error:
        raise OutputError(
            f"{path.suffix} needs the package av, which is not installed: "
            "run pip install av, or write .webp or .gif."
        ) from error
    first, *rest = frames
    height, width = (size // 2 * 2 for size in first.shape[:2])
    with av.open(str(path), "w") as container:
        stream: Any = container.add_stream("libx264", rate=Fraction(fps).limit_denominator(1000))
        stream.height, stream.width, stream.pix_fmt = height, width, "yuv420p"
        stream.options = {"crf": "16", "preset": "slow"}
        for frame in (first, *rest):
            even = np.ascontiguousarray(frame[:height, :width])
            container.mux(stream.encode(av.VideoFrame.from_ndarray(even, format="rgb24")))
        container.mux(stream.encode())


def _write_exr(path: Path, image: np.ndarray) -> None:
    from .variant import load_mitsuba

    mi = load_mitsuba()
    mi.Bitmap(np.ascontiguousarray(image, np.float32)).write(str(path))


def _labelled(tile: np.ndarray, label: str | None) -> np.ndarray:
    """The tile with its label in a margin below."""
    if label is None:
        return tile
    width = tile.shape[1]
    size = max(9, width // 18)
    margin = Image.new("RGB", (width, round(1.9 * size)), (PAPER, PAPER, PAPER))
    font = ImageFont.load_default(size)
    ImageDraw.Draw(margin).text((width / 2, 0.9 * size), label, fill=INK, font=font, anchor="mm")
    return np.concatenate([tile, np.array(margin)])


def _spaced(tiles: Sequence[np.ndarray], gap: int, *, axis: int) -> np.ndarray:
    """Tiles next to each other along an axis, with paper between them."""
    shape = list(tiles[0].shape)
    shape[axis] = gap
    paper = np.full(shape, PAPER, np.uint8)
    parts = [part for tile in tiles for part in (paper, tile)]
    return np.concatenate(parts[1:], axis=axis)
