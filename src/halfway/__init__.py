"""New materials from measured ones."""

from .brdf import Brdf, TabularBrdf, directional_albedo, tabulate
from .errors import HalfwayError
from .halfdiff import MERL, Grid, HalfDiff, from_half_diff, to_half_diff

__all__ = [
    "MERL",
    "Brdf",
    "Grid",
    "HalfDiff",
    "HalfwayError",
    "TabularBrdf",
    "directional_albedo",
    "from_half_diff",
    "tabulate",
    "to_half_diff",
]
