"""Spaces, recipes, routes, and the mixing of recipes into tables."""

from .mix import Mixer, mix
from .recipe import Recipe
from .route import Route, uniform
from .spaces import LinearSpace, PaperSpace, Space
from .triangulation import Triangulation

__all__ = [
    "LinearSpace",
    "Mixer",
    "PaperSpace",
    "Recipe",
    "Route",
    "Space",
    "Triangulation",
    "mix",
    "uniform",
]
