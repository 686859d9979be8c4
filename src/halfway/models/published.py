"""Published fits of the MERL materials, as sets of models that come with the package.

They stand in for measurements where none are at hand: a few kilobytes of published numbers in place of 3.5 GB.
"""

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from types import MappingProxyType
from typing import Final

import numpy as np

from ..brdf import Brdf
from ..halfdiff import MERL, Grid
from ..origin import Origin
from .abc import AbcModel
from .sgd import SgdModel


@dataclass(frozen=True)
class ModelSet:
    """Named models with one source."""

    name: str
    origin: Origin
    """Says that they are no measurements."""
    models: Mapping[str, Brdf]
    """By material name, in the order of the database."""
    grid: Grid = MERL
    """On which they are sampled where no other is asked for."""


PUBLISHED: Final = ("merl-abc", "merl-sgd")
"""Names of the sets that come with the package."""

_FACTS = "published numbers (facts); the models are our own implementation, BSD-3-Clause"


def published(name: str) -> ModelSet:
    """The set of models of this name, one of `PUBLISHED`."""
    match name:
        case "merl-abc":
            return ModelSet(
                name,
                Origin(
                    "The 100 MERL materials as analytic stand-ins (ABC microfacet fits), not measurements",
                    "Löw, Kronander, Ynnerman, Unger: BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces, "
                    "ACM TOG 31(1), 2012",
                    _FACTS,
                ),
                _read("abc_low2012_microfacet.csv", _to_abc),
            )
        case _:
            return ModelSet(
                name,
                Origin(
                    "The 100 MERL materials as analytic stand-ins (shifted gamma fits), not measurements",
                    "Bagher, Soler, Holzschuch: Accurate fitting of measured reflectances using a Shifted Gamma "
                    "micro-facet distribution, CGF 31(4), 2012",
                    _FACTS,
                ),
                _read("sgd_bagher2012.csv", _to_sgd),
            )


_Row = Mapping[str, str]


def _read(file: str, to_model: Callable[[_Row], Brdf]) -> Mapping[str, Brdf]:
    text = files("halfway.models").joinpath("data", file).read_text(encoding="utf-8")
    lines = (line for line in text.splitlines() if not line.startswith("#"))
    return MappingProxyType({row["name"]: to_model(row) for row in csv.DictReader(lines)})


def _to_abc(row: _Row) -> AbcModel:
    B, C, ior = (float(row[name]) for name in ("B", "C", "ior"))
    return AbcModel(kD=_rgb(row, "kD"), A=_rgb(row, "A"), B=B, C=C, ior=ior)


def _to_sgd(row: _Row) -> SgdModel:
    return SgdModel(
        rhoD=_rgb(row, "rhoD"),
        rhoS=_rgb(row, "rhoS"),
        alpha=_rgb(row, "alpha"),
        p=_rgb(row, "p"),
        F0=_rgb(row, "F0"),
        F1=_rgb(row, "F1"),
        K=_rgb(row, "K"),
        Lambda=_rgb(row, "Lambda"),
        log_c=np.log(_rgb(row, "c")),
        k=_rgb(row, "k"),
        theta0=_rgb(row, "theta0"),
    )


def _rgb(row: _Row, name: str) -> np.ndarray:
    return np.array([float(row[f"{name}_{channel}"]) for channel in "rgb"])
