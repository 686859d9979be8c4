"""How wide a highlight is, and whether there is one or two.

Drawn in logarithms of both, the profile of a single lobe is level, falls, and is level where the body takes over: one
inflection. A mirror image over a blur falls twice: three inflections.
"""

from typing import NamedTuple

import numpy as np

from ..brdf import Brdf, gloss

WIDEST_DEGREES = 60.0
N_POINTS = 48
"""Of a profile, evenly in the logarithm of theta_h."""
LEAST_BEND = 0.05
"""Bends this much smaller than the largest, and what is between two cells, are no inflections."""
LEAST = 1e-9
"""Of a luminance, in 1/sr: black has no logarithm."""


class Highlight(NamedTuple):
    """What a profile says."""

    width: float
    """theta_h in radians at which it has fallen to half of its height above the body; infinite where it never does."""
    n_inflections: int


def highlight(brdf: Brdf) -> Highlight:
    """The highlight of a BRDF."""
    whole = gloss.Profile.of(brdf)
    # Beyond, cloth is brighter than anywhere else.
    near = whole.theta_h < np.radians(WIDEST_DEGREES)
    profile = gloss.Profile(whole.theta_h[near], whole.luminance[near])
    width = profile.half_width()
    return Highlight(np.inf if width is None else width, _n_inflections(profile))


def _n_inflections(profile: gloss.Profile) -> int:
    theta_h, luminance = (each[1:] for each in profile)  # the first is the normal
    x, y = np.log(theta_h), np.log(np.maximum(luminance, LEAST))
    # Cells of the database begin at .0001; nearer to the normal a table is level.
    even = np.linspace(np.log(4e-4), x[-1], N_POINTS)
    bend = np.diff(np.interp(even, x, y), 2)
    smooth = np.convolve(bend, np.ones(5) / 5, mode="valid")
    signs = np.sign(smooth[np.abs(smooth) > LEAST_BEND * np.abs(smooth).max()])
    return int((signs[1:] != signs[:-1]).sum())
