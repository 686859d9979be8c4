"""BRDFs: what every material can do, and the tabular kind."""

from .albedo import directional_albedo, hemisphere
from .brdf import Brdf, IsotropicModel
from .metrics import Difference, difference
from .table import TabularBrdf, tabulate

__all__ = [
    "Brdf",
    "Difference",
    "IsotropicModel",
    "TabularBrdf",
    "difference",
    "directional_albedo",
    "hemisphere",
    "tabulate",
]
