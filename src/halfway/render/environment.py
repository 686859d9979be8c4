"""Environments from files: OpenEXR, of one or many layers, and Radiance pictures.

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
from .radiance import PictureFault, parse_radiance, require_modest

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
        radiance = parse_radiance(content) if suffix == ".hdr" else _exr(path, content)
    except PictureFault as fault:
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


def _exr(path: Path, content: bytes) -> np.ndarray:
    """The colour of an OpenEXR file, which Mitsuba reads."""
    for window in _windows(content):
        left, top, right, bottom = struct.unpack("<4i", window)
        require_modest(max(0, right - left + 1) * max(0, bottom - top + 1), content)
    try:
        bitmap: Any = mi.Bitmap(str(path))
        names = [field.name for field in bitmap.struct_()]
    except (RuntimeError, MemoryError, UnicodeDecodeError) as error:
        raise PictureFault("is damaged, or of a kind that is not read: expected OpenEXR") from error
    values = np.array(bitmap).reshape(bitmap.height(), bitmap.width(), len(names))
    return values[..., _channels(names)].astype(np.float32)


def _windows(content: bytes) -> Iterator[bytes]:
    """The dataWindow of each part; attributes that claim more bytes than there are would be believed by the reader."""
    at, has_parts = 8, content[5:6] >= b"\x10"
    while content[at : at + 1] != b"\0":
        attribute = _EXR_ATTRIBUTE.match(content, at)
        end = attribute.end() + int.from_bytes(attribute[2], "little") if attribute else 0
        if attribute is None or end > len(content):
            raise PictureFault("is damaged: expected an OpenEXR header that fits into the file")
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
    coloured = [layer for layer, channels in layers.items() if len(channels) == len("rgb")]
    bare = [layer for layer in coloured if not layer]
    whole = [layer for layer in coloured if layer.rpartition(".")[2].lower() in _WHOLE]
    only = next((some for some in (bare, whole, coloured) if len(some) == 1), None)
    if only is None:
        said = ", ".join(names)
        raise PictureFault(
            f"has the channels {said[:200]}: expected R, G and B, or one layer that has them"
        )
    return [layers[only[0]][colour] for colour in "rgb"]
