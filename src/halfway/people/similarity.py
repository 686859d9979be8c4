"""How different people find two materials.

    d(f, g) = sum_k w_k |phi_k(f) - phi_k(g)|

over features phi of the materials, what instruments read and how they are perceived, with weights w that are not negative: a
distance, of which people's answers are fitted. Asked whether a or b looks more like a reference r, they say a with the probability

    d(r, b)^beta / (d(r, a)^beta + d(r, b)^beta)

The weights maximise the likelihood of 22,801 answered triplets of MERL materials, with the neural fits in their place: M.
Lagunas, S. Malpica, A. Serrano, E. Garces, D. Gutierrez, B. Masia, "A Similarity Measure for Material Appearance", ACM
Transactions on Graphics 38(4), 2019. ``benchmarks/human_distance.py`` fits them, and says how well answers about materials are
foretold that it was not fitted to.
"""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from jaxtyping import Float, Float64

from ..brdf import Brdf
from ..instruments import ATTRIBUTES, Readings, read_table, table_of
from ..library import Library, open_library
from ..look import Looks
from ..recipes import Blend, Recipe, mix
from ..tasks import HERE, Work
from .networks import networks
from .perceived import Perception, library_scores, lightness, samples

WEIGHTS = "similarity.csv"
WIDEST = 15.0
"""Degrees, of a highlight that there is none of."""

Features = Mapping[str, Float64[np.ndarray, " N"]]
Points = Float64[np.ndarray, "... d"]


@dataclass(frozen=True, eq=False)
class Impressions:
    """The materials of a library as points: the sum of absolute differences is how different people find two of them."""

    library: Library
    points: Float64[np.ndarray, "N d"]
    """In the library's order; NaN where what a coordinate is made of is not measured."""
    perception: Perception
    looks: Looks

    @classmethod
    def fit(cls, library: Library, *, work: Work = HERE) -> "Impressions":
        """Of all materials; what is read of them is kept in the cache."""
        points = _weighted(features(library, work=work))
        return cls(
            library, points, Perception.of(library, work=work), Looks.fit(library, work=work)
        )

    def of(self, what: Brdf | Recipe | str) -> Float64[np.ndarray, " d"]:
        """The point of a material: of the library, a recipe of it, or anything that `halfway.attributes` takes."""
        if isinstance(what, Recipe):
            return self._of_table(mix(self.library, what))
        if isinstance(what, str) and what in self.library.names:
            return self.points[self.library.index(what)]
        return self._of_table(table_of(what, library=self.library.address))

    def mix(self, weights: Float[np.ndarray, "3 *k N"], blend: Blend) -> Points:
        """The points of mixes, given by their weights over all materials; by small tables."""
        flat = weights.reshape(3, -1, weights.shape[-1])
        names = self.library.names
        recipes = [
            Recipe.from_dense(self.library, names, each, blend) for each in flat.swapaxes(0, 1)
        ]
        points = [self._of_table(self.looks.tables.table(recipe)) for recipe in recipes]
        return np.stack(points).reshape(*weights.shape[1:-1], -1)

    def nearest(self, point: Points, n: int = 8) -> list[tuple[str, float]]:
        """The ``n`` materials that people would find most alike to one at a point, with how different, the least first."""
        far = apart(self.points, point)
        return [(self.library.names[i], float(far[i])) for i in np.argsort(far, kind="stable")[:n]]

    def _of_table(self, table: Brdf) -> Float64[np.ndarray, " d"]:
        x = lightness(self.perception.scores(samples(table)))
        return _weighted(_features(read_table(table_of(table))[None], x[None]))[0]


def apart(a: Points, b: Points) -> Float64[np.ndarray, "..."]:
    """How different people find materials at these points; what is not measured of one of two does not count."""
    return np.asarray(np.nansum(np.abs(a - b), axis=-1))


def distances(library: Library | str, *, work: Work = HERE) -> Float64[np.ndarray, "N N"]:
    """How different people would find each two materials of a library; 0 on the diagonal, symmetric.

    The unit is that of the fit: answers turn where one distance is twice another.
    """
    opened = open_library(library)
    points = _weighted(features(opened, work=work))
    return apart(points[:, None], points)


def features(library: Library, *, work: Work = HERE) -> Features:
    """What a distance may be made of, of each material of a library."""
    readings = Readings.fit(library, work=work).values
    return _features(readings, lightness(library_scores(library, work=work)))


def _features(
    readings: Float64[np.ndarray, "N n_instruments 3"], x: Float64[np.ndarray, "N n_components"]
) -> Features:
    """Of materials with these readings and numbers that networks read."""
    of = {name: np.asarray(a.of(readings)) for name, a in ATTRIBUTES.items() if a.is_number}
    chroma, hue = np.hypot(of["a"], of["b"]), np.arctan2(of["b"], of["a"])
    return {
        **{f"log_{name}": np.log(of[name] + floor) for name, floor in _GLOSSES.items()},
        **{f"cbrt_{name}": np.cbrt(of[name]) for name in ("albedo", "albedo0", "albedo60")},
        **{name: of[name] for name in ("L", "a", "b")},
        "chroma": chroma,
        "hue_a": np.sqrt(chroma) * np.cos(hue),
        "hue_b": np.sqrt(chroma) * np.sin(hue),
        "log_width": np.log(np.nan_to_num(of["highlight_width"], nan=WIDEST)),
        "log_edge": np.log(of["fresnel_edge"]),
        "doi": of["doi"],
        **{f"component_{k + 1}": x[:, k] for k in range(x.shape[1])},
        **{name: network.of(x) for name, network in networks().items()},
    }


_GLOSSES = {"gloss20": 0.1, "gloss60": 0.3, "gloss85": 0.1, "haze": 0.2}
"""And what is added to each before the logarithm: of the darkest materials."""


@cache
def weights() -> Mapping[str, float]:
    """By feature, those that are not 0."""
    text = files("halfway.people").joinpath("data", WEIGHTS).read_text(encoding="utf-8")
    return {row["feature"]: float(row["weight"]) for row in csv.DictReader(text.splitlines())}


def _weighted(of: Features) -> Float64[np.ndarray, "N n_weights"]:
    return np.stack([w * of[name] for name, w in weights().items()], axis=1)
