"""BRDFs: what every material can do, the tabular kind, and how two of them differ."""

from . import gloss, metrics, quadrature
from .albedo import directional_albedo
from .albedo_operator import albedos
from .anisotropy import anisotropy
from .brdf import Brdf, pieces, require_isotropic
from .check import ValidityCard, check
from .formula import IsotropicModel
from .fresnel import fresnel
from .layout import layout_of
from .metrics import difference
from .quality import Quality, lit_sphere, quality
from .reciprocal import Measurement
from .repair import repair
from .table import TabularBrdf, blend, half_scale, own_grid, tabulate

__all__ = [
    "Brdf",
    "IsotropicModel",
    "Measurement",
    "Quality",
    "TabularBrdf",
    "ValidityCard",
    "albedos",
    "anisotropy",
    "blend",
    "check",
    "difference",
    "directional_albedo",
    "fresnel",
    "gloss",
    "half_scale",
    "layout_of",
    "lit_sphere",
    "metrics",
    "own_grid",
    "pieces",
    "quadrature",
    "quality",
    "repair",
    "require_isotropic",
    "tabulate",
]
