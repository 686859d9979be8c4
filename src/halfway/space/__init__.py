"""Spaces where materials are points, and the routes through them."""

from .along import along
from .anchored import AnchoredSpace
from .coordinates import Coordinates, Numbers, Scores
from .embedding import Embedding
from .making import PACES, SPACES, make_space, route
from .pace import by_people, lengths, perceptual
from .routes import Route
from .space import Position, Space
from .spaces import LinearSpace, PaperSpace
from .triangulation import Triangulation
from .way import Way

__all__ = [
    "PACES",
    "SPACES",
    "AnchoredSpace",
    "Coordinates",
    "Embedding",
    "LinearSpace",
    "Numbers",
    "PaperSpace",
    "Position",
    "Route",
    "Scores",
    "Space",
    "Triangulation",
    "Way",
    "along",
    "by_people",
    "lengths",
    "make_space",
    "perceptual",
    "route",
]
