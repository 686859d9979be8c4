"""Half/difference angles and the grids that sample them."""

from .angles import (
    HalfDiff,
    above_horizon,
    cosines,
    from_half_diff,
    from_polar,
    reflect,
    to_half_diff,
    to_polar,
    turn,
)
from .grid import MERL, Axis, Corners, Grid, common_grid

__all__ = [
    "MERL",
    "Axis",
    "Corners",
    "Grid",
    "HalfDiff",
    "above_horizon",
    "common_grid",
    "cosines",
    "from_half_diff",
    "from_polar",
    "reflect",
    "to_half_diff",
    "to_polar",
    "turn",
]
