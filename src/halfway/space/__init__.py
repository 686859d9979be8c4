"""Spaces, recipes, routes, and the mixing of recipes into tables."""

from .anchored import AnchoredSpace
from .making import SPACES, anchored_space, make_space
from .mix import Mixer, mix
from .pace import perceptual
from .recipe import Recipe
from .route import Route
from .spaces import LinearSpace, PaperSpace, Space
from .triangulation import Triangulation
from .walk import DelaunayWalk

__all__ = [
    "SPACES",
    "AnchoredSpace",
    "DelaunayWalk",
    "LinearSpace",
    "Mixer",
    "PaperSpace",
    "Recipe",
    "Route",
    "Space",
    "Triangulation",
    "anchored_space",
    "make_space",
    "mix",
    "perceptual",
]
