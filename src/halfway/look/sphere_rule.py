"""Where a lit sphere is looked at: the points of its raster, and the pairs of directions at which a table is looked up.

Each point has a frame with its tangent towards the viewer, so that ``wo`` has the azimuth 0. An anisotropic material needs a
tangent of its own: it runs along the meridians of `AXIS`, whose poles are on the outline of the sphere, so that none faces the
viewer. phi_o is the azimuth of the viewer from it.
"""

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float64, Int

from .._types import Directions
from ..brdf import quadrature
from ..halfdiff import Grid

Angles = Float64[np.ndarray, "..."]
Indices = Int[np.ndarray, "..."]

N_SKY_NODES = 32
"""Angles theta_o at which the sky's moments are tabulated, linear between them."""
N_SKY_HALF_VECTORS = (90, 32)
"""Nodes in theta_h (square-root spaced) and phi_h of each moment. Against 96 nodes of (180, 128) the sky's share of a picture
is off by at most .0013 (chrome .0005 in the mean, the others .0001 and less)."""

AXIS = (-0.5, math.sqrt(0.75), 0.0)
"""Of the meridians that the tangent follows, towards it: 30 degrees to the left of straight up."""
N_SKY_AZIMUTHS = 16
"""Azimuths phi_o within a whole turn at which the moments of an anisotropic material are tabulated, at every other theta_o and
with `N_TURNED_HALF_VECTORS`."""
N_TURNED_HALF_VECTORS = (64, 32)


class Frame(NamedTuple):
    """Local frames of points on the sphere, in the camera's coordinates; tangent towards the viewer."""

    tangent: Directions
    bitangent: Directions
    normal: Directions
    theta_o: Angles

    def phi_o(self) -> Angles:
        """Azimuths of the viewer from the tangent of an anisotropic material, which follows the meridians of `AXIS`."""
        along, across = (v @ np.array(AXIS) for v in (self.tangent, self.bitangent))
        return -np.arctan2(across, along)

    def to_local(self, directions: list[tuple[float, float, float]]) -> Directions:
        """Unit vectors along ``directions`` in each frame, shape (n_directions, n_points, 3)."""
        unit = np.reshape(directions, (-1, 3))
        unit = unit / np.linalg.norm(unit, axis=1, keepdims=True)
        return np.stack([unit @ axis.T for axis in self[:3]], axis=-1)


class Queries(NamedTuple):
    """Pairs of directions, and what a sum over them weighs them by."""

    wi: Directions
    wo: Directions
    """In the viewer's frame, azimuth 0."""
    phi_o: Angles
    owner: Indices
    """The point of the sphere, or the node of the sky, that each query belongs to."""
    weight: Float[np.ndarray, " n"] | Float[np.ndarray, "n 3"]
    """Irradiance x cosine, or solid angle x cosine; of all channels, or of each."""


def points(size: int, n_points: int) -> tuple[Frame, Indices]:
    """The points of a raster that are on the sphere, and the pixel that each belongs to."""
    n = size * n_points
    x, y = np.meshgrid((np.arange(n) + 0.5) * 2 / n - 1, 1 - (np.arange(n) + 0.5) * 2 / n)
    pixels = np.arange(size**2).reshape(size, size)
    pixel = pixels.repeat(n_points, 0).repeat(n_points, 1)
    sin = np.hypot(x, y)
    on_sphere = sin < 1
    return frame(np.arcsin(sin[on_sphere]), np.arctan2(y, x)[on_sphere]), pixel[on_sphere]


def frame(theta: Angles, phi: Angles) -> Frame:
    """The frames of points of the sphere, theta from the middle of the picture and phi about it."""
    sin, cos, zero = np.sin(theta), np.cos(theta), np.zeros_like(theta)
    across, up = np.cos(phi), np.sin(phi)
    return Frame(
        np.stack([-cos * across, -cos * up, sin], axis=-1),
        np.stack([up, -across, zero], axis=-1),
        np.stack([sin * across, sin * up, cos], axis=-1),
        theta,
    )


def light_queries(
    to_lights: list[tuple[float, float, float]], irradiance: Angles, frame: Frame
) -> Queries:
    """The points that each light reaches."""
    wi = frame.to_local(to_lights)
    light, point = np.nonzero(wi[..., 2] > 0)
    wi = wi[light, point]
    wo = viewer(frame.theta_o[point])
    return Queries(wi, wo, frame.phi_o()[point], point, irradiance[light] * wi[:, 2])


class SkyNodes(NamedTuple):
    """Where the sky's moments are tabulated."""

    theta_o: Angles
    phi_o: Angles
    period: float
    half_vectors: tuple[int, int]

    @classmethod
    def of(cls, grid: Grid) -> "SkyNodes":
        """One azimuth for tables that do not depend on it."""
        if grid.is_isotropic:
            n, m, period, half_vectors = N_SKY_NODES, 1, 2 * np.pi, N_SKY_HALF_VECTORS
        else:
            period = grid.axis("phi_h").stop
            m = round(N_SKY_AZIMUTHS * period / (2 * np.pi))
            n, half_vectors = N_SKY_NODES // 2, N_TURNED_HALF_VECTORS
        theta_o = (np.arange(n) + 0.5) * np.pi / 2 / n
        return cls(theta_o, np.arange(m) * period / m, period, half_vectors)

    @property
    def size(self) -> int:
        return len(self.theta_o) * len(self.phi_o)

    def around(self, theta_o: Angles, phi_o: Angles) -> tuple[Indices, Angles]:
        """The nodes around viewers, and their weights; each of shape (n_around, n)."""
        n, m = len(self.theta_o), len(self.phi_o)
        step = self.theta_o[1] - self.theta_o[0]
        position = np.clip((theta_o - self.theta_o[0]) / step, 0, n - 1)
        lower = np.minimum(position.astype(np.intp), n - 2)
        of_theta = [(lower, lower + 1 - position), (lower + 1, position - lower)]
        of_phi = [(np.zeros_like(lower), np.ones_like(position))]
        if m > 1:
            turned = np.mod(phi_o / self.period, 1) * m
            before = turned.astype(np.intp)
            of_phi = [(before % m, before + 1 - turned), ((before + 1) % m, turned - before)]
        pairs = [(i * m + j, u * v) for i, u in of_theta for j, v in of_phi]
        node, weight = zip(*pairs, strict=True)
        return np.stack(node), np.stack(weight)


def sky_queries(nodes: SkyNodes) -> Queries:
    """The quadrature of the nodes' moments."""
    m = len(nodes.phi_o)
    rules = [quadrature.HalfVectors.at(theta, *nodes.half_vectors) for theta in nodes.theta_o]
    sizes = np.repeat([len(rule.dh) for rule in rules], m)
    owner = np.repeat(np.arange(nodes.size), sizes)
    parts = ((rule.other, rule.fixed, rule.weights) for rule in rules for _ in range(m))
    wi, wo, weights = (np.concatenate(part) for part in zip(*parts, strict=True))
    return Queries(wi, wo, nodes.phi_o[owner % m], owner, weights)


def viewer(theta_o: Angles) -> Directions:
    """The directions to a viewer at these angles from the normal, azimuth 0."""
    return np.stack([np.sin(theta_o), np.zeros_like(theta_o), np.cos(theta_o)], axis=-1)
