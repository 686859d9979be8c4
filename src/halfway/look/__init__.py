"""Looks: pictures and samples of a library's materials, made of their tables alone, and how different they look."""

from .appearance import appearance, ciede2000_difference, cielab_difference, shown
from .flip import flip
from .images import Looks, most_different
from .lit_sphere import JUDGING_SCENE, PACING_SCENE, FilledSphere, SphereOperator, SphereScene
from .portraits import portrait, recipes_png, table_png, to_png
from .samples import CellSamples, body_colours, body_mask
from .small_tables import small_grid

__all__ = [
    "JUDGING_SCENE",
    "PACING_SCENE",
    "CellSamples",
    "FilledSphere",
    "Looks",
    "SphereOperator",
    "SphereScene",
    "appearance",
    "body_colours",
    "body_mask",
    "ciede2000_difference",
    "cielab_difference",
    "flip",
    "most_different",
    "portrait",
    "recipes_png",
    "shown",
    "small_grid",
    "table_png",
    "to_png",
]
