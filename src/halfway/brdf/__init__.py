"""BRDFs: what every material can do, the tabular kind, and how two of them differ."""

from . import metrics, quadrature
from .albedo import directional_albedo
from .brdf import Brdf, IsotropicModel, require_isotropic
from .check import ValidityCard, check
from .fresnel import fresnel
from .metrics import Difference, Metric, difference
from .quality import Quality, lit_sphere, quality
from .repair import Repaired, repair
from .table import TabularBrdf, half_scale, tabulate

__all__ = [
    "Brdf",
    "Difference",
    "IsotropicModel",
    "Metric",
    "Quality",
    "Repaired",
    "TabularBrdf",
    "ValidityCard",
    "check",
    "difference",
    "directional_albedo",
    "fresnel",
    "half_scale",
    "lit_sphere",
    "metrics",
    "quadrature",
    "quality",
    "repair",
    "require_isotropic",
    "tabulate",
]
