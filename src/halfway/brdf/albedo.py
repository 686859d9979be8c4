"""Directional albedo: how much of the light from one direction a surface reflects.

    a(wi) = integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo

The integral runs over half vectors (`halfway.brdf.quadrature`). With an even number of nodes a cell (four of the MERL
grid's by default), no node falls on a border of the midpoint rule's pieces of a trilinear table; mirror-like ones are good
to .3 %.
"""

from collections.abc import Callable

import numpy as np

from .._types import Angle, Directions, Values
from .brdf import Brdf
from .quadrature import HalfVectors


def directional_albedo(
    brdf: Brdf | Callable[[Directions, Directions], Values],
    theta_i: Angle | float,
    phi_i: Angle | float = 0.0,
    *,
    n_theta_h: int = 360,
    n_phi_h: int = 60,
) -> Values:
    """Reflected share of the light from ``theta_i`` and ``phi_i`` (radians), shape (..., 3); dimensionless.

    The azimuth is that of the light, from the tangent: an isotropic material reflects as much from any. Unmeasured values
    count as 0. ``n_theta_h`` and ``n_phi_h`` are the nodes of the midpoint rule. A function ``(wi, wo) -> values`` may stand
    in for a BRDF.
    """
    evaluate = brdf.eval if isinstance(brdf, Brdf) else brdf
    theta_i, phi_i = np.broadcast_arrays(theta_i, phi_i)
    rules = (
        HalfVectors.at(theta, n_theta_h, n_phi_h).turned(phi)
        for theta, phi in zip(theta_i.ravel(), phi_i.ravel(), strict=True)
    )
    albedos = np.stack([_albedo(evaluate, rule) for rule in rules])
    return albedos.reshape(*theta_i.shape, 3)


def _albedo(
    evaluate: Callable[[Directions, Directions], Values], half_vectors: HalfVectors
) -> Values:
    values = evaluate(half_vectors.fixed, half_vectors.other)
    return np.einsum("n,nc->c", half_vectors.weights, np.nan_to_num(values))
