"""Analytic models, the published fits of them that come with the package, and synthetic materials."""

from .abc import AbcModel
from .grazing import GRAZING_DEGREES
from .published import PUBLISHED, ModelSet
from .sets import BUILTIN, builtin
from .sgd import SgdModel
from .synthetic import SyntheticModel, synthetic

__all__ = [
    "BUILTIN",
    "GRAZING_DEGREES",
    "PUBLISHED",
    "AbcModel",
    "ModelSet",
    "SgdModel",
    "SyntheticModel",
    "builtin",
    "synthetic",
]
