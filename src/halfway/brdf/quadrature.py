"""Nodes and weights of what is summed over directions, or over pairs of them.

    albedo           integral of f_r(wi, wo) cos(theta_i) dwi,  dwi = 4 (wo . h) dh       `HalfVectors`
    comparison       sum over the cells of a grid, dwi dwo = 4 cos(theta_d) dwh dwd       `comparison_cells`
    a few samples    pairs spread evenly over the positions of a MERL table               `spread_angles`

The first runs over half vectors, where measured materials are smooth, with theta_h square-root spaced as the MERL grid is.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Directions, Mask
from ..halfdiff import MERL, Grid, HalfDiff, cosines, reflect

GRAZING_DEGREES = 80.0
"""From the normal; Ngan et al. leave out what lies beyond."""


class HalfVectors(NamedTuple):
    """A midpoint rule over the directions on the other side of half vectors, for one fixed direction; n nodes."""

    h: Directions
    fixed: Directions
    """In the plane of incidence, x >= 0; the same at each node."""
    other: Directions
    cos_d: Float64[np.ndarray, " n"]
    dh: Float64[np.ndarray, " n"]
    """Solid angle of the half vectors that a node stands for."""

    @classmethod
    def at(
        cls, theta: float, n_theta_h: int, n_phi_h: int, *, least_cosine: float = 0.0
    ) -> "HalfVectors":
        """The rule for the direction at ``theta`` radians from the normal, over others of more than the least cosine."""
        h, dh = hemisphere(n_theta_h, n_phi_h)
        fixed = np.array([np.sin(theta), 0.0, np.cos(theta)])
        cos_d = h @ fixed
        other = reflect(fixed, h, cos_d)
        lit = (cos_d > 0) & (other[:, 2] > least_cosine)
        other = other[lit]
        return cls(h[lit], np.broadcast_to(fixed, other.shape), other, cos_d[lit], dh[lit])

    @property
    def weights(self) -> Float64[np.ndarray, " n"]:
        """Solid angle of the other direction times its cosine."""
        return 4 * self.cos_d * self.dh * self.other[:, 2]


def hemisphere(n_theta: int, n_phi: int) -> tuple[Directions, Float64[np.ndarray, " n"]]:
    """Nodes, shape (n, 3), and solid angles of a midpoint rule with square-root spaced theta."""
    edges = np.pi / 2 * (np.arange(n_theta + 1) / n_theta) ** 2
    theta = np.pi / 2 * ((np.arange(n_theta) + 0.5) / n_theta) ** 2
    phi = 2 * np.pi * (np.arange(n_phi) + 0.5) / n_phi
    theta_all, phi_all = (grid.ravel() for grid in np.meshgrid(theta, phi, indexing="ij"))
    sin = np.sin(theta_all)
    nodes = np.stack([sin * np.cos(phi_all), sin * np.sin(phi_all), np.cos(theta_all)], axis=-1)
    bands = -np.diff(np.cos(edges)) * 2 * np.pi / n_phi
    return nodes, np.repeat(bands, n_phi)


class Cells(NamedTuple):
    """What the cells of a grid bring to a comparison; arrays of the grid's shape."""

    solid_angle: Float64[np.ndarray, "..."]
    cos_i: Float64[np.ndarray, "..."]
    cos_o: Float64[np.ndarray, "..."]
    grazing: Mask
    """Whether either direction is more than `GRAZING_DEGREES` from the normal."""


@lru_cache(maxsize=2)
def comparison_cells(grid: Grid) -> Cells:
    """The solid angles and cosines of a grid's cells."""
    angles = grid.centres()
    cos_i, cos_o = (
        np.broadcast_to(cosine, grid.shape)
        for cosine in cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    )
    grazing = np.minimum(cos_i, cos_o) < np.cos(np.radians(GRAZING_DEGREES))
    return Cells(grid.solid_angles(), cos_i, cos_o, grazing)


def spread_angles(n: int) -> HalfDiff:
    """``n`` half/difference angles spread evenly over the positions of a MERL table, by an additive recurrence; phi_h is 0.

    M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018: powers of 1/1.22074, for three dimensions.
    """
    position = np.outer(np.arange(1, n + 1), 1.2207440846057596 ** -np.arange(1.0, 4)) % 1
    theta_h, theta_d, phi_d = (
        axis.to_angle(axis.size * x) for axis, x in zip(MERL.axes, position.T, strict=True)
    )
    return HalfDiff(theta_h, np.zeros_like(theta_h), theta_d, phi_d)
