"""Grids over half/difference angles.

An axis of n cells maps an angle to a *position* in [0, n]. Cell i spans positions [i, i + 1] and its sample
stands at the centre, i + 1/2:

    position    0         1         2                       n
                |----o----|----o----|----o----|  ...  |----o|
    sample           0         1         2               n-1

The MERL grid (W. Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003, and the reader that comes with
the database) has 90 x 90 x 180 cells:

    position in theta_h   90 sqrt(theta_h / (pi/2))     narrow cells where highlights are
    position in theta_d   90 theta_d / (pi/2)
    position in phi_d     180 phi_d / pi                period pi, by reciprocity

The database's own reader takes the floor of the position. Code that puts the sample at the cell's left edge (position
i) is half a cell off: see the conventions page of the docs.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from itertools import product
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Float64, Int

from .._types import Angle, Directions, Indices, Mask, Part, Table
from ..errors import FormatError
from .angles import HalfDiff, cosines, from_half_diff, to_half_diff


@dataclass(frozen=True)
class Axis:
    """One angle in [0, stop] cut into ``size`` cells, evenly in ``angle ** (1 / power)``."""

    angle: str
    """Which angle: a field of `HalfDiff`."""
    size: int
    stop: float
    """The largest angle, in radians; the period of a periodic axis."""
    power: int = 1
    """1: evenly spaced; 2: square-root spaced, narrow cells near 0."""
    periodic: bool = False

    def to_position(self, angle: Angle) -> Angle:
        """Positions in [0, size] of angles in radians."""
        if self.periodic:
            # The remainder of a tiny negative angle rounds to the period itself, which is position 0.
            return self.size * (np.mod(angle, self.stop) / self.stop) % self.size
        return self.size * np.clip(angle / self.stop, 0, 1) ** (1 / self.power)

    def to_angle(self, position: Angle) -> Angle:
        """Angles in radians of positions in [0, size]."""
        return self.stop * (position / self.size) ** self.power

    def centres(self) -> Float64[np.ndarray, " size"]:
        """Angles of the cell centres, shape (size,)."""
        return np.asarray(self.to_angle(np.arange(self.size) + 0.5))

    def edges(self) -> Float64[np.ndarray, " n_edges"]:
        """Angles of the cells' ends, shape (size + 1,)."""
        return np.asarray(self.to_angle(np.arange(self.size + 1.0)))


class Corners(NamedTuple):
    """The cells that a lookup blends."""

    cells: Int[np.ndarray, "..."]  # (n_corners, ...), flat indices into the grid
    weights: Float64[
        np.ndarray, "..."
    ]  # (n_corners, ...), non-negative, summing to 1 over the first axis

    @classmethod
    def between(
        cls, sides: Iterable[Sequence[tuple[Indices, Angle]]], shape: tuple[int, ...]
    ) -> "Corners":
        """Those in a table of this shape, from the cells on each side along each axis and how much they count."""
        corners = list(product(*sides))
        cells = [
            np.ravel_multi_index(tuple(cell for cell, _ in corner), shape) for corner in corners
        ]
        weights = [reduce(np.multiply, [weight for _, weight in corner]) for corner in corners]
        return cls(np.stack(cells), np.stack(weights))

    def blend(self, values: Table) -> Float64[np.ndarray, "3 n"]:
        """The weighted mean of the samples at the corners that are measured; NaN where none is."""
        samples = np.take(values.reshape(3, -1), self.cells, axis=1)
        blended = np.einsum("cjn,jn->cn", samples, self.weights)
        partly = np.isnan(blended).any(axis=0)
        if partly.any():
            blended[:, partly] = _renormalised(samples[..., partly], self.weights[:, partly])
        return blended


def _renormalised(
    samples: Float32[np.ndarray, "3 n_corners n"], weights: Float64[np.ndarray, "n_corners n"]
) -> Float64[np.ndarray, "3 n"]:
    """The blend of the corners that are measured; NaN where none is."""
    counted = np.where(np.isnan(samples), 0.0, weights)
    with np.errstate(invalid="ignore"):
        return (counted * np.nan_to_num(samples)).sum(axis=1) / counted.sum(axis=1)


@dataclass(frozen=True)
class Grid:
    """Cells over some of the half/difference angles, in the order in which a table stores them."""

    axes: tuple[Axis, ...]

    @classmethod
    def merl(cls, n_theta_h: int = 90, n_theta_d: int = 90, n_phi_d: int = 180) -> "Grid":
        """The grid of a MERL file whose header states these sizes.

        Raises
        ------
        FormatError
            When a size is no positive whole number.
        """
        _check_sizes(n_theta_h, n_theta_d, n_phi_d, such_as="90, 90, 180")
        return cls(
            (
                Axis("theta_h", n_theta_h, math.pi / 2, power=2),
                Axis("theta_d", n_theta_d, math.pi / 2),
                Axis("phi_d", n_phi_d, math.pi, periodic=True),
            )
        )

    @classmethod
    def anisotropic(
        cls,
        n_theta_h: int = 64,
        n_phi_h: int | None = None,
        n_theta_d: int = 24,
        n_phi_d: int = 20,
        *,
        period: float = 2 * math.pi,
    ) -> "Grid":
        """A grid for materials that depend on phi_h, as well as on what a MERL file has; 66 MB of float32 a material.

        ``period`` is the turn about the normal after which a material looks the same: pi for threads and brushes, and half
        the cells along phi_h, of which there are 180 in a whole turn where no other number is asked for. phi_d has the period
        pi here too, for exchanging light and viewer leaves h where it is. What the sizes cost and bring: docs/anisotropy.

        Raises
        ------
        FormatError
            When a size is no positive whole number, or a whole turn is not a whole number of periods.
        """
        turns = 2 * math.pi / period if period > 0 else 0
        if turns < 1 or not math.isclose(turns, round(turns), rel_tol=1e-9):
            raise FormatError(
                f"a material that looks the same after a turn of {period:.6g} about its normal is none: "
                "expected 2 pi, or that by a whole number."
            )
        n_phi_h = round(180 / turns) if n_phi_h is None else n_phi_h
        _check_sizes(n_theta_h, n_phi_h, n_theta_d, n_phi_d, such_as="48, 36, 24, 36")
        return cls(
            (
                Axis("theta_h", n_theta_h, math.pi / 2, power=2),
                Axis("phi_h", n_phi_h, period, periodic=True),
                Axis("theta_d", n_theta_d, math.pi / 2),
                Axis("phi_d", n_phi_d, math.pi, periodic=True),
            )
        )

    @property
    def shape(self) -> tuple[int, ...]:
        """Cells along each axis."""
        return tuple(axis.size for axis in self.axes)

    @property
    def size(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    def axis(self, angle: str) -> Axis:
        """The axis of an angle that the grid has."""
        return next(axis for axis in self.axes if axis.angle == angle)

    @property
    def is_isotropic(self) -> bool:
        """Whether no table on it can depend on phi_h."""
        return all(axis.angle != "phi_h" for axis in self.axes)

    def __str__(self) -> str:
        return " x ".join(map(str, self.shape))

    def without(self, angle: str) -> "Grid":
        """The grid of the other axes: for tables that do not depend on ``angle``."""
        return Grid(tuple(axis for axis in self.axes if axis.angle != angle))

    def centres(self, part: Part = ()) -> HalfDiff:
        """Angles of the cell centres of a part, as arrays that broadcast to its shape; 0 for an angle without an axis."""
        ranges = part if isinstance(part, tuple) else (part,)
        angles = {name: np.zeros((1,) * len(self.axes)) for name in HalfDiff._fields}
        for i, axis in enumerate(self.axes):
            along = [1] * len(self.axes)
            along[i] = -1
            centres = axis.centres()[ranges[i]] if i < len(ranges) else axis.centres()
            angles[axis.angle] = centres.reshape(along)
        return HalfDiff(**angles)

    def directions(self) -> tuple[Directions, Directions]:
        """The pair ``(wi, wo)`` at every cell centre, each of shape (*shape, 3)."""
        wi, wo = from_half_diff(self.centres())
        shape = (*self.shape, 3)
        return np.broadcast_to(wi, shape), np.broadcast_to(wo, shape)

    def mask(self) -> Mask:
        """True where both directions at the cell's centre are above the horizon, shape `shape`; read-only."""
        return _mask(self)

    def solid_angles(self) -> Float64[np.ndarray, "..."]:
        """Measure of each cell in an integral over pairs of directions, in sr^2, shape `shape`.

            dwi dwo = 4 cos(theta_d) dwh dwd,   dw = sin(theta) dtheta dphi

        integrated over the cell. An angle without an axis counts whole, and a cell of a periodic axis for all its turns, so
        the cells sum to 8 pi^2; those on `mask` to (2 pi)^2, up to the cells that the horizon cuts.
        """
        measure = reduce(np.multiply.outer, [_measures(axis) for axis in self.axes])
        absent = set(_WHOLE) - {axis.angle for axis in self.axes}
        return measure * math.prod(_WHOLE[angle] for angle in absent)

    def floor(self, wi: Directions, wo: Directions) -> Corners:
        """The cell that each pair falls into: the lookup of the database's own reader and of pbrt-v2."""
        cells = [
            np.minimum(np.floor(x).astype(np.intp), axis.size - 1)
            for axis, x in zip(self.axes, self._positions(wi, wo), strict=True)
        ]
        flat = np.ravel_multi_index(tuple(cells), self.shape)
        return Corners(flat[None], np.ones((1, *flat.shape)))

    def multilinear(self, wi: Directions, wo: Directions) -> Corners:
        """The 2^d cells around each pair; periodic axes wrap, on the others the outer half cells clamp."""
        sides = map(_neighbours, self.axes, self._positions(wi, wo))
        return Corners.between(sides, self.shape)

    def _positions(self, wi: Directions, wo: Directions) -> list[Angle]:
        angles = to_half_diff(wi, wo)
        return [axis.to_position(getattr(angles, axis.angle)) for axis in self.axes]


def common_grid(grids: Iterable[Grid]) -> Grid:
    """On which tables of all these grids can stand: the first with phi_h, or else the first; the MERL grid for none.

    Where others are on grids of their own, they are sampled there.
    """
    grids = list(grids)
    return next((grid for grid in grids if not grid.is_isotropic), next(iter(grids), MERL))


def _check_sizes(*sizes: int, such_as: str) -> None:
    if any(size < 1 or size != int(size) for size in sizes):
        raise FormatError(
            f"a grid of {' x '.join(map(str, sizes))} cells is none: expected whole numbers from 1 on, such as {such_as}."
        )


MERL = Grid.merl()
"""The grid of the MERL database: 90 x 90 x 180 cells."""


@lru_cache(maxsize=8)
def _mask(grid: Grid) -> Mask:
    angles = grid.centres()
    cos_i, cos_o = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    mask = np.broadcast_to((cos_i > 0) & (cos_o > 0), grid.shape).copy()
    mask.flags.writeable = False
    return mask


_WHOLE = {"theta_h": 1.0, "phi_h": 2 * np.pi, "theta_d": 2.0, "phi_d": 2 * np.pi}
"""Integrals of sin(theta_h), 1, 4 cos(theta_d) sin(theta_d), 1 over all of each angle."""


def _measures(axis: Axis) -> Float64[np.ndarray, " n"]:
    edges = axis.edges()
    match axis.angle:
        case "theta_h":
            return -np.diff(np.cos(edges))
        case "theta_d":
            return 2 * np.diff(np.sin(edges) ** 2)
        case _:
            return np.diff(edges) * 2 * np.pi / (axis.stop if axis.periodic else 2 * np.pi)


def _neighbours(axis: Axis, position: Angle) -> list[tuple[Indices, Angle]]:
    lower = np.floor(position - 0.5).astype(np.intp)
    fraction = position - 0.5 - lower
    cells = [lower, lower + 1]
    if axis.periodic:
        cells = [cell % axis.size for cell in cells]
    else:
        cells = [np.clip(cell, 0, axis.size - 1) for cell in cells]
    return [(cells[0], 1 - fraction), (cells[1], fraction)]
