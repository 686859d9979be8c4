"""Spaces, recipes, routes, and the mixing of recipes into tables."""

from .anchored import AnchoredSpace
from .evaluation import Bench, Evaluation, evaluate, sample_pairs
from .leave_one_out import AnchoredPlace, LeaveOneOut, PaperPlace, leave_one_out
from .making import SPACES, anchored_space, make_space
from .mix import Mixer, mix
from .pace import lengths, paced, perceptual
from .recipe import Recipe
from .route import Route
from .spaces import LinearSpace, PaperSpace, Space
from .triangulation import Triangulation
from .walk import DelaunayWalk

__all__ = [
    "SPACES",
    "AnchoredPlace",
    "AnchoredSpace",
    "Bench",
    "DelaunayWalk",
    "Evaluation",
    "LeaveOneOut",
    "LinearSpace",
    "Mixer",
    "PaperPlace",
    "PaperSpace",
    "Recipe",
    "Route",
    "Space",
    "Triangulation",
    "anchored_space",
    "evaluate",
    "leave_one_out",
    "lengths",
    "make_space",
    "mix",
    "paced",
    "perceptual",
    "sample_pairs",
]
