"""Half/difference angles and the grids that sample them."""

from .angles import HalfDiff, cosines, from_half_diff, reflect, to_half_diff, turn
from .grid import MERL, Axis, Corners, Grid, common_grid

__all__ = [
    "MERL",
    "Axis",
    "Corners",
    "Grid",
    "HalfDiff",
    "common_grid",
    "cosines",
    "from_half_diff",
    "reflect",
    "to_half_diff",
    "turn",
]
