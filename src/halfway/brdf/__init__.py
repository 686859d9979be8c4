"""BRDFs: what every material can do, the tabular kind, and how two of them differ."""

from .albedo import directional_albedo
from .brdf import CELLS_IN_CACHE, Brdf, IsotropicModel
from .check import ValidityCard, check
from .fresnel import fresnel
from .metrics import EPSILON, MAPPINGS, Difference, Metric, difference
from .quadrature import HalfVectors, comparison_cells, spread_angles
from .quality import Quality, lit_sphere, quality
from .repair import Repaired, repair
from .table import TabularBrdf, tabulate

__all__ = [
    "CELLS_IN_CACHE",
    "EPSILON",
    "MAPPINGS",
    "Brdf",
    "Difference",
    "HalfVectors",
    "IsotropicModel",
    "Metric",
    "Quality",
    "Repaired",
    "TabularBrdf",
    "ValidityCard",
    "check",
    "comparison_cells",
    "difference",
    "directional_albedo",
    "fresnel",
    "lit_sphere",
    "quality",
    "repair",
    "spread_angles",
    "tabulate",
]
