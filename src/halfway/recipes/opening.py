"""From what a person writes to materials, as `open_library` goes from it to a library.

gold-paint                          a material of the default library
LIB:gold-paint                      one of another
"gold-paint=0.7, teflon=0.3"        weights; also LIB:WEIGHTS
"scan.binary=0.5, chrome=0.5"       weights of files, beside materials or not
recipe.json, recipes.json:25        a recipe in a file, one of a route's
recipes.json, or its folder         all of a route's, or of a set's
scan.binary, or a folder of files   BRDFs as their files have them
LIB                                 all materials of a library
"""

import json
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from ..brdf import TabularBrdf
from ..errors import RecipeError
from ..formats import read_brdf, zarr_tables
from ..halfdiff import common_grid
from ..library import DEFAULT_LIBRARY, Library, LibraryRef, Origin, ProceduralLibrary, open_library
from ..locations import PERMUTED_PREFIX, Location, RemotePath, to_location
from .blend import Blend
from .mixing import Mixer
from .named import NamedBrdf, made_of
from .recipe import Recipe

FILES = (".binary", ".bsdf", ".h5", ".bin", ".zarr")
"""Suffixes that nobody means a material's name by."""
LIBRARIES = (".brdflib", ".brdfc", ".zip")


class ChangedLibraryWarning(UserWarning):
    """A library holds other tables than it did when a recipe was written."""


def split_library(words: Sequence[str]) -> tuple[str, list[str]]:
    """The library that the first of some words names, or the default one; and the other words."""
    first, *rest = words or [""]
    return (first, rest) if is_library(first) else (DEFAULT_LIBRARY, list(words))


def is_library(word: str) -> bool:
    """Whether a word names a library rather than a material."""
    word = word.removeprefix(PERMUTED_PREFIX)
    path = to_location(word)
    return (
        re.fullmatch("builtin:[^:]*", word) is not None
        or path.suffix.lower() in LIBRARIES
        or (bool(word) and (path / "library.json").exists())
    )


def split_address(word: str) -> list[str]:
    """``LIB:NAME`` after the longest library that there is, or could be; names may hold other colons."""
    ends = [i for i, letter in enumerate(word) if letter == ":" and is_library(word[:i])]
    if not ends:
        return [word]
    end = max(ends, key=lambda i: (len(ends) > 1 and to_location(word[:i]).exists(), i))
    return [word[:end], word[end + 1 :]]


def open_recipe(
    words: Sequence[str], *, library: str = "", blend: str | None = None
) -> tuple[Library, Recipe]:
    """The recipe that ``[LIB] WHAT`` stands for, and its library; ``library`` is another to take it of.

    WHAT is weights ("gold-paint=0.7, teflon=0.3"), a recipe's JSON file, one of a route's (``recipes.json:25``), or the
    name of a material. ``blend`` says how they are mixed, instead of what the file says; weights alone mix linearly.

    Raises
    ------
    RecipeError
        When the words stand for none.
    """
    opened, recipe = _opened(words, library)
    return opened, recipe if blend is None else replace(recipe, blend=Blend(blend))


def _opened(words: Sequence[str], library: str) -> tuple[Library, Recipe]:
    where, rest = split_library(split_address(words[0]) if len(words) == 1 else words)
    if len(rest) != 1:
        raise RecipeError(
            f'{len(rest)} recipes are given where one is expected: quote it, such as "gold-paint=0.7, teflon=0.3".'
        )
    (what,) = rest
    path, index = _json_file(what)
    if path is None:
        return _of_weights(library or where, what)
    document = _read_object(path)
    elsewhere = library or (where if len(words) > 1 else "")
    opened = _library_of(document, path, elsewhere)
    one = _one_of(document["recipes"], path, index) if "recipes" in document else document
    return opened, _recipe(opened, document, one)


def open_materials(words: Sequence[str], *, library: str = "") -> list[NamedBrdf]:
    """The materials that ``words`` stand for; ``library`` is another to take recipes and names of.

    Raises
    ------
    RecipeError
        When a word stands for none.
    """
    return [material for word in words for material in _materials(word, library)]


def _materials(word: str, elsewhere: str) -> Iterator[NamedBrdf]:
    path = to_location(word)
    if (path / "recipes.json").exists():
        yield from _route(path / "recipes.json", elsewhere)
    elif path.name == "recipes.json" and path.exists():
        yield from _route(path, elsewhere)
    elif is_library(word) and len(split_address(word)) == 1:
        yield from _all_of(open_library(word))
    elif isinstance(path, RemotePath) and path.exists():
        raise RecipeError(
            f"{path} is no library and no route: expected one of these at a URL. Copy the file here first."
        )
    elif isinstance(path, Path) and zarr_tables.is_zarr(path):
        yield from _store(path)
    elif isinstance(path, Path) and path.is_dir():
        yield from _folder(path)
    elif is_recipe_file(word):
        yield NamedBrdf.mixed(*open_recipe([word], library=elsewhere), word)
    elif isinstance(path, Path) and path.exists():
        yield _file(path)
    elif path.suffix.lower() in FILES and "=" not in word:
        raise RecipeError(f"there is no file {path}: see where you are, or name a material.")
    else:
        words = split_address(word)
        yield NamedBrdf.mixed(*open_recipe(words, library=elsewhere), words[-1])


def _all_of(library: Library) -> Iterator[NamedBrdf]:
    for name in library.names:
        recipe = Recipe.of(library, {name: 1.0})
        of = made_of(library, recipe)
        yield NamedBrdf(name, partial(library.material, name), of, name, library, recipe)


def _file(path: Path) -> NamedBrdf:
    status = path.stat()
    of = {"file": str(path), "bytes": status.st_size, "modified": status.st_mtime_ns}
    return NamedBrdf(path.stem, partial(read_brdf, path), of, path.stem)


def _store(path: Path) -> Iterator[NamedBrdf]:
    """The tables of a Zarr store."""
    store = zarr_tables.ZarrStore.open(path)
    for i, name in enumerate(store.names):
        of = {"file": str(path), "table": i, "modified": store.chunk(i).path.stat().st_mtime_ns}
        yield NamedBrdf(name, partial(store.read, i), of, name)


def _folder(folder: Path) -> Iterator[NamedBrdf]:
    """The files of BRDFs in it."""
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in FILES)
    if not files:
        raise RecipeError(
            f"{folder} is a folder without recipes.json and without {', '.join(FILES)} files: "
            "expected a route's folder, files of BRDFs, or LIB:NAME."
        )
    yield from map(_file, files)


def _route(path: Location, elsewhere: str) -> Iterator[NamedBrdf]:
    document = _read_object(path)
    try:
        entries = [
            (str(entry["name"]) if "name" in entry else f"{entry['t']:.2f}", entry)
            for entry in document["recipes"]
        ]
    except (KeyError, TypeError, AttributeError, ValueError):
        raise RecipeError(
            f"{path} holds no recipes: expected recipes.json as `halfway route` or `halfway sample` writes it."
        ) from None
    library = _library_of(document, path, elsewhere)
    mixer = Mixer(library)
    digits = max(3, len(str(len(entries) - 1)))
    for i, (label, entry) in enumerate(entries):
        recipe, stem = _recipe(library, document, entry), f"{i:0{digits}d}"
        load = partial(mixer.mix, recipe)
        yield NamedBrdf(label, load, made_of(library, recipe), stem, library, recipe)


# Weights


def _of_weights(where: str, text: str) -> tuple[Library, Recipe]:
    """The recipe that weights or a name stand for, of a library that holds the files among its names."""
    library = open_library(where)
    alone = text in library.names or "=" not in text
    recipe = Recipe.of(library, {text: 1.0}) if alone else Recipe.from_text(library, text)
    files = [
        name
        for name in recipe.names
        if name not in library.names and Path(name).suffix.lower() in FILES
    ]
    if not files:
        for name in recipe.names:
            library.index(name)
        return library, recipe
    library = _with_files(library, recipe.names, files)
    return library, replace(recipe, library=LibraryRef.of(library))


def _with_files(library: Library, names: Sequence[str], files: Sequence[str]) -> Library:
    """The library of these materials alone, of which some are files; on the grid of the first that has one, or that has phi_h."""
    read = {name: read_brdf(name) for name in files}
    brdfs = {name: read[name] if name in read else library.brdf(name) for name in names}
    grids = (
        brdf.own_grid
        for brdf in brdfs.values()
        if isinstance(brdf, TabularBrdf) or not brdf.is_isotropic
    )
    only = len(files) == len(names)
    called = ", ".join([*files, *([] if only else [library.name])])
    origin = Origin() if only else library.origin
    return ProceduralLibrary(called, brdfs, grid=common_grid(grids), origin=origin)


# Documents


def is_recipe_file(word: str) -> bool:
    """Whether a word is the name of a recipe's file: ``FILE.json``, or one of a route's, ``FILE.json:INDEX``."""
    return _json_file(word)[0] is not None


def _json_file(what: str) -> tuple[Path | None, str]:
    """The file and the index of ``FILE.json`` or ``FILE.json:INDEX``; None where it is no such file."""
    file, _, index = what.rpartition(".json:")
    path = Path(f"{file}.json") if file else Path(what)
    return (path, index if file else "") if path.suffix == ".json" else (None, "")


def _read_object(path: Location) -> Mapping[str, Any]:
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise RecipeError(
            f"{path} is not there: expected a recipe's file. Check its name, or make it, such as by `halfway find -o {path.name}`."
        ) from None
    except RecursionError:
        raise RecipeError(f"{path} nests too deep: expected a recipe's JSON.") from None
    except ValueError as error:
        raise RecipeError(f"{path} is no JSON: {error}.") from None
    if not isinstance(document, dict):
        raise RecipeError(f"{path} is no recipe: expected a JSON object with weights.")
    return document


def _library_of(document: Mapping[str, Any], path: Location, elsewhere: str) -> Library:
    """The library that a document names, or the one that a person does; says whether its tables are still the same."""
    named = document.get("library_address") or document.get("library") or DEFAULT_LIBRARY
    library = open_library(elsewhere or str(named))
    if document.get("library_checksum", library.checksum) != library.checksum:
        warnings.warn(
            f"{library.address} is not, or no longer, the library that {path} was written for: these are other tables. "
            "Name that library with --library, or make the route again.",
            ChangedLibraryWarning,
            stacklevel=4,
        )
    return library


def _one_of(recipes: Any, path: Path, index: str) -> Mapping[str, Any]:
    n = len(recipes) if isinstance(recipes, list) else 0
    if not index.isdecimal() or int(index) >= n:
        raise RecipeError(f"{path} holds {n} recipes: name one, {path}:0 to {path}:{n - 1}.")
    return recipes[int(index)]


def _recipe(library: Library, document: Mapping[str, Any], one: Any) -> Recipe:
    """One recipe of a document, of the library that was opened for it."""
    own = one if isinstance(one, dict) else {}
    said = {key: own.get(key) for key in ("weights", "body_scale")}
    return Recipe.from_json({"blend": document.get("blend", Blend.LINEAR), **said}, library=library)
