"""The materials that words on the command line stand for, each with a label and its table when needed."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from ..brdf import Brdf, TabularBrdf, tabulate
from ..formats import read_brdf
from ..halfdiff import MERL
from ..library import Library, open_library
from ..space import Mixer, Recipe
from .arguments import ArgumentError, is_library, read_json, to_recipe

FILES = (".binary", ".bsdf", ".h5")
"""Suffixes that nobody means a material's name by."""


class Material(NamedTuple):
    """Something that can be rendered, checked or converted."""

    label: str
    load: Callable[[], Brdf]
    """As its file has it, or mixed."""
    library: Library | None = None
    recipe: Recipe | None = None

    def table(self) -> TabularBrdf:
        """The material on a grid: its own, or the MERL grid."""
        brdf = self.load()
        if isinstance(brdf, TabularBrdf):
            return brdf
        return tabulate(brdf, MERL, name=self.label)


def to_materials(words: Sequence[str]) -> list[Material]:
    """The materials named by ``words``: files, ``LIB:NAME``, names, recipes, recipe files, routes, whole libraries."""
    return [material for word in words for material in _materials(word)]


def spread(materials: Sequence[Material], n: int) -> list[Material]:
    """About ``n`` of the materials, evenly spread, both ends among them."""
    if len(materials) <= n:
        return list(materials)
    return [materials[round(i * (len(materials) - 1) / max(1, n - 1))] for i in range(n)]


def _materials(word: str) -> Iterator[Material]:
    path = Path(word)
    if (path / "recipes.json").exists():
        yield from _route(path / "recipes.json")
    elif path.name == "recipes.json" and path.exists():
        yield from _route(path)
    elif is_library(word) and _names_no_material(word):
        library = open_library(word)
        for name in library.names:
            yield Material(name, partial(library.brdf, name))
    elif path.is_dir():
        raise ArgumentError(
            f"{path} is a folder without recipes.json: expected a route's folder, a file of a BRDF, or LIB:NAME."
        )
    elif path.suffix == ".json" or ".json:" in word:
        yield _mixed([word])
    elif path.exists():
        yield Material(path.stem, partial(read_brdf, path))
    elif path.suffix in FILES:
        raise ArgumentError(f"there is no file {path}: see where you are, or name a material.")
    else:
        library, _, name = word.rpartition(":")
        yield _mixed([library, name] if is_library(library) else [word])


def _names_no_material(word: str) -> bool:
    return ":" not in word.removeprefix("builtin:")


def _mixed(words: Sequence[str]) -> Material:
    library, recipe = to_recipe(words)
    label = recipe.names[0] if len(recipe.names) == 1 else words[-1]
    return Material(label, partial(Mixer(library).mix, recipe), library, recipe)


def _route(path: Path) -> Iterator[Material]:
    document = read_json(path)
    try:
        library = open_library(document["library"])
        entries = [
            (f"{entry['t']:.2f}", Recipe.of(library.name, entry["weights"]))
            for entry in document["recipes"]
        ]
    except (KeyError, TypeError, AttributeError):
        raise ArgumentError(
            f"{path} is no route: expected recipes.json as `halfway route` writes it."
        ) from None
    mixer = Mixer(library)
    for label, recipe in entries:
        yield Material(label, partial(mixer.mix, recipe), library, recipe)
