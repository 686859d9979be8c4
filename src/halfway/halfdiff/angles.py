"""Half and difference angles of a pair of directions.

A direction is a unit vector in the local frame of the surface: normal +z, tangent +x.
``wi`` points to the light, ``wo`` to the viewer. All angles are in radians.

    h = (wi + wo) / |wi + wo|              theta_h, phi_h are its polar angles
    d = R_y(-theta_h) R_z(-phi_h) wi       theta_d, phi_d are its polar angles

Swapping ``wi`` and ``wo`` turns phi_d by pi; turning the surface about its normal changes phi_h alone.

Reference: S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF
Representation", Eurographics Workshop on Rendering 1998, section 3.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from .._types import Angle, Directions, Values

AT_ONCE = 1 << 14
"""Pairs evaluated at once: what they need stays in a core's cache."""


class HalfDiff(NamedTuple):
    """Half/difference angles, in radians; arrays that broadcast together."""

    theta_h: Angle  # [0, pi/2]
    phi_h: Angle  # (-pi, pi]
    theta_d: Angle  # [0, pi/2]
    phi_d: Angle  # (-pi, pi]


def to_half_diff(wi: Directions, wo: Directions) -> HalfDiff:
    """Half/difference angles of the pairs ``(wi, wo)``; not defined where ``wi = -wo``."""
    h = wi + wo
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    theta_h, phi_h = to_polar(h)
    theta_d, phi_d = to_polar(_rotate_y(turn(wi, -phi_h), -theta_h))
    return HalfDiff(theta_h, phi_h, theta_d, phi_d)


def from_half_diff(angles: HalfDiff) -> tuple[Directions, Directions]:
    """The pairs ``(wi, wo)`` with these half/difference angles; the inverse of `to_half_diff`."""
    theta_h, phi_h, theta_d, phi_d = np.broadcast_arrays(*angles)
    d = from_polar(theta_d, phi_d)
    mirrored = d * np.array([-1.0, -1.0, 1.0])
    wi, wo = (turn(_rotate_y(v, theta_h), phi_h) for v in (d, mirrored))
    return wi, wo


def to_polar(v: Directions) -> tuple[Angle, Angle]:
    """The angles of directions from the normal, and about it from the tangent."""
    x, y, z = np.moveaxis(v, -1, 0)
    # arctan2 keeps full precision near the pole, where arccos(z) loses half the digits.
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)


def from_polar(theta: Angle, phi: Angle) -> Directions:
    """The directions at these angles; the inverse of `to_polar`."""
    sin = np.sin(theta)
    return np.stack([sin * np.cos(phi), sin * np.sin(phi), np.cos(theta)], axis=-1)


def cosines(theta_h: Angle, theta_d: Angle, phi_d: Angle) -> tuple[Angle, Angle]:
    """Cosines of the angles that ``wi`` and ``wo`` make with the normal: the z of `from_half_diff`."""
    along = np.cos(theta_h) * np.cos(theta_d)
    across = np.sin(theta_h) * np.sin(theta_d) * np.cos(phi_d)
    return along - across, along + across


def reflect(v: Directions, h: Directions, cos_d: Float[np.ndarray, "..."]) -> Directions:
    """The directions on the other side of half vectors: ``2 cos_d h - v`` with ``cos_d = v . h``, known to whoever asks."""
    return 2 * cos_d[..., None] * h - v


def turn(v: Directions, angle: Angle | float) -> Directions:
    """Directions turned about the normal by ``angle`` radians, from +x towards +y."""
    x, y, z = np.moveaxis(v, -1, 0)
    c, s = np.cos(angle), np.sin(angle)
    return np.stack(np.broadcast_arrays(c * x - s * y, s * x + c * y, z), axis=-1)


def above_horizon(
    f: Callable[[Directions, Directions], np.ndarray], wi: Directions, wo: Directions
) -> Values:
    """``f`` of the pairs that are above the horizon, shape (..., 3), and 0 of the others.

    It is called for `AT_ONCE` pairs or fewer, and gives values of shape (3, n_pairs).
    """
    wi, wo = np.broadcast_arrays(wi, wo)
    lit = (wi[..., 2] > 0) & (wo[..., 2] > 0)
    wi, wo = wi[lit], wo[lit]
    above = np.empty((len(wi), 3))
    for start in range(0, len(wi), AT_ONCE):
        chunk = slice(start, start + AT_ONCE)
        above[chunk] = f(wi[chunk], wo[chunk]).T
    values = np.zeros((*lit.shape, 3))
    values[lit] = above
    return values


def _rotate_y(v: Directions, angle: Angle) -> Directions:
    x, y, z = np.moveaxis(v, -1, 0)
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x + s * z, y, c * z - s * x], axis=-1)
