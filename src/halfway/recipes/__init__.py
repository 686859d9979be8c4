"""Recipes, what a person writes for them, and the mixing of recipes into tables."""

from .aligned import aligned_mean
from .blend import Blend
from .body import with_body
from .mixing import Mixer, mix
from .named import NamedBrdf, file_names, file_stem
from .opening import (
    ChangedLibraryWarning,
    is_library,
    is_recipe_file,
    open_materials,
    open_recipe,
    split_address,
    split_library,
)
from .recipe import CHANNELS, Recipe

__all__ = [
    "CHANNELS",
    "Blend",
    "ChangedLibraryWarning",
    "Mixer",
    "NamedBrdf",
    "Recipe",
    "aligned_mean",
    "file_names",
    "file_stem",
    "is_library",
    "is_recipe_file",
    "mix",
    "open_materials",
    "open_recipe",
    "split_address",
    "split_library",
    "with_body",
]
