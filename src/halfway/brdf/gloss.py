"""Body and gloss of a table: what is in its highlight, and how wide the highlight is.

Along theta_h, for each channel and each theta_d and phi_d,

    f       |\\
            | \\            gloss = share x (lowest f from the normal to here - lowest f up to the foot), 0 beyond
            |  \\___        body  = f - gloss
            |   :  ---___/
            +---:---------- theta_h
              foot

so body and gloss are non-negative. What rises towards grazing or the light's own direction is body, and so is what falls
slowly beyond the foot, `REACH` widths of the lobe from the normal, or `LEAST_REACH` where that is farther. A highlight is
known by its slopes, u = tan theta_h: one distribution of microfacets is another one's, s times as wide, where

    f'(u) cos^4 theta_h' = f(u / s) cos^4 theta_h / s^2

which keeps the energy that a rough surface of such facets reflects, up to shadowing (so it is for the lobes of Beckmann and
of Trowbridge and Reitz: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, equations 25
and 33). The width is the geometric mean of the slopes, weighted by the height of the lobe to the power `SHARPNESS`. What hardly stands out of the body, such as the broad lobe of a felt, is no highlight, and has the
body's colours: the share of the lobe that is gloss rises from 0 to 1 where the lobe is `FAINT` to `CLEAR` of the value
that the table has in the mirror direction.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Float64, Int

from .._types import Table
from ..colour import LUMINANCE
from ..halfdiff import Grid, HalfDiff, from_half_diff
from .brdf import Brdf, turns

FAINT, CLEAR = 0.1, 0.4
"""Shares of the value in the mirror direction up to which a lobe is body, and from which it is gloss."""
SHARPNESS = 1.5
"""Between 1, the lobe's energy, which a wide light shows and which tails rule, and 2, the peaks that small lights show."""
REACH = 8.0
"""Of a lobe, in widths: there a GGX has a five hundredth of its height."""
LEAST_REACH = np.tan(np.radians(30.0))
"""As a slope: a mirror's haze is gloss, and hardly any diffuse body falls nearer to the normal."""
STEEP_DEGREES = 60.0
"""The width is read where theta_d is smaller: beyond, shadowing and edges of the measurement bend the lobe."""

PROFILE = np.radians(75) * np.linspace(0, 1, 400) ** 2
"""theta_h of a profile, close together near the normal."""
PROFILE_THETA_D = np.radians(5.0)

Lobes = Float32[np.ndarray, "3 n_theta_h n"]


class Gloss(NamedTuple):
    """The parts of one table, with theta_h as the first of the grid's axes and the others in one."""

    body: Lobes
    """1/sr; NaN where the table is unmeasured."""
    gloss: Float32[np.ndarray, "3 n_rows n"]
    """1/sr, from the normal to the foot, where it is 0; unmeasured cells have what their neighbour nearer to the normal has."""
    width: float
    """Of the lobe, as a slope, highlight or not; 1 where the table is flat."""

    @classmethod
    def of(cls, values: Table, grid: Grid) -> "Gloss":
        """The parts of a table, shape (3, *grid.shape) or (3, p)."""
        lobes = to_lobes(values, grid)
        lowest = lobes.copy()
        for row in range(1, lobes.shape[1]):  # eight times as fast as `np.fmin.accumulate`
            np.fmin(lowest[:, row - 1], lowest[:, row], out=lowest[:, row])
        np.copyto(lowest, 0, where=np.isnan(lowest))
        gloss = lowest - lowest[:, -1:]
        steepness = _steepness(grid)
        profile = (gloss.sum(axis=0) @ steepness).astype(np.float64)
        foot, width = _foot_and_width(profile, grid)
        gloss = gloss[:, : foot + 1] - gloss[:, foot : foot + 1]
        np.maximum(gloss, 0, out=gloss)
        peak = float(lowest[:, 0].sum(axis=0) @ steepness)
        contrast = (profile[0] - profile[foot]) / (peak or 1.0)
        share = np.clip((contrast - FAINT) / (CLEAR - FAINT), 0, 1)
        gloss *= np.float32(share)
        body = lobes.copy()
        body[:, : foot + 1] -= gloss
        return cls(np.maximum(body, 0, out=body), gloss, width)

    def stretched(self, width: float, grid: Grid) -> Lobes:
        """The table whose highlight is this wide."""
        lobes = Stretch.by(width / self.width, grid).rows(self.gloss, slice(None))
        lobes += self.body
        return lobes


class Stretch(NamedTuple):
    """A gloss made wider or narrower: where each of its rows comes from, and how its values change."""

    lower: Int[np.ndarray, " n_theta_h"]
    near: Float32[np.ndarray, "n_theta_h 1"]
    """What the row ``lower`` counts."""
    far: Float32[np.ndarray, "n_theta_h 1"]
    """What the row after it counts."""

    @classmethod
    def by(cls, scale: float, grid: Grid) -> "Stretch":
        """To ``scale`` times the width."""
        axis = grid.axis("theta_h")
        theta = axis.centres()
        source = np.arctan(np.tan(theta) / scale)
        position = axis.to_position(source) - 0.5
        lower = np.clip(np.floor(position), 0, max(axis.size - 2, 0)).astype(np.intp)
        fraction = np.clip(position - lower, 0, 1)
        factor = (np.cos(source) / np.cos(theta)) ** 4 / scale**2
        shares = (1 - fraction) * factor, fraction * factor
        return cls(lower, *(share.astype(np.float32)[:, None] for share in shares))

    def rows(
        self, gloss: Float32[np.ndarray, "*c n_rows n"], part: slice
    ) -> Float32[np.ndarray, "*c n_stretched n"]:
        """Some rows of a gloss, stretched."""
        last = gloss.shape[-2] - 1
        lower = np.minimum(self.lower[part], last)
        upper = np.minimum(lower + 1, last)
        stretched, upper = np.take(gloss, lower, axis=-2), np.take(gloss, upper, axis=-2)
        stretched *= self.near[part]
        upper *= self.far[part]
        stretched += upper
        return stretched


class Profile(NamedTuple):
    """Luminance over theta_h where light and viewer are near to each other, the mean over phi_d, and phi_h if it matters."""

    theta_h: Float64[np.ndarray, " n"]
    """Of `PROFILE`, those that are measured."""
    luminance: Float64[np.ndarray, " n"]

    @classmethod
    def of(cls, brdf: Brdf) -> "Profile":
        """The profile of a BRDF."""
        phi_d = np.pi * (np.arange(8) + 0.5) / 8
        phi_h = np.array([0.0] if brdf.is_isotropic else list(turns()))[:, None]
        angles = HalfDiff(PROFILE[:, None, None], phi_h, np.full((1, 1), PROFILE_THETA_D), phi_d)
        values = (brdf.eval(*from_half_diff(angles)) @ LUMINANCE).reshape(len(PROFILE), -1)
        known = np.isfinite(values)
        counts = known.sum(axis=1)
        means = np.where(known, values, 0).sum(axis=1) / np.maximum(counts, 1)
        return cls(PROFILE[counts > 0], means[counts > 0])

    def half_width(self) -> float | None:
        """How far it is from the peak to half of its height above the floor, in radians; None where it stays higher."""
        peak = int(self.luminance.argmax())
        half = (self.luminance.max() + self.luminance.min()) / 2
        below = np.flatnonzero(self.luminance[peak:] < half)
        if not below.size:
            return None
        after = peak + int(below[0])
        high, low = self.luminance[after - 1], self.luminance[after]
        share = (high - half) / (high - low)
        theta_h = self.theta_h[after - 1] + share * (self.theta_h[after] - self.theta_h[after - 1])
        return float(theta_h - self.theta_h[peak])


def to_lobes(values: Table, grid: Grid) -> Lobes:
    """A table with theta_h first among the grid's axes, and the others in one; a view where they lie so."""
    axis = grid.axis("theta_h")
    lobes = np.moveaxis(values.reshape(3, *grid.shape), 1 + grid.axes.index(axis), 1)
    return lobes.reshape(3, axis.size, -1)


def _steepness(grid: Grid) -> Float32[np.ndarray, " n"]:
    """What each lobe weighs in a profile over theta_h: its share of the theta_d that are steep."""
    theta_d = grid.centres().theta_d
    weight = np.where(theta_d < np.radians(STEEP_DEGREES), np.sin(theta_d) * np.cos(theta_d), 0)
    whole = np.broadcast_to(weight, (3, *grid.shape)).astype(np.float32)
    return np.ascontiguousarray(to_lobes(whole, grid)[0, 0])


def _foot_and_width(profile: Float64[np.ndarray, " n_theta_h"], grid: Grid) -> tuple[int, float]:
    """The row at which a lobe ends, the first from `LEAST_REACH` that is `REACH` widths away, and the width above it."""
    slopes = np.tan(grid.axis("theta_h").centres())
    last = len(slopes) - 1
    foot = min(int(np.searchsorted(slopes, LEAST_REACH)), last)
    while True:
        width = _width(np.maximum(profile - profile[foot], 0), grid)
        reach = min(int(np.searchsorted(slopes, REACH * width)), last)
        if reach <= foot:
            return foot, width
        foot = reach


def _width(profile: Float64[np.ndarray, " n_theta_h"], grid: Grid) -> float:
    """The geometric mean of the slopes of a lobe."""
    axis = grid.axis("theta_h")
    theta, step = axis.centres(), np.diff(axis.edges())
    slopes = np.tan(theta)
    weight = (profile * np.cos(theta) ** 4) ** SHARPNESS * slopes / np.cos(theta) ** 2 * step
    if not weight.sum() > 0:
        return 1.0
    return float(np.exp((weight * np.log(slopes)).sum() / weight.sum()))
