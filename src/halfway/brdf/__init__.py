"""BRDFs: what every material can do, and the tabular kind."""

from .albedo import directional_albedo, hemisphere
from .brdf import Brdf, IsotropicModel
from .table import TabularBrdf, tabulate

__all__ = ["Brdf", "IsotropicModel", "TabularBrdf", "directional_albedo", "hemisphere", "tabulate"]
