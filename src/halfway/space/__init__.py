"""Spaces, recipes, routes, and the mixing of recipes into tables."""

from .making import SPACES, make_space
from .mix import Mixer, mix
from .recipe import Recipe
from .route import Route, uniform
from .spaces import LinearSpace, PaperSpace, Space
from .triangulation import Triangulation

__all__ = [
    "SPACES",
    "LinearSpace",
    "Mixer",
    "PaperSpace",
    "Recipe",
    "Route",
    "Space",
    "Triangulation",
    "make_space",
    "mix",
    "uniform",
]
