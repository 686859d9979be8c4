"""Directional albedo: how much of the light from one direction a surface reflects.

    a(theta_i) = integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo

The integral runs over half vectors, where measured materials are smooth: ``dwo = 4 (wi . h) dh``, with theta_h
square-root spaced as the MERL grid is. With an even number of nodes a cell (four of the MERL grid's by default), no node
falls on a border of the midpoint rule's pieces of a trilinear table; mirror-like ones are good to .3 %.
"""

from collections.abc import Callable

import numpy as np

from .._types import Angle, Directions, Values
from .brdf import Brdf


def directional_albedo(
    brdf: Brdf | Callable[[Directions, Directions], Values],
    theta_i: Angle | float,
    *,
    n_theta_h: int = 360,
    n_phi_h: int = 60,
) -> Values:
    """Reflected share of the light from ``theta_i`` (radians), shape (..., 3); dimensionless.

    Unmeasured values count as 0. ``n_theta_h`` and ``n_phi_h`` are the nodes of the midpoint rule. A function
    ``(wi, wo) -> values`` may stand in for a BRDF.
    """
    evaluate = brdf.eval if isinstance(brdf, Brdf) else brdf
    h, dh = hemisphere(n_theta_h, n_phi_h)
    return np.stack([_albedo(evaluate, t, h, dh) for t in np.ravel(theta_i)]).reshape(
        *np.shape(theta_i), 3
    )


def _albedo(
    evaluate: Callable[[Directions, Directions], Values], theta_i: float, h: Directions, dh: Angle
) -> Values:
    wi = np.array([np.sin(theta_i), 0.0, np.cos(theta_i)])
    cos_d = h @ wi
    wo = 2 * cos_d[:, None] * h - wi
    lit = (cos_d > 0) & (wo[:, 2] > 0)
    wo, measure = wo[lit], (4 * cos_d * dh)[lit]
    values = evaluate(np.broadcast_to(wi, wo.shape), wo)
    return np.einsum("n,nc->c", measure * wo[:, 2], np.nan_to_num(values))


def hemisphere(n_theta: int, n_phi: int) -> tuple[Directions, Angle]:
    """Nodes, shape (n, 3), and solid angles of a midpoint rule with square-root spaced theta."""
    edges = np.pi / 2 * (np.arange(n_theta + 1) / n_theta) ** 2
    theta = np.pi / 2 * ((np.arange(n_theta) + 0.5) / n_theta) ** 2
    phi = 2 * np.pi * (np.arange(n_phi) + 0.5) / n_phi
    theta_all, phi_all = (grid.ravel() for grid in np.meshgrid(theta, phi, indexing="ij"))
    sin = np.sin(theta_all)
    nodes = np.stack([sin * np.cos(phi_all), sin * np.sin(phi_all), np.cos(theta_all)], axis=-1)
    bands = -np.diff(np.cos(edges)) * 2 * np.pi / n_phi
    return nodes, np.repeat(bands, n_phi)
