"""BRDFs: what every material can do, the tabular kind, and how two of them differ."""

from . import gloss, metrics, quadrature
from .albedo import directional_albedo
from .albedo_operator import albedos
from .brdf import Brdf
from .check import ValidityCard, check
from .formula import IsotropicModel
from .fresnel import fresnel
from .layout import layout_of
from .metrics import difference
from .quality import Quality, lit_sphere, quality
from .reciprocal import Measurement
from .repair import repair
from .table import TabularBrdf, half_scale, tabulate

__all__ = [
    "Brdf",
    "IsotropicModel",
    "Measurement",
    "Quality",
    "TabularBrdf",
    "ValidityCard",
    "albedos",
    "check",
    "difference",
    "directional_albedo",
    "fresnel",
    "gloss",
    "half_scale",
    "layout_of",
    "lit_sphere",
    "metrics",
    "quadrature",
    "quality",
    "repair",
    "tabulate",
]
