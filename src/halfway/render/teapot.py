"""The Utah teapot, from its Bezier patches.

M. E. Newell, "The Utilization of Procedure Models in Digital Image Synthesis", PhD thesis, University of Utah, 1975;
F. Crow, "The Origins of the Teapot", IEEE Computer Graphics and Applications 7(1), 1987. These are the proportions in
which it is usually drawn (lower than the pot in the museum), with the bottom that was added later. The axis is z, the
spout points to +x, the bottom stands at z = 0.

Rim, body, lid and bottom are surfaces of revolution: a cubic profile (r, z) turned about the axis, a quarter turn drawn as the
cubic (1, 0), (1, k), (k, 1), (0, 1) with k = 0.56. (The published knob has k = 0.5625 in one row, a rounding; here it
is 0.56 too.) Handle and spout are tubes: every row of control points is an inner point (x, z), an outer one, and a half
width w in y:

    inner (x, 0, z) - (x, w, z) - (x', w, z') - (x', 0, z') outer,          and its mirror image in y
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from .mesh import Mesh, joined, sheet, unit

Curve: TypeAlias = Callable[[np.ndarray, np.ndarray], np.ndarray]

K = 0.56
"""Where the control points of a quarter turn stand; a circle would have 0.5523."""

PROFILES = np.array(
    [
        # (r, z)
        [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)],  # rim
        [(1.5, 2.4), (1.75, 1.875), (2, 1.35), (2, 0.9)],  # body
        [(2, 0.9), (2, 0.45), (1.5, 0.225), (1.5, 0.15)],
        [(0, 3.15), (0.8, 3.15), (0, 2.85), (0.2, 2.7)],  # lid
        [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)],
        [(1.5, 0.15), (1.5, 0.075), (1.425, 0), (0, 0)],  # bottom
    ]
)
TUBES = np.array(
    [
        # (inner x, inner z, outer x, outer z, half width)
        [
            (-1.6, 2.025, -1.5, 2.25, 0.3),  # handle
            (-2.3, 2.025, -2.5, 2.25, 0.3),
            (-2.7, 2.025, -3, 2.25, 0.3),
            (-2.7, 1.8, -3, 1.8, 0.3),
        ],
        [
            (-2.7, 1.8, -3, 1.8, 0.3),
            (-2.7, 1.575, -3, 1.35, 0.3),
            (-2.5, 1.125, -2.65, 0.9375, 0.3),
            (-2, 0.9, -1.9, 0.6, 0.3),
        ],
        [
            (1.7, 1.425, 1.7, 0.6, 0.66),  # spout
            (2.6, 1.425, 3.1, 0.825, 0.66),
            (2.3, 2.1, 2.4, 2.025, 0.25),
            (2.7, 2.4, 3.3, 2.4, 0.25),
        ],
        [
            (2.7, 2.4, 3.3, 2.4, 0.25),
            (2.8, 2.475, 3.525, 2.49375, 0.25),
            (2.9, 2.475, 3.45, 2.5125, 0.15),
            (2.8, 2.4, 3.2, 2.4, 0.15),
        ],
    ]
)


def tessellate(n: int = 24) -> Mesh:
    """The teapot with ``n`` steps along each side of a patch; the normals are the surface's own.

    Tangents run around the axis of each part.
    """
    t = np.linspace(0, 1, n + 1)
    parts = [_revolve(profile, t) for profile in PROFILES] + [_sweep(tube, t) for tube in TUBES]
    return joined([sheet(*part) for part in parts])


def _revolve(profile: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and outward normals, shape (along, around, 3), of a profile turned about z."""
    (r, z), (dr, dz) = bezier(profile, t).T, tangent(profile, t).T
    c, dc = _turn(t)
    positions = _stack(r[:, None] * c[:, 0], r[:, None] * c[:, 1], z[:, None])
    along = _stack(dr[:, None] * c[:, 0], dr[:, None] * c[:, 1], dz[:, None])
    # The tangent around is r dc: without the r, the normal exists at the poles too.
    around = _stack(dc[:, 0], dc[:, 1], np.zeros((1, 1)))
    # Every profile runs with the outside on its left, seen with r to the right and z up.
    return positions, unit(np.cross(along, around))


def _turn(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A whole turn of unit radius and its tangent, shape (around, 2); the last point is the first."""
    quarter = np.array([(1, 0), (1, K), (K, 1), (0, 1)])
    quarters = [np.array([(1, 0), (0, 1)]), np.array([(0, 1), (-1, 0)])]
    quarters += [-q for q in quarters]
    turn, along = (
        np.concatenate([curve(quarter, t[:-1]) @ q for q in quarters])
        for curve in (bezier, tangent)
    )
    return np.concatenate([turn, turn[:1]]), np.concatenate([along, along[:1]])


def _sweep(rows: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and outward normals, shape (along, around, 3), of a tube."""
    inner_x, inner_z, outer_x, outer_z, w = rows.T
    half = np.stack(
        [
            _stack(inner_x, 0 * w, inner_z),
            _stack(inner_x, w, inner_z),
            _stack(outer_x, w, outer_z),
            _stack(outer_x, 0 * w, outer_z),
        ]
    )
    mirrored = half[::-1] * np.array([1, -1, 1])
    nets = ((half, t[:-1]), (mirrored, t))
    positions = np.concatenate([_patch(net, s, t, bezier, bezier) for net, s in nets], axis=1)
    around = np.concatenate([_patch(net, s, t, tangent, bezier) for net, s in nets], axis=1)
    along = np.concatenate([_patch(net, s, t, bezier, tangent) for net, s in nets], axis=1)
    return positions, unit(np.cross(along, around))


def _patch(
    net: np.ndarray, s: np.ndarray, t: np.ndarray, over_s: Curve, over_t: Curve
) -> np.ndarray:
    """A bicubic patch or its partial derivative, shape (t, s, 3), of control points (4, 4, 3) over (s, t)."""
    return over_t(np.moveaxis(over_s(net, s), 1, 0), t)


def bezier(control: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Points of a cubic Bezier curve at ``t``, shape (n, ...), of 4 control points (4, ...)."""
    u = 1 - t
    weights = np.stack([u**3, 3 * u**2 * t, 3 * u * t**2, t**3], axis=-1)
    return np.tensordot(weights, control, axes=1)


def tangent(control: np.ndarray, t: np.ndarray) -> np.ndarray:
    """The derivative of `bezier` by ``t``."""
    u = 1 - t
    weights = np.stack([u**2, 2 * u * t, t**2], axis=-1)
    return np.tensordot(3 * weights, np.diff(control, axis=0), axes=1)


def _stack(*parts: np.ndarray) -> np.ndarray:
    return np.stack(np.broadcast_arrays(*parts), axis=-1)
