"""Meshes and environments from files.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

import re
import struct
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ..errors import RenderError
from .mesh import Mesh, outward
from .ply import read_ply

LARGEST_PICTURE = 1 << 27
"""Pixels of an environment, at most: 16,384 x 8,192."""
_PIXELS_PER_BYTE = 1024  # what an even picture is packed to, at most
_HEADER_BYTES = 1 << 16
_SIZE = {
    "hdr": rb"\n[-+]Y (\d{1,18}) [-+]X (\d{1,18})\s",
    "exr": rb"dataWindow\0box2i\0\x10\0\0\0(.{16})",
}


def read_mesh(path: Path) -> Mesh:
    """The triangles of a ``.ply`` or ``.obj`` file, y up in the file, faces turned outward."""
    kind = _require_file(path, "mesh", (".ply", ".obj"))
    if kind == "ply":
        return read_ply(path)
    if b"\nf " not in b"\n" + path.read_bytes():
        raise RenderError(f"{path} has no faces: expected one or more (lines f 1 2 3).")
    try:
        with quiet():
            shape = mi.load_dict({"type": kind, "filename": str(path)})
        parameters = mi.traverse(shape)
        faces = np.array(parameters["faces"]).reshape(-1, 3)
        positions = np.array(parameters["vertex_positions"]).reshape(-1, 3)
        normals = np.array(parameters["vertex_normals"]).reshape(-1, 3)
    except RuntimeError as error:
        raise RenderError(f"{path} cannot be read: {_reason(error)}") from error
    if not len(faces) or not np.isfinite(positions).all():
        raise RenderError(
            f"{path} has {len(faces)} triangles and {np.isnan(positions).sum()} missing coordinates: "
            "expected one or more triangles and none missing."
        )
    return outward(positions, normals, faces)


def read_environment(path: Path) -> np.ndarray:
    """Radiance of a latitude-longitude picture, float32, shape (height, width, 3), linear RGB."""
    kind = _require_file(path, "environment", (".hdr", ".exr"))
    _require_modest(path, kind)
    try:
        bitmap = mi.Bitmap(str(path)).convert(
            mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False
        )
    except RuntimeError as error:
        raise RenderError(f"{path} cannot be read: {_reason(error)}") from error
    radiance = np.array(bitmap)
    if not np.isfinite(radiance).all() or radiance.max() <= 0:
        raise RenderError(
            f"{path} has radiance from {radiance.min()} to {radiance.max()}: "
            "expected finite values, some above 0."
        )
    return radiance


def _require_file(path: Path, what: str, suffixes: tuple[str, ...]) -> str:
    """The suffix without its dot."""
    if path.suffix.lower() not in suffixes:
        raise RenderError(
            f"the {what} {path} is of an unknown kind: expected {' or '.join(suffixes)}."
        )
    if not path.is_file():
        raise RenderError(f"there is no {what} {path}: see where you are, or give its whole path.")
    return path.suffix.lower()[1:]


def _require_modest(path: Path, kind: str) -> None:
    """Refuse a picture that states more pixels than its bytes can stand for, before memory is taken for them."""
    with path.open("rb") as file:
        head = file.read(_HEADER_BYTES)
    found = re.search(_SIZE[kind], head, re.DOTALL)
    if found is None:
        return  # the reader says what is wrong
    if kind == "hdr":
        n_pixels = int(found[1]) * int(found[2])
    else:
        left, top, right, bottom = struct.unpack("<4i", found[1])
        n_pixels = max(0, right - left + 1) * max(0, bottom - top + 1)
    most = min(LARGEST_PICTURE, _PIXELS_PER_BYTE * path.stat().st_size)
    if n_pixels > most:
        raise RenderError(
            f"{path} states {n_pixels:,} pixels in {path.stat().st_size:,} bytes: expected at most {most:,}. "
            "It is damaged, or should be made smaller."
        )


def _reason(error: Exception) -> str:
    """What Mitsuba says is wrong, without where in Mitsuba it was found: ``[ply.h:163]``, ``[Mesh]``."""
    said = re.split(r"\[\w+(?:\.\w+:\d+)?\] ", str(error))[-1].strip().rstrip("!.")
    return f"{' '.join(said.split())}. Export it again, or convert it with another program."


@contextmanager
def quiet() -> Generator[None]:
    """Mitsuba says nothing on the terminal (of a slow format, of a missing unit): what matters is raised."""
    level: Any = mi.log_level()
    mi.set_log_level(mi.LogLevel.Error)
    try:
        yield
    finally:
        mi.set_log_level(level)
