"""Directional albedo: how much of the light from one direction a surface reflects.

    a(theta_i) = integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo

The integral runs over half vectors (`halfway.brdf.quadrature`). With an even number of nodes a cell (four of the MERL
grid's by default), no node falls on a border of the midpoint rule's pieces of a trilinear table; mirror-like ones are good
to .3 %.
"""

from collections.abc import Callable

import numpy as np

from .._types import Angle, Directions, Values
from .brdf import Brdf, require_isotropic
from .quadrature import HalfVectors


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

    Raises
    ------
    AnisotropyError
        When the BRDF depends on the light's azimuth.
    """
    if isinstance(brdf, Brdf):
        require_isotropic(brdf, "its albedo")
    evaluate = brdf.eval if isinstance(brdf, Brdf) else brdf
    rules = (HalfVectors.at(theta, n_theta_h, n_phi_h) for theta in np.ravel(theta_i))
    albedos = np.stack([_albedo(evaluate, rule) for rule in rules])
    return albedos.reshape(*np.shape(theta_i), 3)


def _albedo(
    evaluate: Callable[[Directions, Directions], Values], half_vectors: HalfVectors
) -> Values:
    values = evaluate(half_vectors.fixed, half_vectors.other)
    return np.einsum("n,nc->c", half_vectors.weights, np.nan_to_num(values))
