"""Analytic models of common renderers, fitted to tables: for programs that have no node for a measured material."""

from .fitting import DEFAULT_MODEL, MODELS, Fit, fit
from .gltf import Gltf
from .model import AnalyticModel
from .openpbr import OpenPbr
from .principled import Principled

__all__ = [
    "DEFAULT_MODEL",
    "MODELS",
    "AnalyticModel",
    "Fit",
    "Gltf",
    "OpenPbr",
    "Principled",
    "fit",
]
