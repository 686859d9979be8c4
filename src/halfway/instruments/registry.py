"""The attributes that there are, by the names that people write."""

import math
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

import numpy as np

from ..brdf import Brdf, TabularBrdf, tabulate
from ..errors import ControlError
from ..library import open_library
from ..recipes import Recipe, mix, open_materials
from .attribute import Attribute, BodyColour, Lab, Ratio, Reading, Sum, Width
from .readings import read_table

_GLOSS = "100 x flux in the receptor / flux from black glass, n = 1.567"
_ALL = (
    *(
        Sum(
            name=f"gloss{angle}",
            label=f"Specular gloss, {angle} degrees",
            unit="GU",
            formula=_GLOSS,
            source="ISO 2813, ASTM D523",
            instrument=f"gloss{angle}",
        )
        for angle in (20, 60, 85)
    ),
    Sum(
        name="haze",
        label="Reflection haze",
        unit="HU",
        formula="100 x flux in two receptors 1.9 degrees beside / flux from black glass, 20 degrees",
        source="ASTM E430 method B, ISO 13803",
        instrument="haze",
    ),
    Ratio(
        name="doi",
        label="Distinctness of image",
        unit="%",
        formula="100 (1 - f(.3 degrees beside) / f(mirror direction)), 30 degrees",
        source="ASTM E430 method A",
        least=-math.inf,
        most=100.0,
        over={"image30": 100.0, "beside30": -100.0},
        under={"image30": 1.0},
    ),
    Sum(
        name="albedo",
        label="Albedo, even light",
        formula="int a(theta) d sin^2(theta), CIE Y",
        source="Nicodemus et al. 1977, bihemispherical reflectance",
        most=1.0,
        close=1e-3,
        group="colour",
        instrument="albedo",
    ),
    *(
        Sum(
            name=f"albedo{angle}",
            label=f"Albedo, light from {angle} degrees",
            formula="int f cos(theta_o) dwo, CIE Y",
            source="Nicodemus et al. 1977, directional-hemispherical reflectance",
            most=1.0,
            close=1e-3,
            group="colour",
            instrument=f"albedo{angle}",
        )
        for angle in (0, 45, 60)
    ),
    *(
        Lab(
            name=name,
            label=f"{name}* at 45:0",
            formula=formula,
            source="CIE 15, D65",
            least=least,
            most=-least or 100.0,
            group="colour",
            needs="" if name == "L" else "L",
            coordinate=i,
        )
        for i, (name, formula, least) in enumerate(
            [
                ("L", "116 f(Y) - 16", 0.0),
                ("a", "500 (f(X) - f(Y))", -200.0),
                ("b", "200 (f(Y) - f(Z))", -200.0),
            ]
        )
    ),
    BodyColour(
        name="body",
        label="Body colour",
        unit="sRGB",
        close=2e-3,
        group="colour",
        formula="pi x mean of f where theta_h > 25 and theta_d < 50 degrees",
        source="this project",
    ),
    Ratio(
        name="fresnel_edge",
        label="Fresnel edge",
        formula="albedo for light from 85 degrees / from 20 degrees, CIE Y",
        source="this project",
        close=0.01,
        over={"albedo85": 1.0},
        under={"albedo20": 1.0},
    ),
    Width(
        name="highlight_width",
        label="Highlight width",
        unit="degrees",
        formula="theta_h within which half of the highlight is, above its foot at 30, at theta_d = 20 degrees, CIE Y",
        source="this project",
        most=30.0,
    ),
)
ATTRIBUTES: Mapping[str, Attribute] = {attribute.name: attribute for attribute in _ALL}
"""By name, in the order in which they are shown."""
MAIN = (
    *("gloss20", "gloss60", "gloss85", "haze", "highlight_width"),
    *("albedo", "L", "a", "b", "body"),
)
"""Those that say in a few lines what a material is like."""


def attribute(name: str, among: Mapping[str, Attribute] = ATTRIBUTES) -> Attribute:
    """The attribute called ``name``.

    Raises
    ------
    ControlError
        When there is none.
    """
    if name not in among:
        near = get_close_matches(name, among, n=2, cutoff=0.6)
        hint = (
            f"did you mean {' or '.join(near)}?" if near else f"expected one of {', '.join(among)}."
        )
        raise ControlError(f"there is no attribute {name!r}: {hint}")
    return among[name]


def attributes(what: Brdf | Recipe | str, *, library: str = "") -> dict[str, Any]:
    """The attributes of a material, by name; NaN for one that it does not have. Colours are linear sRGB.

    Parameters
    ----------
    what : Brdf, Recipe or str
        A material, or what the command line takes for one: a file, a name, ``LIB:NAME``, weights, a recipe's file.
    library : str
        Another library to take recipes and names of.

    Examples
    --------
    >>> import halfway
    >>> round(halfway.attributes("teflon")["albedo45"], 2)
    0.33

    Raises
    ------
    RecipeError
        When the words are no material, or several.
    """
    return of_table(table_of(what, library=library))


def of_table(table: TabularBrdf) -> dict[str, Any]:
    """The attributes of a table, by name."""
    return of_readings(read_table(table))


def of_readings(readings: Reading) -> dict[str, Any]:
    """The attributes that readings stand for, by name."""
    values = {name: attribute.of(readings) for name, attribute in ATTRIBUTES.items()}
    return {name: float(v) if np.ndim(v) == 0 else v for name, v in values.items()}


def described(values: Mapping[str, Any], names: Iterable[str] = MAIN) -> list[str]:
    """Some attributes of one material for people, a line each."""
    rows = ((ATTRIBUTES[name], values[name]) for name in names)
    return [f"{a.name:16}{a.written(value):>10} {a.unit:8}{a.label}" for a, value in rows]


def table_of(what: Brdf | Recipe | str, *, library: str = "") -> TabularBrdf:
    """The table that `attributes` reads."""
    match what:
        case TabularBrdf():
            return what
        case Brdf():
            return tabulate(what, what.own_grid)
        case Recipe():
            return mix(open_library(library or what.library), what)
        case str():
            materials = open_materials([what], library=library)
            if len(materials) != 1:
                raise ControlError(f"{what} is {len(materials)} materials: name one.")
            return materials[0].table()
