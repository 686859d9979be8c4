"""Spaces where materials are points, and the routes through them."""

from .anchored import AnchoredSpace, anchored_scale
from .hull import nearest_in_hull
from .making import SPACES, anchored_space, make_space
from .pace import lengths, paced, perceptual
from .route import Route
from .spaces import LinearSpace, PaperSpace, Space
from .triangulation import Triangulation
from .walk import DelaunayWalk

__all__ = [
    "SPACES",
    "AnchoredSpace",
    "DelaunayWalk",
    "LinearSpace",
    "PaperSpace",
    "Route",
    "Space",
    "Triangulation",
    "anchored_scale",
    "anchored_space",
    "lengths",
    "make_space",
    "nearest_in_hull",
    "paced",
    "perceptual",
]
