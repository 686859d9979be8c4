"""BRDFs: what every material can do, the tabular kind, and how two of them differ."""

from . import metrics, quadrature
from .albedo import directional_albedo
from .brdf import Brdf, IsotropicModel, require_isotropic
from .check import ValidityCard, check
from .fresnel import fresnel
from .layout import layout_of
from .metrics import Difference, difference
from .quality import Quality, lit_sphere, quality
from .repair import Repaired, repair
from .table import TabularBrdf, half_scale, tabulate

__all__ = [
    "Brdf",
    "Difference",
    "IsotropicModel",
    "Quality",
    "Repaired",
    "TabularBrdf",
    "ValidityCard",
    "check",
    "difference",
    "directional_albedo",
    "fresnel",
    "half_scale",
    "layout_of",
    "lit_sphere",
    "metrics",
    "quadrature",
    "quality",
    "repair",
    "require_isotropic",
    "tabulate",
]
