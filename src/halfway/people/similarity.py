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
from functools import cache
from importlib.resources import files

import numpy as np
from jaxtyping import Float64

from ..instruments import ATTRIBUTES, Readings
from ..library import Library, open_library
from ..tasks import HERE, Work
from .networks import networks
from .perceived import library_scores, lightness

WEIGHTS = "similarity.csv"
WIDEST = 15.0
"""Degrees, of a highlight that there is none of."""

Features = Mapping[str, Float64[np.ndarray, " N"]]


def distances(library: Library | str, *, work: Work = HERE) -> Float64[np.ndarray, "N N"]:
    """How different people would find each two materials of a library; 0 on the diagonal, symmetric.

    The unit is that of the fit: answers turn where one distance is twice another.
    """
    opened = open_library(library) if isinstance(library, str) else library
    of = features(opened, work=work)
    apart = (w * np.abs(of[name][:, None] - of[name]) for name, w in weights().items())
    return np.sum(list(apart), axis=0)


def features(library: Library, *, work: Work = HERE) -> Features:
    """What a distance is made of, of each material of a library."""
    readings = Readings.fit(library, work=work).values
    x = lightness(library_scores(library, work=work))
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
