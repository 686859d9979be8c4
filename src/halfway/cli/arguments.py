"""What a person writes on the command line, as the package's values."""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import HalfwayError
from ..locations import DEFAULT_LIBRARY, Location, to_location

if TYPE_CHECKING:
    from ..halfdiff import Grid
    from ..library import Library
    from ..recipes import Recipe

LONGEST_ROUTE = 100_000
"""Materials; their recipes take 1.5 GB of memory while they are written."""


class ArgumentError(HalfwayError):
    """An argument that says nothing the command understands."""


def split_library(words: Sequence[str]) -> tuple[str, list[str]]:
    """The library that the first word names, or the default; and the other words."""
    first, *rest = words
    return (first, rest) if is_library(first) else (DEFAULT_LIBRARY, list(words))


def is_library(word: str) -> bool:
    """Whether a word names a library rather than a material."""
    path = to_location(word)
    return (
        word.startswith("builtin:")
        or path.suffix in (".brdflib", ".brdfc", ".zip")
        or (path / "library.json").exists()
    )


def parse_t(text: str) -> list[float]:
    """The list of t written as ``0,0.25,1`` or as ranges ``start:stop:step`` with both ends."""
    ts: list[float] = []
    for part in text.split(","):
        try:
            numbers = [float(number) for number in part.split(":")]
        except ValueError:
            numbers = []
        match numbers:
            case [t]:
                ts.append(t)
            case [start, stop, step] if 0 < step < math.inf and 0 <= stop - start < math.inf:
                require_length(len(ts) + (stop - start) / step)
                n = round((stop - start) / step)
                ts.extend(np.round(start + step * np.arange(n + 1), 12).tolist())
            case _:
                raise ArgumentError(
                    f"--t {part!r} is no number and no range: expected such as 0,0.25,1 or 0.0001:1:0.0001."
                )
    return ts


def require_length(n: float) -> None:
    """Refuse a route of more materials than memory holds recipes of."""
    if n > LONGEST_ROUTE:
        raise ArgumentError(
            f"a route of {n:,.0f} materials is too long: expected {LONGEST_ROUTE:,} or fewer. Make one for each part of it, "
            "with --t, in a folder of its own."
        )


def parse_grid(text: str) -> "Grid":
    """The MERL-like grid written as ``30x30x60``."""
    from ..halfdiff import Grid

    sizes = text.lower().split("x")
    if len(sizes) != 3 or not all(size.isdecimal() and 0 < int(size) <= 1000 for size in sizes):
        raise ArgumentError(
            f"--grid {text!r} is no grid: expected cells in theta_h, theta_d and phi_d, such as 30x30x60."
        )
    n_theta_h, n_theta_d, n_phi_d = map(int, sizes)
    return Grid.merl(n_theta_h, n_theta_d, n_phi_d)


def parse_point(text: str) -> np.ndarray:
    """The coordinates written as ``1.5,-2e3,0.1``."""
    try:
        return np.array([float(number) for number in text.split(",")])
    except ValueError:
        raise ArgumentError(
            f"--point {text!r} is no list of numbers: expected such as 1.5,-2e3,0.1."
        ) from None


def read_json(path: Location) -> Any:
    """The JSON document in a file."""
    try:
        return json.loads(path.read_text())
    except ValueError as error:
        raise ArgumentError(f"{path} is no JSON: {error}.") from None


def to_recipe(words: Sequence[str]) -> tuple["Library", "Recipe"]:
    """The recipe that ``[LIB] WHAT`` stands for, and its library.

    WHAT is weights ("gold-paint=0.7, teflon=0.3"), a recipe's JSON file, one of a route's (``recipes.json:25``), or the
    name of a material.
    """
    from ..library import open_library
    from ..recipes import Recipe

    where, rest = split_library(words) if words else (DEFAULT_LIBRARY, [])
    if len(rest) != 1:
        raise ArgumentError(
            f'{len(rest)} recipes are given where one is expected: quote it, such as "gold-paint=0.7, teflon=0.3".'
        )
    (what,) = rest
    document = _recipe_document(what)
    if document is not None:
        named = address(document) if len(words) == 1 else None
        library = open_library(named or where)
        return library, Recipe.from_json(document, library=library.name)
    library = open_library(where)
    text = what if "=" in what else f"{what}=1"
    recipe = Recipe.from_text(library.name, text)
    for name in recipe.names:
        library.index(name)
    return library, recipe


def address(document: dict[str, Any]) -> str | None:
    """Where the library of a route's or a recipe's document is."""
    return document.get("library_address") or document.get("library")


def _recipe_document(what: str) -> dict[str, Any] | None:
    """The JSON that ``FILE.json`` or ``FILE.json:INDEX`` stands for; None where it is no file."""
    file, _, index = what.partition(".json:")
    path = Path(f"{file}.json") if index else Path(what)
    if path.suffix != ".json":
        return None
    document = read_json(path)
    if not isinstance(document, dict):
        raise ArgumentError(f"{path} is no recipe: expected a JSON object with weights.")
    recipes = document.get("recipes")
    if recipes is None:
        return document
    if not index.isdecimal() or int(index) >= len(recipes):
        raise ArgumentError(
            f"{path} holds {len(recipes)} recipes: name one, {path}:0 to {path}:{len(recipes) - 1}."
        )
    return {"library": address(document), **recipes[int(index)]}
