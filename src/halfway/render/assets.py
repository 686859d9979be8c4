"""Meshes and environments from files.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

import re
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ..errors import RenderError
from .mesh import Mesh, outward


def read_mesh(path: Path) -> Mesh:
    """The triangles of a ``.ply`` or ``.obj`` file, y up in the file, faces turned outward."""
    kind = _require_file(path, "mesh", (".ply", ".obj"))
    if kind == "obj" and b"\nf " not in b"\n" + path.read_bytes():
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
    _require_file(path, "environment", (".hdr", ".exr"))
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
