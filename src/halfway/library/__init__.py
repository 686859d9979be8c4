"""Libraries: sets of materials on one grid, stored, computed when asked for, or compact."""

from ..locations import DEFAULT_LIBRARY
from ..origin import Origin
from . import compact_file
from .blocks import columns_per_piece, ranges
from .build import build_library
from .coding import Coding, Precision
from .compact import CompactLibrary
from .joined import Joined
from .library import Library, LibraryRef, Streamed, Verdict
from .opening import open_library
from .permuted import Permuted
from .procedural import ProceduralLibrary
from .stored import StoredLibrary, is_stored
from .subset import Subset

__all__ = [
    "DEFAULT_LIBRARY",
    "Coding",
    "CompactLibrary",
    "Joined",
    "Library",
    "LibraryRef",
    "Origin",
    "Permuted",
    "Precision",
    "ProceduralLibrary",
    "StoredLibrary",
    "Streamed",
    "Subset",
    "Verdict",
    "build_library",
    "columns_per_piece",
    "compact_file",
    "is_stored",
    "open_library",
    "ranges",
]
