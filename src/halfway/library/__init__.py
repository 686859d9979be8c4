"""Libraries: sets of materials on one grid, and their principal components."""

from .library import Library
from .opening import DEFAULT_LIBRARY, open_library
from .pca import Pca
from .procedural import ProceduralLibrary
from .stored import StoredLibrary, build_library

__all__ = [
    "DEFAULT_LIBRARY",
    "Library",
    "Pca",
    "ProceduralLibrary",
    "StoredLibrary",
    "build_library",
    "open_library",
]
