"""Libraries: sets of materials on one grid, and their principal components."""

from ..brdf.sphere import JUDGING_SCENE, PACING_SCENE, BasisScene, SphereOperator
from .basis import BasisImages
from .basis_samples import BasisSamples, body_colours
from .building import build_library
from .coding import Coding
from .compact import CompactLibrary
from .compacting import compact_library
from .library import Library, Origin
from .opening import DEFAULT_LIBRARY, library_called, open_library
from .pca import Pca
from .plan import PcaPlan
from .procedural import ProceduralLibrary
from .stored import StoredLibrary
from .subset import Subset, most_different
from .verifying import Verdict, verify_library

__all__ = [
    "DEFAULT_LIBRARY",
    "JUDGING_SCENE",
    "PACING_SCENE",
    "BasisImages",
    "BasisSamples",
    "BasisScene",
    "Coding",
    "CompactLibrary",
    "Library",
    "Origin",
    "Pca",
    "PcaPlan",
    "ProceduralLibrary",
    "SphereOperator",
    "StoredLibrary",
    "Subset",
    "Verdict",
    "body_colours",
    "build_library",
    "compact_library",
    "library_called",
    "most_different",
    "open_library",
    "verify_library",
]
