"""Recipes, and the mixing of recipes into tables."""

from .blend import Blend
from .mixing import Mixer, mix
from .recipe import CHANNELS, Recipe

__all__ = ["CHANNELS", "Blend", "Mixer", "Recipe", "mix"]
