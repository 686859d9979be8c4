"""Analytic models, and the published fits of them that come with the package."""

from .abc import AbcModel
from .grazing import GRAZING_DEGREES
from .published import BUILTIN, ModelSet, builtin
from .sgd import SgdModel

__all__ = ["BUILTIN", "GRAZING_DEGREES", "AbcModel", "ModelSet", "SgdModel", "builtin"]
