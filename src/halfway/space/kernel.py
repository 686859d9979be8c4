"""The inner loop of mixing, compiled.

Fused, four rows a pass: at most of the memory's bandwidth, where numpy's multiply and add pass over everything twice.
"""

import numba
import numpy as np


@numba.njit(nogil=True, cache=True)
def add_four(
    total: np.ndarray,
    a: np.ndarray,
    b: np.ndarray,
    c: np.ndarray,
    d: np.ndarray,
    w: np.ndarray,
    keep: bool,
) -> None:
    """``total = [total +] w . (a, b, c, d)`` in one pass; ``keep`` says whether the old total counts."""
    if keep:
        for i in range(len(total)):
            total[i] += w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i]
    else:
        for i in range(len(total)):
            total[i] = w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i]
