"""Nodes and weights of what is summed over directions, or over pairs of them.

    albedo           integral of f_r(wi, wo) cos(theta_i) dwi,  dwi = 4 (wo . h) dh       `HalfVectors`
    comparison       sum over the cells of a grid, dwi dwo = 4 cos(theta_d) dwh dwd       `comparison_cells`
    an instrument    integral of f_r cos(theta_i) cos(theta_o) over two windows           `Windows`
    a few samples    pairs spread evenly over the positions of a MERL table               `spread_angles`

On a grid such a sum is a `Functional`, worked out once for all tables. The first runs over half vectors, where measured materials are smooth, with theta_h square-root spaced as the MERL grid is;
the third has its nodes as close about the mirror direction.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float64, Int

from .._types import Directions, Mask
from ..halfdiff import MERL, Grid, HalfDiff, cosines, from_polar, reflect, turn

GRAZING_DEGREES = 80.0
"""From the normal; Ngan et al. leave out what lies beyond."""
N_THETA_H = 360
N_PHI_H = 60
"""Nodes of a directional albedo."""


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

    def turned(self, phi: float) -> "HalfVectors":
        """The rule for the fixed direction at the azimuth ``phi``."""
        h, fixed, other = (turn(v, phi) for v in self[:3])
        return HalfVectors(h, fixed, other, self.cos_d, self.dh)

    @property
    def weights(self) -> Float64[np.ndarray, " n"]:
        """Solid angle of the other direction times its cosine."""
        return 4 * self.cos_d * self.dh * self.other[:, 2]


def hemisphere(n_theta: int, n_phi: int) -> tuple[Directions, Float64[np.ndarray, " n"]]:
    """Nodes, shape (n, 3), and solid angles of a midpoint rule with square-root spaced theta."""
    edges = np.pi / 2 * (np.arange(n_theta + 1) / n_theta) ** 2
    theta = np.pi / 2 * ((np.arange(n_theta) + 0.5) / n_theta) ** 2
    phi = 2 * np.pi * (np.arange(n_phi) + 0.5) / n_phi
    nodes = from_polar(*(grid.ravel() for grid in np.meshgrid(theta, phi, indexing="ij")))
    bands = -np.diff(np.cos(edges)) * 2 * np.pi / n_phi
    return nodes, np.repeat(bands, n_phi)


class Windows(NamedTuple):
    """A rule over pairs of directions: one in the window of a source, one in that of a receptor; n nodes.

    A window is a rectangle on the plane that touches the sphere of directions at its axis: so many degrees along the plane
    of incidence, with theta growing, and across. Its middle may lie beside the axis.
    """

    wi: Directions
    wo: Directions
    weights: Float64[np.ndarray, " n"]
    """Solid angles times cosines, of both."""
    wi_weights: Float64[np.ndarray, " n_source"]
    """The same of the source alone, at each of its nodes."""
    cos_i: Float64[np.ndarray, " n_source"]

    @classmethod
    def at(
        cls,
        theta: float,
        source: tuple[float, float],
        receptor: tuple[float, float],
        *,
        beside: float = 0.0,
        n_source: tuple[int, int] = (4, 6),
        n_receptor: int = 24,
    ) -> "Windows":
        """The rule for axes at ``theta`` radians on either side of the normal; sizes and ``beside`` in degrees.

        ``beside`` is how much further than the mirror direction the middle of the receptor is from the normal. The receptor
        has ``n_receptor`` nodes on each side of each source node's mirror image, along and across.
        """
        along, across = (_even(*_sides(size), n) for size, n in zip(source, n_source, strict=True))
        u, v = (x.ravel() for x in np.meshgrid(along[0], across[0], indexing="ij"))
        du = np.outer(along[1], across[1]).ravel()
        wi, wi_weights = _gnomonic(theta, u, v, du)
        p, dp = _about(u, *_sides(receptor[0], beside), n_receptor)
        q, dq = _about(-v, *_sides(receptor[1]), n_receptor)
        p, q, area = np.broadcast_arrays(
            p[:, :, None], q[:, None, :], dp[:, :, None] * dq[:, None, :]
        )
        wo, wo_weights = _gnomonic(theta, p, q, area)
        both = (wi_weights[:, None, None] * wo_weights).ravel()
        wi_of = np.broadcast_to(wi[:, None, None], wo.shape).reshape(-1, 3)
        # Beyond the normal's side of the mirror plane: the receptor is at the azimuth pi.
        wo = wo.reshape(-1, 3) * np.array([-1.0, 1.0, 1.0])
        lit = (both != 0) & (wo[:, 2] > 0)
        return cls(wi_of[lit], wo[lit], both[lit], wi_weights, wi[:, 2])


def _sides(size: float, middle: float = 0.0) -> tuple[float, float]:
    """The ends of a window ``size`` degrees wide, on the plane that touches at its axis."""
    return tuple(np.tan(np.radians([middle - size / 2, middle + size / 2])).tolist())


def _even(low: float, high: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Midpoints and widths of ``n`` pieces."""
    step = (high - low) / n
    return low + step * (np.arange(n) + 0.5), np.full(n, step)


def _about(centre: np.ndarray, low: float, high: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [low, high] that gather at each centre: Gauss and Legendre in the cube root, ``n`` on either side."""
    split = np.clip(centre, low, high)[:, None]
    x, weight = np.polynomial.legendre.leggauss(n)
    root = (x + 1) / 2
    node, width = root**3, 1.5 * root**2 * weight
    below, above = split - low, high - split
    nodes = np.concatenate([split - below * node, split + above * node], axis=1)
    return nodes, np.concatenate([below * width, above * width], axis=1)


def _gnomonic(
    theta: float, u: np.ndarray, v: np.ndarray, area: np.ndarray
) -> tuple[Directions, np.ndarray]:
    """Directions through points (u, v) of the plane that touches at ``theta``, and solid angle times cosine of ``area``."""
    sin, cos = np.sin(theta), np.cos(theta)
    length = np.sqrt(1 + u**2 + v**2)
    directions = np.stack([sin + u * cos, v, cos - u * sin], axis=-1) / length[..., None]
    return directions, area / length**3 * directions[..., 2]


class Functional(NamedTuple):
    """A linear functional of a table: what each cell adds to a number, ``n(f) = sum over cells of w(cell) f(cell)``.

    An integral of f over pairs of directions becomes one: each node of its rule is spread over the corners of its trilinear
    lookup that are measured. The weights depend on which cells are measured, not on what is in them, so the number of a
    linear mix is the mix of the numbers.
    """

    cells: Int[np.ndarray, " n_cells"]
    weights: Float64[np.ndarray, " n_cells"]

    @classmethod
    def integral(
        cls,
        grid: Grid,
        measured: Mask,
        wi: Directions,
        wo: Directions,
        weights: Float64[np.ndarray, "..."],
    ) -> "Functional":
        """The sum of ``weights`` times f at pairs of directions, of tables whose measured cells are ``measured``."""
        corners = grid.multilinear(wi, wo)
        shares = np.where(measured.ravel()[corners.cells], corners.weights, 0)
        total = shares.sum(axis=0)
        shares = np.divide(shares, total, out=np.zeros_like(shares), where=total > 0)
        first = corners.cells.min(initial=grid.size)
        sums = np.bincount((corners.cells - first).ravel(), (weights * shares).ravel())
        cells = np.flatnonzero(sums)
        return cls(cells + first, sums[cells])

    @classmethod
    def albedo(cls, grid: Grid, measured: Mask, theta_i: float) -> "Functional":
        """The directional albedo for light from ``theta_i`` radians, as `halfway.brdf.directional_albedo` has it.

        With two nodes or more for a cell of phi_h, where the grid has that axis; the light's azimuth is 0.
        """
        cells = [round(a.size * 2 * np.pi / a.stop) for a in grid.axes if a.angle == "phi_h"]
        rule = HalfVectors.at(theta_i, N_THETA_H, max(N_PHI_H, *(2 * n for n in cells), 0))
        return cls.integral(grid, measured, rule.fixed, rule.other, rule.weights)

    @classmethod
    def mean(cls, cells: Int[np.ndarray, " n_cells"]) -> "Functional":
        """The mean over ``cells``."""
        return cls(cells, np.full(len(cells), 1 / max(len(cells), 1)))

    def of(self, samples: Float[np.ndarray, "c p"]) -> Float64[np.ndarray, " c"]:
        """The numbers of tables, or of the channels of one."""
        return np.take(samples, self.cells, axis=1).astype(np.float64) @ self.weights


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


def light_weights(grid: Grid) -> Float64[np.ndarray, " p"]:
    """How much each cell passes on in even light, solid angle times both cosines; they sum to 1, and are 0 off the mask."""
    cells = comparison_cells(grid)
    weights = np.where(grid.mask(), cells.solid_angle * cells.cos_i * cells.cos_o, 0).ravel()
    return weights / weights.sum()


def spread_angles(n: int) -> HalfDiff:
    """``n`` half/difference angles spread evenly over the positions of a MERL table, by an additive recurrence; phi_h is 0.

    M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018: powers of 1/1.22074, for three dimensions.
    """
    position = np.outer(np.arange(1, n + 1), 1.2207440846057596 ** -np.arange(1.0, 4)) % 1
    theta_h, theta_d, phi_d = (
        axis.to_angle(axis.size * x) for axis, x in zip(MERL.axes, position.T, strict=True)
    )
    return HalfDiff(theta_h, np.zeros_like(theta_h), theta_d, phi_d)
