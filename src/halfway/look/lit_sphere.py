"""A small lit sphere, and its picture by direct evaluation of a table.

The camera looks along -z at a unit sphere: x is right, y up, z to the viewer, who is far away, so ``wo`` = +z
everywhere. The radiance that a point with normal n sends to the viewer is

    sum over lights l   f_r(l, wo) E_l max(0, n . l)
    + integral          f_r(w, wo) L(w) max(0, n . w) dw        L(w) = (zenith + nadir)/2 + (zenith - nadir)/2 up . w

Light reaches the sphere directly, nothing is reflected twice: the picture is linear in the BRDF, and where the
measured cells agree the picture of a mix is the mix of the pictures, to rounding.

The sky is affine in w, so for an isotropic material its integral is made of four numbers that depend on the angle
theta_o between n and wo alone, the moments of f_r cos(theta_i) with 1 and with the three components of w in the frame
of the point. They are integrated over half vectors as in `halfway.brdf.directional_albedo` and tabulated in theta_o.
Pixels are averages over a square of points, those on the sphere; a highlight narrower than a pixel keeps its energy.
"""

import hashlib
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Float64, Int

from .._types import Directions, Mask
from ..brdf import quadrature, require_isotropic
from ..halfdiff import Grid

Angles = Float64[np.ndarray, "..."]
Indices = Int[np.ndarray, "..."]
Sparse = Any
"""A ``scipy.sparse.csr_array``, which is imported when one is made."""

N_SKY_NODES = 32
"""Angles theta_o at which the sky's moments are tabulated, linear between them."""
N_SKY_HALF_VECTORS = (90, 32)
"""Nodes in theta_h (square-root spaced) and phi_h of each moment. Against 96 nodes of (180, 128) the sky's share of a picture
is off by at most .0013 (chrome .0005 in the mean, the others .0001 and less)."""


@dataclass(frozen=True)
class Light:
    """Parallel light: a point light far away."""

    direction: tuple[float, float, float]
    """To the light, in the camera's frame; of any length."""
    irradiance: float
    """On a surface that faces it; pi makes a white matte surface 1."""


@dataclass(frozen=True)
class Sky:
    """Radiance that changes evenly from ``nadir`` to ``zenith`` along ``up``."""

    up: tuple[float, float, float]
    zenith: float
    nadir: float


@dataclass(frozen=True)
class SphereScene:
    """Lights and a sky around a unit sphere, and the raster that pictures it."""

    name: str
    lights: tuple[Light, ...]
    sky: Sky
    size: int = 64
    """Pixels along each side; the sphere touches all four."""
    n_points: int = 4
    """Points along each side of a pixel."""

    def mask(self) -> Mask:
        """True at the pixels of the sphere, shape (size, size), the first row on top."""
        _, pixel = _points(self)
        mask = np.zeros(self.size**2, bool)
        mask[pixel] = True
        return mask.reshape(self.size, self.size)

    def fingerprint(self) -> str:
        """Hex digits that change when the scene or the way it is integrated does; part of a cache key."""
        parts = (self, N_SKY_NODES, N_SKY_HALF_VECTORS)
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]


PACING_SCENE = SphereScene(
    "pacing",
    lights=(
        Light((-0.45, 0.55, 0.70), 1.85),  # key, from the upper left
        Light((0.85, 0.10, 0.45), 0.6),  # fill, from the right
        Light((0.35, 0.60, -0.55), 1.1),  # rim, from behind: grazing angles and large theta_d
    ),
    sky=Sky((0.0, 1.0, 0.0), zenith=0.44, nadir=0.0),
)
"""Where routes are paced: three lights and a soft sky; a white matte sphere reaches 1.0 at its brightest."""

JUDGING_SCENE = SphereScene(
    "judging",
    lights=(
        Light((0.30, 0.25, 0.92), 1.6),  # beside the viewer: highlights near the middle
        Light((-0.90, -0.15, 0.25), 0.85),  # low, from the left
        Light((-0.40, 0.75, -0.50), 1.25),  # rim
    ),
    sky=Sky((0.6, 0.7, 0.4), zenith=0.57, nadir=0.1),
)
"""Where routes are judged: other lights, another sky, as bright. Nothing is chosen by these pictures."""


class SphereOperator(NamedTuple):
    """Takes the samples of a material on a grid to its picture in a scene.

    Queries (pairs of directions) look up samples as `TabularBrdf.eval` does, trilinear and renormalised over the measured
    corners; a query without a measured corner counts as 0. Pixels are sums over queries.
    """

    cells: Indices
    """(n_touched,), the cells of the grid that any query touches."""
    lookup: Sparse
    """(n_queries, n_touched), trilinear weights; each row sums to 1."""
    lights: Sparse
    """(n_pixels, n_queries), irradiance x cosine / points of the pixel."""
    moments: Sparse
    """(n_nodes x 4, n_queries), solid angle x cosine x (1, w) in the point's frame."""
    sky: Sparse
    """(n_pixels, n_nodes x 4), the sky at each pixel in terms of the moments."""

    @classmethod
    def of(cls, scene: SphereScene, grid: Grid) -> "SphereOperator":
        """The operator of ``scene`` for isotropic tables on ``grid``.

        Raises
        ------
        AnisotropyError
            When tables on ``grid`` depend on phi_h.
        """
        require_isotropic(grid, "its lit sphere", name=f"a table on a grid of {grid} cells")
        frame, pixel = _points(scene)
        light = _light_queries(scene.lights, frame)
        theta_o, moment = _sky_queries()
        wi = np.concatenate([light.wi, moment.wi])
        cells, lookup = _lookup(grid, wi, np.concatenate([light.wo, moment.wo]))
        rows = np.unique(pixel, return_inverse=True)[1]
        return cls(
            cells,
            lookup,
            _light_sums(light, rows, len(wi)),
            _moment_sums(moment, len(wi)),
            _sky_sums(scene.sky, frame, rows, theta_o),
        )

    def picture(self, row: Float32[np.ndarray, "3 p"]) -> Float32[np.ndarray, "n_pixels 3"]:
        """Linear RGB of the sphere's pixels, in the order of `SphereScene.mask`."""
        samples = row[:, self.cells].T
        measured = ~np.isnan(samples)
        total = self.lookup @ np.where(measured, samples, np.float32(0))
        weight = self.lookup @ measured.astype(np.float32)
        values = np.divide(total, weight, out=np.zeros_like(total), where=weight > 0)
        return self.lights @ values + self.sky @ (self.moments @ values)


class FilledSphere(NamedTuple):
    """What `SphereOperator` does, for tables that have a value in every cell: lookups and sums are one matrix."""

    cells: Indices
    direct: Sparse
    """(n_pixels, n_touched)."""
    moments: Sparse
    """(n_nodes x 4, n_touched)."""
    sky: Sparse
    """(n_pixels, n_nodes x 4)."""

    @classmethod
    def of(cls, scene: SphereScene, grid: Grid, *, step: int = 1) -> "FilledSphere":
        """Of every so many of the scene's pixels."""
        cells, lookup, lights, moments, sky = SphereOperator.of(scene, grid)
        return cls(cells, lights[::step] @ lookup, moments @ lookup, sky[::step])

    def pictures(self, tables: Float32[np.ndarray, "3 k p"]) -> Float32[np.ndarray, "k n_pixels 3"]:
        """Linear RGB of the sphere's pixels for each table."""
        samples = tables[..., self.cells].reshape(-1, len(self.cells)).T
        seen = self.direct @ samples + self.sky @ (self.moments @ samples)
        return np.ascontiguousarray(seen.T.reshape(3, -1, len(seen)).transpose(1, 2, 0))


class _Frame(NamedTuple):
    """Local frames of points on the sphere, in the camera's coordinates; tangent towards the viewer."""

    tangent: Directions
    bitangent: Directions
    normal: Directions
    theta_o: Angles

    def to_local(self, directions: list[tuple[float, float, float]]) -> Directions:
        """Unit vectors along ``directions`` in each frame, shape (n_directions, n_points, 3)."""
        unit = np.reshape(directions, (-1, 3))
        unit = unit / np.linalg.norm(unit, axis=1, keepdims=True)
        return np.stack([unit @ axis.T for axis in self[:3]], axis=-1)


class _Queries(NamedTuple):
    wi: Directions
    wo: Directions
    owner: Indices
    """The point of the sphere, or the node of the sky, that each query belongs to."""
    weight: Float[np.ndarray, " n"]
    """Irradiance x cosine, or solid angle x cosine."""


def _points(scene: SphereScene) -> tuple[_Frame, Indices]:
    """The points of the raster that are on the sphere, and the pixel that each belongs to."""
    n = scene.size * scene.n_points
    x, y = np.meshgrid((np.arange(n) + 0.5) * 2 / n - 1, 1 - (np.arange(n) + 0.5) * 2 / n)
    pixels = np.arange(scene.size**2).reshape(scene.size, scene.size)
    pixel = pixels.repeat(scene.n_points, 0).repeat(scene.n_points, 1)
    sin = np.hypot(x, y)
    on_sphere = sin < 1
    return _frame(np.arcsin(sin[on_sphere]), np.arctan2(y, x)[on_sphere]), pixel[on_sphere]


def _frame(theta: Angles, phi: Angles) -> _Frame:
    sin, cos, zero = np.sin(theta), np.cos(theta), np.zeros_like(theta)
    across, up = np.cos(phi), np.sin(phi)
    return _Frame(
        np.stack([-cos * across, -cos * up, sin], axis=-1),
        np.stack([up, -across, zero], axis=-1),
        np.stack([sin * across, sin * up, cos], axis=-1),
        theta,
    )


def _light_queries(lights: tuple[Light, ...], frame: _Frame) -> _Queries:
    wi = frame.to_local([light.direction for light in lights])
    light, point = np.nonzero(wi[..., 2] > 0)
    wi = wi[light, point]
    irradiance = np.array([light.irradiance for light in lights])
    return _Queries(wi, _viewer(frame.theta_o[point]), point, irradiance[light] * wi[:, 2])


def _sky_queries() -> tuple[Angles, _Queries]:
    """The angles theta_o of the nodes, and the quadrature of their moments."""
    theta_o = (np.arange(N_SKY_NODES) + 0.5) * np.pi / 2 / N_SKY_NODES
    rules = [quadrature.HalfVectors.at(theta, *N_SKY_HALF_VECTORS) for theta in theta_o]
    owner = np.repeat(np.arange(N_SKY_NODES), [len(rule.dh) for rule in rules])
    _, wo, wi, _, _ = (np.concatenate(part) for part in zip(*rules, strict=True))
    weights = np.concatenate([rule.weights for rule in rules])
    return theta_o, _Queries(wi, wo, owner, weights)


def _viewer(theta_o: Angles) -> Directions:
    return np.stack([np.sin(theta_o), np.zeros_like(theta_o), np.cos(theta_o)], axis=-1)


def _lookup(grid: Grid, wi: Directions, wo: Directions) -> tuple[Indices, Sparse]:
    from scipy.sparse import csr_array

    corners = grid.multilinear(wi, wo)
    n_corners, n_queries = corners.cells.shape
    touched = np.zeros(grid.size, bool)
    touched[corners.cells] = True
    column = np.cumsum(touched) - 1
    entries = (
        corners.weights.T.ravel().astype(np.float32),
        column[corners.cells.T.ravel()].astype(np.int32),
        np.arange(n_queries + 1, dtype=np.int32) * n_corners,
    )
    cells = np.flatnonzero(touched)
    return cells, csr_array(entries, shape=(n_queries, len(cells)))


def _light_sums(light: _Queries, rows: Indices, n_queries: int) -> Sparse:
    share = 1 / np.bincount(rows)
    pixel = rows[light.owner]
    column = np.arange(len(pixel))
    return _sparse(light.weight * share[pixel], pixel, column, (len(share), n_queries))


def _moment_sums(moment: _Queries, n_queries: int) -> Sparse:
    factors = np.column_stack([np.ones(len(moment.wi)), moment.wi])
    row = 4 * moment.owner[:, None] + np.arange(4)
    # The sky's queries come last.
    column = np.arange(n_queries - len(moment.wi), n_queries)[:, None].repeat(4, axis=1)
    weight = moment.weight[:, None] * factors
    return _sparse(weight.ravel(), row.ravel(), column.ravel(), (4 * N_SKY_NODES, n_queries))


def _sky_sums(sky: Sky, frame: _Frame, rows: Indices, theta_o: Angles) -> Sparse:
    mean, slope = (sky.zenith + sky.nadir) / 2, (sky.zenith - sky.nadir) / 2
    (up,) = frame.to_local([sky.up])
    radiance = np.column_stack([np.full(len(up), mean), slope * up])
    radiance /= np.bincount(rows)[rows, None]
    position = np.clip((frame.theta_o - theta_o[0]) / (theta_o[1] - theta_o[0]), 0, N_SKY_NODES - 1)
    lower = np.minimum(position.astype(np.intp), N_SKY_NODES - 2)
    fraction = position - lower
    node = np.stack([lower, lower + 1])
    weight = np.stack([1 - fraction, fraction])[..., None] * radiance
    column = 4 * node[..., None] + np.arange(4)
    row = np.broadcast_to(rows[:, None], column.shape)
    shape = (int(rows.max()) + 1, 4 * N_SKY_NODES)
    return _sparse(weight.ravel(), row.ravel(), column.ravel(), shape)


def _sparse(weight: np.ndarray, row: Indices, column: Indices, shape: tuple[int, int]) -> Sparse:
    from scipy.sparse import csr_array

    return csr_array((weight.astype(np.float32), (row, column)), shape=shape)
