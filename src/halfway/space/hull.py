"""The place in a hull that is nearest to a point outside it."""

import numpy as np
from jaxtyping import Float64

from .._types import Points


def nearest_in_hull(
    points: Points, x: Float64[np.ndarray, " k"]
) -> Float64[np.ndarray, " n_points"]:
    """Weights of the point of the hull of ``points`` that is nearest to ``x``.

    Non-negative least squares of ``sum_j w_j (y_j - x) = 0, sum_j w_j = 1``: whatever the weights sum to, the best sum
    for a point at distance d leaves ``d^2/(1 + d^2)``, so the least of all is where d is least.

    Reference: P. Wolfe, "Finding the Nearest Point in a Polytope", Mathematical Programming 11, 1976.
    """
    from scipy.optimize import nnls  # a second to load

    towards = points - x
    scale = np.abs(towards).max(initial=0.0) or 1.0
    system = np.concatenate([towards.T / scale, np.ones((1, len(points)))])
    weights, _ = nnls(system, np.append(np.zeros(len(x)), 1.0))
    return weights / weights.sum()
