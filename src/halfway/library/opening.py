"""From what a person writes to a library.

builtin:merl-abc        published fits that come with the package; builtin:anisotropic, models
folder.brdflib          a stored library, here or at a URL such as s3://bucket/folder.brdflib
merl_nbrdf.zip          an archive of neural fits, decoded when asked for
library.brdfc           a compact library (or its URL): principal components, reconstructed when asked for
permuted:LIB            one of these, each material in all orders of its colour channels
"""

import zipfile

from ..errors import LibraryError
from ..formats import read_nbrdf_archive
from ..halfdiff import Grid
from ..locations import BUILTIN_PREFIX, PERMUTED_PREFIX, Location, RemotePath, to_location
from ..models import BUILTIN, builtin
from . import compact_file
from .compact import CompactLibrary
from .library import Library, LibraryRef
from .permuted import Permuted
from .procedural import ProceduralLibrary
from .stored import StoredLibrary


def open_library(
    where: str | Location | LibraryRef | Library, *, grid: Grid | None = None
) -> Library:
    """The library called ``where``: ``builtin:NAME``, a library folder (or its URL), or an archive of neural fits; or an open one itself.

    ``grid`` is that on which formulas are sampled, by default the usual one of the set; a stored library has its own.

    Raises
    ------
    LibraryError
        When there is no such library.
    """
    if isinstance(where, Library):
        return where
    if isinstance(where, LibraryRef):
        where = where.address or where.name
    if str(where).startswith(PERMUTED_PREFIX):
        return Permuted(open_library(str(where).removeprefix(PERMUTED_PREFIX), grid=grid))
    if str(where).startswith(BUILTIN_PREFIX):
        built_in = builtin(str(where).removeprefix(BUILTIN_PREFIX))
        return ProceduralLibrary(
            str(where), built_in.models, grid=grid or built_in.grid, origin=built_in.origin
        )
    path = to_location(where)
    if isinstance(path, RemotePath):
        return CompactLibrary(path) if path.suffix == compact_file.SUFFIX else StoredLibrary(path)
    if path.is_dir():
        return StoredLibrary(path)
    if path.is_file() and compact_file.is_compact(path):
        return CompactLibrary(path)
    if zipfile.is_zipfile(path):
        fits = read_nbrdf_archive(path)
        return ProceduralLibrary(
            str(path), fits.models, grid=grid or fits.grid, origin=fits.origin, path=path
        )
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
