"""The linear programme behind `halfway.find`, and behind the ranges of attributes.

    minimise    cost . w + above . a + below . b
    where       w >= 0,  sum w = 1,  G w = a - b,  a >= 0,  b >= 0

over the weights w of the materials. Each row of G is a *goal*, which is 0 where it is met, with what it costs to be above it
and below it: a condition that must be met costs infinitely much on either side, a bound nothing on the one, the difference
from a reference the same on both. The simplex method ends at a corner, where no more weights differ from 0 than there are
goals met, and one. HiGHS solves it (Q. Huangfu, J. Hall, "Parallelizing the Dual Revised Simplex Method", Mathematical
Programming Computation 10, 2018).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

TOLERANCE = 1e-10
"""By which a goal may be missed; the smallest that HiGHS takes."""
LEAST_WEIGHT = 1e-12
"""Less is rounding."""

Weights = Float64[np.ndarray, " N"]


class Goals(NamedTuple):
    """K goals for the weights of N materials."""

    rows: Float64[np.ndarray, "K N"]
    """NaN where a material does not have what is asked for; it then takes no part."""
    above: Float64[np.ndarray, " K"]
    below: Float64[np.ndarray, " K"]

    @classmethod
    def join(cls, goals: Sequence["Goals"]) -> "Goals":
        """All of them."""
        return cls(*(np.concatenate(part) for part in zip(*goals, strict=True)))


def solve(cost: Float64[np.ndarray, " N"], goals: Goals) -> Weights | None:
    """The weights of least cost; None where none meet the goals."""
    from scipy.optimize import linprog  # half a second to load

    usable = np.isfinite(goals.rows).all(axis=0) & np.isfinite(cost)
    rows = goals.rows[:, usable]
    k, n = rows.shape
    sides = np.concatenate([goals.above, goals.below])
    free = np.isfinite(sides)
    most = np.concatenate([np.ones(n), np.where(free, np.inf, 0)])
    result = linprog(
        np.concatenate([cost[usable], np.where(free, sides, 0)]),
        A_eq=np.block([[np.ones((1, n)), np.zeros((1, 2 * k))], [rows, -np.eye(k), np.eye(k)]]),
        b_eq=np.eye(1 + k)[0],
        bounds=np.stack([np.zeros_like(most), most], axis=1),
        method="highs-ds",
        # Few rows and all of them dense: there is nothing to simplify before.
        options={"primal_feasibility_tolerance": TOLERANCE, "presolve": False},
    )
    if result.x is None:
        return None
    weights = np.zeros(len(usable))
    weights[usable] = np.where(result.x[:n] > LEAST_WEIGHT, result.x[:n], 0)
    return weights / weights.sum()
