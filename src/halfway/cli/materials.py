"""The materials that words on the command line stand for, each with a label and its table when needed."""

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from ..brdf import Brdf, TabularBrdf, tabulate
from ..formats import read_brdf
from ..halfdiff import MERL
from ..library import Library, open_library
from ..locations import SCHEME, Location, RemotePath, to_location
from ..recipes import Mixer, Recipe
from .arguments import ArgumentError, address, is_library, read_json, to_recipe
from .console import say

FILES = (".binary", ".bsdf", ".h5")
"""Suffixes that nobody means a material's name by."""


class Material(NamedTuple):
    """Something that can be rendered, checked or converted."""

    label: str
    load: Callable[[], Brdf]
    """As its file has it, or mixed."""
    of: Any
    """What it is, as JSON, with what changes when it does: a library's checksum, a file's time."""
    stem: str
    """What a file about it is called, before the suffix."""
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


def file_names(materials: Sequence[Material], suffix: str) -> list[str]:
    """A file name for each material: ``gold-paint.png``; those that share a name are counted."""
    seen = Counter[str]()
    names: list[str] = []
    for material in materials:
        stem = re.sub(r"[^\w.+-]+", "-", material.stem).strip("-.") or "material"
        seen[stem] += 1
        names.append(f"{stem}-{seen[stem]}{suffix}" if seen[stem] > 1 else f"{stem}{suffix}")
    return names


def _materials(word: str) -> Iterator[Material]:
    path = to_location(word)
    if (path / "recipes.json").exists():
        yield from _route(path / "recipes.json")
    elif path.name == "recipes.json" and path.exists():
        yield from _route(path)
    elif is_library(word) and _names_no_material(word):
        library = open_library(word)
        for name in library.names:
            yield Material(name, partial(library.brdf, name), _of(library, {name: 1.0}), name)
    elif isinstance(path, RemotePath) and path.exists():
        raise ArgumentError(
            f"{path} is no library and no route: expected one of these at a URL. Copy the file here first."
        )
    elif isinstance(path, Path) and path.is_dir():
        yield from _folder(path)
    elif path.suffix == ".json" or ".json:" in word:
        yield _mixed([word])
    elif isinstance(path, Path) and path.exists():
        yield _file(path)
    elif path.suffix in FILES:
        raise ArgumentError(f"there is no file {path}: see where you are, or name a material.")
    else:
        library, _, name = word.rpartition(":")
        yield _mixed([library, name] if is_library(library) else [word])


def _names_no_material(word: str) -> bool:
    return ":" not in word.removeprefix("builtin:").rpartition(SCHEME)[2]


def _mixed(words: Sequence[str]) -> Material:
    library, recipe = to_recipe(words)
    label = recipe.names[0] if len(recipe.names) == 1 else words[-1]
    of = _of(library, recipe.to_json()["weights"])
    return Material(label, partial(Mixer(library).mix, recipe), of, label, library, recipe)


def _of(library: Library, weights: Any) -> Any:
    return {"library": library.name, "library_checksum": library.checksum, "weights": weights}


def _file(path: Path) -> Material:
    status = path.stat()
    of = {"file": str(path), "bytes": status.st_size, "modified": status.st_mtime_ns}
    return Material(path.stem, partial(read_brdf, path), of, path.stem)


def _folder(folder: Path) -> Iterator[Material]:
    """The files of BRDFs in it."""
    files = sorted(path for path in folder.iterdir() if path.suffix in FILES)
    if not files:
        raise ArgumentError(
            f"{folder} is a folder without recipes.json and without {', '.join(FILES)} files: "
            "expected a route's folder, files of BRDFs, or LIB:NAME."
        )
    yield from map(_file, files)


def _route(path: Location) -> Iterator[Material]:
    document = read_json(path)
    try:
        library = open_library(address(document) or document["library"])
        entries = [
            (f"{entry['t']:.2f}", Recipe.of(library.name, entry["weights"]))
            for entry in document["recipes"]
        ]
    except (KeyError, TypeError, AttributeError):
        raise ArgumentError(
            f"{path} is no route: expected recipes.json as `halfway route` writes it."
        ) from None
    if document.get("library_checksum", library.checksum) != library.checksum:
        say(
            f"note: {library.address} has changed since {path} was written: these are other tables. Make the route again."
        )
    mixer = Mixer(library)
    digits = max(3, len(str(len(entries) - 1)))
    for i, (label, recipe) in enumerate(entries):
        of, stem = _of(library, recipe.to_json()["weights"]), f"{i:0{digits}d}"
        yield Material(label, partial(mixer.mix, recipe), of, stem, library, recipe)
