"""How wide a highlight is, and whether there is one or two.

The profile of a highlight is the luminance over theta_h for light and viewer near to each other, mean over phi_d. Drawn in
logarithms of both, a single lobe is level, falls, and is level where the body takes over: one inflection. A mirror image over
a blur falls twice: three inflections.
"""

from typing import NamedTuple

import numpy as np

from ..brdf import TabularBrdf, gloss
from ..colour import to_relative_xyz

THETA_D_DEGREES = 15.0
"""The profile is the mean of what is steeper."""
WIDEST_DEGREES = 60.0
N_POINTS = 48
"""Of a profile, evenly in the logarithm of theta_h."""
LEAST_BEND = 0.05
"""Bends this much smaller than the largest, and what is between two cells, are no inflections."""


class Highlight(NamedTuple):
    """What a profile says."""

    width: float
    """theta_h in radians at which it has fallen to half of its height above the body."""
    n_inflections: int


def highlight(table: TabularBrdf) -> Highlight:
    """The highlight of a table."""
    grid = table.grid
    steep = np.broadcast_to(grid.centres().theta_d < np.radians(THETA_D_DEGREES), grid.shape)
    rows = gloss.to_lobes(np.where(steep, table.values, np.nan).astype(np.float32), grid)
    profile = to_relative_xyz(np.nanmean(rows, axis=2).T)[:, 1]
    theta = next(axis for axis in grid.axes if axis.angle == "theta_h").centres()
    kept = theta < np.radians(WIDEST_DEGREES)
    theta, profile = theta[kept], profile[kept]
    half = (profile[0] + profile.min()) / 2
    after = int(np.argmax(profile < half))
    at = [after, after - 1]
    width = np.interp(half, profile[at], theta[at]) if after else float(theta[-1])
    return Highlight(float(width), _n_inflections(np.log(theta), np.log(np.maximum(profile, 1e-9))))


def _n_inflections(x: np.ndarray, y: np.ndarray) -> int:
    even = np.linspace(x[1], x[-1], N_POINTS)
    bend = np.diff(np.interp(even, x, y), 2)
    smooth = np.convolve(bend, np.ones(5) / 5, mode="valid")
    signs = np.sign(smooth[np.abs(smooth) > LEAST_BEND * np.abs(smooth).max()])
    return int((signs[1:] != signs[:-1]).sum())
