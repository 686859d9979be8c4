"""From what a person writes to a library.

builtin:merl-abc        published fits that come with the package
folder.brdflib          a stored library, here or at a URL such as s3://bucket/folder.brdflib
merl_nbrdf.zip          an archive of neural fits, decoded when asked for
library.brdfc           a compact library (or its URL): principal components, reconstructed when asked for
"""

import zipfile
from pathlib import Path

from ..errors import LibraryError
from ..formats import read_nbrdf_archive
from ..locations import Location, RemotePath, to_location
from ..models import BUILTIN, builtin
from .compact import SUFFIX as COMPACT_SUFFIX
from .compact import CompactLibrary, is_compact
from .library import Library, Origin
from .procedural import ProceduralLibrary
from .stored import StoredLibrary

BUILTIN_PREFIX = "builtin:"
DEFAULT_LIBRARY = "builtin:merl-abc"


def open_library(where: str | Location) -> Library:
    """The library called ``where``: ``builtin:NAME``, a library folder (or its URL), or an archive of neural fits.

    Raises
    ------
    LibraryError
        When there is no such library.
    """
    if str(where).startswith(BUILTIN_PREFIX):
        models = builtin(str(where).removeprefix(BUILTIN_PREFIX))
        origin = Origin(models.description, models.source, models.licence)
        return ProceduralLibrary(str(where), models.models, origin=origin)
    path = to_location(where)
    if isinstance(path, RemotePath):
        return CompactLibrary(path) if path.suffix == COMPACT_SUFFIX else StoredLibrary(path)
    if path.is_dir():
        return StoredLibrary(path)
    if path.is_file() and is_compact(path):
        return CompactLibrary(path)
    if zipfile.is_zipfile(path):
        return _open_archive(path)
    if path.exists():
        raise LibraryError(
            f"{path} is one file, not a library: `halfway library build {path} OTHER... -o NAME.brdflib` "
            "makes a library of files."
        )
    raise LibraryError(
        f"there is no library {str(where)!r}: expected a .brdflib folder, a .brdfc file, an archive of neural fits, or one of "
        + ", ".join(f"{BUILTIN_PREFIX}{name}" for name in BUILTIN)
        + "."
    )


def _open_archive(path: Path) -> Library:
    brdfs = read_nbrdf_archive(path)
    origin = Origin(
        description="neural fits (stand-ins, not measurements)",
        source="A. Sztrajman et al., Neural BRDF Representation and Importance Sampling, CGF 40(6), 2021",
        licence="MIT",
    )
    return ProceduralLibrary(str(path), brdfs, origin=origin, path=path)
