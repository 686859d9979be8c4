"""Recipes, and the mixing of recipes into tables."""

from .mix import Mixer, mix
from .recipe import CHANNELS, Recipe

__all__ = ["CHANNELS", "Mixer", "Recipe", "mix"]
