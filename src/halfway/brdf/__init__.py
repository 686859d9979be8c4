"""BRDFs: what every material can do, and the tabular kind."""

from .albedo import directional_albedo, hemisphere
from .brdf import Brdf, IsotropicModel
from .check import ValidityCard, check
from .metrics import Difference, difference
from .repair import Repaired, repair
from .table import TabularBrdf, tabulate

__all__ = [
    "Brdf",
    "Difference",
    "IsotropicModel",
    "Repaired",
    "TabularBrdf",
    "ValidityCard",
    "check",
    "difference",
    "directional_albedo",
    "hemisphere",
    "repair",
    "tabulate",
]
