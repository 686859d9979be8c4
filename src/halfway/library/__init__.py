"""Libraries: sets of materials on one grid, stored, computed when asked for, or compact."""

from .blocks import columns_per_piece, ranges
from .building import build_library
from .coding import Coding, Mapping, Precision
from .compact import SUFFIX, Arrays, CompactLibrary, Header, arrays_checksum, write_compact
from .library import Library, LibraryRef, Origin, Streamed
from .opening import DEFAULT_LIBRARY, open_library
from .procedural import ProceduralLibrary
from .stored import DESCRIPTION, StoredLibrary
from .subset import Subset
from .verifying import Verdict, verify_library

__all__ = [
    "DEFAULT_LIBRARY",
    "DESCRIPTION",
    "SUFFIX",
    "Arrays",
    "Coding",
    "CompactLibrary",
    "Header",
    "Library",
    "LibraryRef",
    "Mapping",
    "Origin",
    "Precision",
    "ProceduralLibrary",
    "StoredLibrary",
    "Streamed",
    "Subset",
    "Verdict",
    "arrays_checksum",
    "build_library",
    "columns_per_piece",
    "open_library",
    "ranges",
    "verify_library",
    "write_compact",
]
