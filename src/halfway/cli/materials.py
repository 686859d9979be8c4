"""The materials that words on the command line stand for, each with a label and its table when needed."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from ..brdf import TabularBrdf, tabulate
from ..formats import read_brdf
from ..halfdiff import MERL
from ..library import open_library
from ..space import Mixer, Recipe
from .arguments import ArgumentError, is_library, read_json, to_recipe


FILES = (".binary", ".bsdf", ".h5")
"""Suffixes that nobody means a material's name by."""


class Material(NamedTuple):
    """Something that can be rendered."""

    label: str
    table: Callable[[], TabularBrdf]


def to_materials(words: Sequence[str]) -> list[Material]:
    """The materials named by ``words``: files, ``LIB:NAME``, names, recipes, recipe files, route folders."""
    return [material for word in words for material in _materials(word)]


def spread(materials: Sequence[Material], n: int) -> list[Material]:
    """About ``n`` of the materials, evenly spread, both ends among them."""
    if len(materials) <= n:
        return list(materials)
    return [materials[round(i * (len(materials) - 1) / (n - 1))] for i in range(n)]


def _materials(word: str) -> list[Material]:
    path = Path(word)
    if (path / "recipes.json").exists():
        return _route(path / "recipes.json")
    if path.name == "recipes.json" and path.exists():
        return _route(path)
    if path.is_dir():
        raise ArgumentError(
            f"{path} is a folder without recipes.json: expected a route's folder, a file of a BRDF, or LIB:NAME."
        )
    if path.suffix == ".json" or ".json:" in word:
        return [_mixed([word])]
    if path.exists():
        return [Material(path.stem, partial(_read, path))]
    if path.suffix in FILES:
        raise ArgumentError(f"there is no file {path}: see where you are, or name a material.")
    library, _, name = word.rpartition(":")
    return [_mixed([library, name] if is_library(library) else [word])]


def _mixed(words: Sequence[str]) -> Material:
    library, recipe = to_recipe(words)
    label = recipe.names[0] if len(recipe.names) == 1 else words[-1]
    return Material(label, partial(Mixer(library).mix, recipe))


def _route(path: Path) -> list[Material]:
    document = read_json(path)
    library = open_library(document["library"])
    mixer = Mixer(library)
    return [
        Material(f"{entry['t']:.2f}", partial(mixer.mix, Recipe.of(library.name, entry["weights"])))
        for entry in document["recipes"]
    ]


def _read(path: Path) -> TabularBrdf:
    brdf = read_brdf(path)
    return brdf if isinstance(brdf, TabularBrdf) else tabulate(brdf, MERL, name=path.stem)
