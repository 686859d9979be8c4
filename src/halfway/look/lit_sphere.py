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

An anisotropic material has a tangent field (see `sphere_rule`), and its moments are tabulated in the azimuth phi_o of the viewer
from it as well.
Pixels are averages over a square of points, those on the sphere; a highlight narrower than a pixel keeps its energy.

In place of lights and sky there may be a picture of what surrounds the sphere (see `environment`).
"""

import hashlib
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Float32, Float64, Int

from .._types import Directions, Mask
from ..halfdiff import Grid, turn
from .environment import N_DIRECTIONS, Environment, environment_queries
from .sphere_rule import (
    AXIS,
    N_SKY_AZIMUTHS,
    N_SKY_HALF_VECTORS,
    N_SKY_NODES,
    N_TURNED_HALF_VECTORS,
    Frame,
    Queries,
    SkyNodes,
    light_queries,
    points,
    sky_queries,
)

Angles = Float64[np.ndarray, "..."]
Indices = Int[np.ndarray, "..."]
Sparse = Any
"""A ``scipy.sparse.csr_array``, which is imported when one is made."""


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
    environment: Environment | None = field(default=None, repr=False)
    """In place of the lights; its digest is in the name."""

    @classmethod
    def under(
        cls, lights: Float[np.ndarray, "n 3"] | Float[np.ndarray, "height width 3"]
    ) -> "SphereScene":
        """In other light: parallel, from some directions, as strong from each; or from what surrounds the sphere.

        Directions are in the camera's frame: x is right, y up, z to the viewer. What surrounds the sphere is radiance by latitude and
        longitude: the top row looks up, the middle column away from the viewer; as bright as makes a white matte sphere .5 in the mean.
        """
        dark = Sky((0.0, 1.0, 0.0), zenith=0.0, nadir=0.0)
        if lights.ndim == 3:
            environment = Environment.of(lights)
            name = f"environment {environment.digest} {N_DIRECTIONS}"
            return cls(name, (), dark, size=48, n_points=2, environment=environment)
        each = [Light((x, y, z), np.pi / len(lights)) for x, y, z in lights.tolist()]
        return cls("lights", tuple(each), dark)

    def mask(self) -> Mask:
        """True at the pixels of the sphere, shape (size, size), the first row on top."""
        _, pixel = points(self.size, self.n_points)
        mask = np.zeros(self.size**2, bool)
        mask[pixel] = True
        return mask.reshape(self.size, self.size)

    def fingerprint(self) -> str:
        """Hex digits that change when the scene or the way it is integrated does; part of a cache key."""
        parts = (self, N_SKY_NODES, N_SKY_HALF_VECTORS, AXIS, N_SKY_AZIMUTHS, N_TURNED_HALF_VECTORS)
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
    lights: tuple[Sparse, ...]
    """(n_pixels, n_queries), irradiance x cosine / points of the pixel; of all channels, or of each."""
    moments: Sparse
    """(n_nodes x 4, n_queries), solid angle x cosine x (1, w) in the viewer's frame at the point."""
    sky: Sparse
    """(n_pixels, n_nodes x 4), the sky at each pixel in terms of the moments."""

    @classmethod
    @lru_cache(maxsize=2)  # .1 s and 30 MB each, on the MERL grid
    def of(cls, scene: SphereScene, grid: Grid) -> "SphereOperator":
        """The operator of ``scene`` for tables on ``grid``."""
        frame, pixel = points(scene.size, scene.n_points)
        light = _direct(scene, frame)
        nodes = SkyNodes.of(grid)
        moment = sky_queries(nodes)
        wi, wo, phi_o = (np.concatenate(pair) for pair in zip(light[:3], moment[:3], strict=True))
        if not grid.is_isotropic:  # the viewer's azimuth from the tangent, no more from itself
            wi, wo = turn(wi, phi_o), turn(wo, phi_o)
        cells, lookup = _lookup(grid, wi, wo)
        rows = np.unique(pixel, return_inverse=True)[1]
        return cls(
            cells,
            lookup,
            _light_sums(light, rows, len(wi)),
            _moment_sums(moment, nodes.size, len(wi)),
            _sky_sums(scene.sky, frame, rows, nodes),
        )

    def picture(self, row: Float32[np.ndarray, "3 p"]) -> Float32[np.ndarray, "n_pixels 3"]:
        """Linear RGB of the sphere's pixels, in the order of `SphereScene.mask`."""
        samples = row[:, self.cells]
        measured = ~np.isnan(samples)
        alike = bool((measured == measured[0]).all())
        weights = [self.lookup @ mask.astype(np.float32) for mask in measured[: 1 if alike else 3]]
        # One channel after another: scipy takes three columns together in twice the time.
        channels = []
        for channel, values in enumerate(np.where(measured, samples, np.float32(0))):
            total, weight = self.lookup @ values, weights[channel % len(weights)]
            f = np.divide(total, weight, out=np.zeros_like(total), where=weight > 0)
            lit = self.lights[channel % len(self.lights)] @ f
            channels.append(lit + self.sky @ (self.moments @ f))
        return np.stack(channels, axis=1)


class FilledSphere(NamedTuple):
    """What `SphereOperator` does, for tables that all have values in the same cells: lookups and sums are one matrix."""

    cells: Indices
    direct: tuple[Sparse, ...]
    """(n_pixels, n_touched); of all channels, or of each."""
    moments: Sparse
    """(n_nodes x 4, n_touched)."""
    sky: Sparse
    """(n_pixels, n_nodes x 4)."""

    @classmethod
    def of(
        cls, scene: SphereScene, grid: Grid, *, step: int = 1, measured: Mask | None = None
    ) -> "FilledSphere":
        """Of every so many of the scene's pixels; of tables that have values in the cells that are measured, or in all."""
        cells, lookup, lights, moments, sky = SphereOperator.of(scene, grid)
        if measured is not None:
            lookup = _of_measured(lookup, measured.ravel()[cells])
        direct = tuple(each[::step] @ lookup for each in lights)
        return cls(cells, direct, moments @ lookup, sky[::step])

    def pictures(self, tables: Float32[np.ndarray, "3 k p"]) -> Float32[np.ndarray, "k n_pixels 3"]:
        """Linear RGB of the sphere's pixels for each table."""
        samples = tables[..., self.cells].reshape(-1, len(self.cells)).T
        seen = _by_channel(self.direct, samples) + self.sky @ (self.moments @ samples)
        return np.ascontiguousarray(seen.T.reshape(3, -1, len(seen)).transpose(1, 2, 0))


def _by_channel(
    sums: tuple[Sparse, ...], columns: Float32[np.ndarray, "n_queries k"]
) -> Float32[np.ndarray, "n_pixels k"]:
    """Sums over the columns of all channels, or over those of each."""
    parts = np.split(columns, len(sums), axis=1)
    return np.concatenate([m @ part for m, part in zip(sums, parts, strict=True)], axis=1)


def _of_measured(lookup: Sparse, measured: Bool[np.ndarray, " n_touched"]) -> Sparse:
    """The weights of measured corners, renormalised."""
    kept = lookup.multiply(measured[None].astype(np.float32)).tocsr()
    total = kept.sum(axis=1)
    scale = np.divide(1, total, out=np.zeros_like(total), where=total > 0)
    return kept.multiply(scale[:, None]).tocsr()


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


def _direct(scene: SphereScene, frame: Frame) -> Queries:
    if scene.environment is not None:
        return environment_queries(scene.environment, frame)
    irradiance = np.array([light.irradiance for light in scene.lights])
    return light_queries([light.direction for light in scene.lights], irradiance, frame)


def _light_sums(light: Queries, rows: Indices, n_queries: int) -> tuple[Sparse, ...]:
    share = 1 / np.bincount(rows)
    pixel = rows[light.owner]
    column = np.arange(len(pixel))
    shape = (len(share), n_queries)
    channels = np.atleast_2d(light.weight.T)
    return tuple(_sparse(weight * share[pixel], pixel, column, shape) for weight in channels)


def _moment_sums(moment: Queries, n_nodes: int, n_queries: int) -> Sparse:
    factors = np.column_stack([np.ones(len(moment.wi)), moment.wi])
    row = 4 * moment.owner[:, None] + np.arange(4)
    # The sky's queries come last.
    column = np.arange(n_queries - len(moment.wi), n_queries)[:, None].repeat(4, axis=1)
    weight = moment.weight[:, None] * factors
    return _sparse(weight.ravel(), row.ravel(), column.ravel(), (4 * n_nodes, n_queries))


def _sky_sums(sky: Sky, frame: Frame, rows: Indices, nodes: SkyNodes) -> Sparse:
    mean, slope = (sky.zenith + sky.nadir) / 2, (sky.zenith - sky.nadir) / 2
    (up,) = frame.to_local([sky.up])
    radiance = np.column_stack([np.full(len(up), mean), slope * up])
    radiance /= np.bincount(rows)[rows, None]
    node, share = nodes.around(frame.theta_o, frame.phi_o())
    weight = share[..., None] * radiance
    column = 4 * node[..., None] + np.arange(4)
    row = np.broadcast_to(rows[:, None], column.shape)
    shape = (int(rows.max()) + 1, 4 * nodes.size)
    return _sparse(weight.ravel(), row.ravel(), column.ravel(), shape)


def _sparse(weight: np.ndarray, row: Indices, column: Indices, shape: tuple[int, int]) -> Sparse:
    from scipy.sparse import csr_array

    return csr_array((weight.astype(np.float32), (row, column)), shape=shape)
