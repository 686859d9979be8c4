"""Light from everywhere on the points of a sphere: a latitude-longitude picture of what surrounds it.

    integral of f_r(w, wo) L(w) max(0, n . w) dw

is summed at each point over as many directions to where the light is, with a density p_L in proportion to its luminance, as to
the other side of half vectors, p_h, with theta_h square-root spaced as in a MERL table:

    sum over both    f_r L cos(theta_i) / (n (p_L + p_h))

so that neither a small sun nor a narrow highlight is missed (E. Veach, L. Guibas, "Optimally Combining Sampling Techniques for
Monte Carlo Rendering", SIGGRAPH 1995: the balance heuristic). The directions are the same for all materials.
"""

from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256

import numpy as np
from jaxtyping import Float, Float64, Int

from .._types import Directions
from ..colour import LUMINANCE
from ..halfdiff import from_polar, reflect
from .sphere_rule import Frame, Queries, viewer

N_ROWS = 64
"""At most, of a finer picture; 3 degrees."""
N_DIRECTIONS = 32
"""Of each of the two kinds, at each point."""
GOLDEN = (5**0.5 - 1) / 2

Numbers = Float64[np.ndarray, "..."]


@dataclass(frozen=True, eq=False)
class Environment:
    """Radiance that is even in each cell of latitude and longitude."""

    radiance: Float64[np.ndarray, "n_rows n_columns 3"]
    """Linear RGB. The top row looks up, the middle column away from the viewer."""

    @classmethod
    def of(cls, picture: Float[np.ndarray, "height width 3"]) -> "Environment":
        """That of a picture, whose fine cells are averaged."""
        height, width, _ = picture.shape
        n = min(height, N_ROWS), min(width, 2 * N_ROWS)
        sizes = np.diff(np.cos(np.pi * np.arange(height + 1) / height))[:, None, None]
        total, area = (
            _pooled(np.broadcast_to(sizes * x, (height, width, x.shape[-1])), n)
            for x in (picture, np.ones((1, 1, 1)))
        )
        return cls(total / area)

    @property
    def digest(self) -> str:
        """Hex digits that change when it does."""
        return sha256(self.radiance.tobytes()).hexdigest()[:16]

    def at(self, directions: Directions) -> Float64[np.ndarray, "... 3"]:
        """Radiance from ``directions``, in the camera's frame: x is right, y up, z to the viewer."""
        return self.radiance[self._cell(directions)]

    def density(self, directions: Directions) -> Numbers:
        """Of `drawn`, per steradian."""
        return (self.radiance @ LUMINANCE / self._power[-1])[self._cell(directions)]

    def drawn(self, u: Numbers) -> Directions:
        """Directions to where the light is, from numbers in [0, 1), shape (..., 3)."""
        n, m, _ = self.radiance.shape
        index = np.searchsorted(self._power[:-1], u[..., 0] * self._power[-1], side="right")
        row, column = np.divmod(index, m)
        top, bottom = (np.cos(np.pi * edge / n) for edge in (row, row + 1))
        y = top + u[..., 1] * (bottom - top)
        turn = 2 * np.pi * (column + u[..., 2]) / m - np.pi
        across = np.sqrt(1 - y**2)
        return np.stack([across * np.sin(turn), y, -across * np.cos(turn)], axis=-1)

    @cached_property
    def _power(self) -> Float64[np.ndarray, " n_cells"]:
        """Luminance times solid angle, summed over the cells."""
        n, m, _ = self.radiance.shape
        bands = -np.diff(np.cos(np.pi * np.arange(n + 1) / n)) * 2 * np.pi / m
        return (self.radiance @ LUMINANCE * bands[:, None]).cumsum()

    def _cell(self, directions: Directions) -> tuple[Int[np.ndarray, "..."], ...]:
        n, m, _ = self.radiance.shape
        x, y, z = np.moveaxis(directions, -1, 0)
        shares = (np.arccos(y.clip(-1, 1)) / np.pi, np.arctan2(x, -z) / (2 * np.pi) + 0.5)
        return tuple(
            (s * k).astype(int).clip(0, k - 1) for s, k in zip(shares, (n, m), strict=True)
        )


def environment_queries(environment: Environment, frame: Frame) -> Queries:
    """The directions in which points see their surroundings, weighed by the light of each channel.

    It is scaled to make a white matte sphere .5 in the mean.
    """
    wo = viewer(frame.theta_o)[:, None]
    u = _spread(len(wo))
    h = _half_vectors(u)
    wi = np.concatenate(
        [_to_local(environment.drawn(u), frame), reflect(wo, h, (wo * h).sum(axis=-1))], axis=1
    )
    point = np.nonzero(wi[..., 2] > 0)[0]
    wi, wo = wi[wi[..., 2] > 0], wo[point, 0]
    seen = np.einsum("na,anx->nx", wi, np.stack(frame[:3])[:, point])
    density = environment.density(seen) + _half_vector_density(wi, wo)
    weight = environment.at(seen) * (wi[:, 2] / (N_DIRECTIONS * density))[:, None]
    white = np.bincount(point, weight @ LUMINANCE) / np.pi
    return Queries(wi, wo, frame.phi_o()[point], point, weight * (0.5 / white.mean()))


def _spread(n_points: int) -> Numbers:
    """Numbers in [0, 1) of each point, shape (n_points, N_DIRECTIONS, 3): the first in strata, the second spread over those."""
    rng = np.random.default_rng(0)
    i = np.arange(N_DIRECTIONS)
    u = rng.random((n_points, N_DIRECTIONS, 3))
    u[..., 0] = (i + u[..., 0]) / N_DIRECTIONS
    u[..., 1] = (i * GOLDEN + u[:, :1, 1]) % 1
    return u


def _to_local(directions: Directions, frame: Frame) -> Directions:
    return np.stack([(directions * axis[:, None]).sum(axis=-1) for axis in frame[:3]], axis=-1)


def _half_vectors(u: Numbers) -> Directions:
    return from_polar(np.pi / 2 * u[..., 0] ** 2, 2 * np.pi * u[..., 1])


def _half_vector_density(wi: Directions, wo: Directions) -> Numbers:
    """Of the directions on the other side of `_half_vectors`, per steradian: dwi = 4 cos(theta_d) dh."""
    h = wi + wo
    across = np.hypot(h[..., 0], h[..., 1])
    u = np.sqrt(np.arctan2(across, h[..., 2]) * 2 / np.pi)
    length = np.linalg.norm(h, axis=-1)
    # At the normal itself it is infinite, and nothing is read.
    per_half_vector = 1 / np.maximum(2 * np.pi**2 * u * across / length, 1e-12)
    return per_half_vector / (2 * length)


def _pooled(values: Numbers, n: tuple[int, int]) -> Numbers:
    """Sums over ``n`` rows and columns of cells of nearly one size."""
    for axis, k in enumerate(n):
        starts = -(-np.arange(k) * values.shape[axis] // k)
        values = np.add.reduceat(values, starts, axis=axis)
    return values
