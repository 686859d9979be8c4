"""Files that a scene may be given: found, of a kind that is read; and the meshes among them."""

from collections.abc import Collection
from pathlib import Path

from ..errors import RenderError
from .mesh import Mesh
from .obj import parse_obj
from .ply import parse_ply
from .polygons import MeshFault

MESHES = {".ply": parse_ply, ".obj": parse_obj}
"""What reads a mesh, by suffix."""


def read_mesh(path: Path) -> Mesh:
    """The triangles of a ``.ply`` or ``.obj`` file, y up in the file, faces turned outward, its middle at the origin.

    Raises
    ------
    RenderError
        When there is no such file, or it holds no whole mesh.
    """
    suffix = require_file(path, "mesh", MESHES)
    try:
        return MESHES[suffix](path.read_bytes()).mesh()
    except MeshFault as fault:
        raise RenderError(
            f"{path} {fault}. Export it again, or convert it with another program."
        ) from fault


def require_file(path: Path, what: str, suffixes: Collection[str]) -> str:
    """The suffix, one of these, in lower case; of a file that is there."""
    if path.suffix.lower() not in suffixes:
        raise RenderError(
            f"the {what} {path} is of an unknown kind: expected {' or '.join(suffixes)}. Export it as one of them."
        )
    if not path.is_file():
        raise RenderError(f"there is no {what} {path}: see where you are, or give its whole path.")
    return path.suffix.lower()
