"""Bounded least squares with numpy alone, for `halfway.fit` where there is no scipy.

Levenberg's and Marquardt's damped steps, from a Jacobian by differences, with each parameter kept in its bounds; one that stands at
a bound and wants to leave it is left out of the step (D. W. Marquardt, SIAM Journal 11(2), 1963).
"""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

STEP = 1e-5
"""Of the differences, as a share of a parameter's range."""


def least_squares(
    residuals: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    *,
    bounds: tuple[np.ndarray, np.ndarray],
    ftol: float = 1e-3,
    max_nfev: int = 40,
    **_: Any,
) -> SimpleNamespace:
    """What `scipy.optimize.least_squares` finds with the same arguments, nearly: ``x`` and ``cost``."""
    low, high = bounds
    x, damping = start, 1e-2
    here = residuals(x)
    for _ in range(max_nfev):
        slope = _jacobian(residuals, x, here, low, high)
        gradient = slope.T @ here
        free = ~((x <= low) & (gradient > 0) | (x >= high) & (gradient < 0))
        cost = here @ here
        better = False
        while not better and damping < 1e8:
            normal = slope.T @ slope
            normal[np.diag_indices_from(normal)] *= 1 + damping
            step = np.zeros_like(x)
            step[free] = np.linalg.lstsq(normal[np.ix_(free, free)], -gradient[free])[0]
            tried = np.clip(x + step, low, high)
            there = residuals(tried)
            better = bool(there @ there < cost)
            damping *= 0.3 if better else 5
        if not better:
            break
        x, here = tried, there
        if cost - here @ here < ftol * cost:
            break
    return SimpleNamespace(x=x, cost=0.5 * float(here @ here))


def _jacobian(
    residuals: Callable[[np.ndarray], np.ndarray],
    x: np.ndarray,
    here: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
) -> np.ndarray:
    steps = STEP * (high - low)
    steps = np.where(x + steps > high, -steps, steps)
    columns = [(residuals(x + step) - here) / step[i] for i, step in enumerate(np.diag(steps))]
    return np.stack(columns, axis=1)
