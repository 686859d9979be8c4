"""The inner loop of mixing, compiled.

Fused: one pass over all rows, summed in float64, at most of the memory's bandwidth, where numpy's multiply and add pass over
everything twice.
"""

import numpy as np

from ..compiled import compiled


@compiled
def sum_four(
    out: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray, w: np.ndarray
) -> None:
    """``out = w . (a, b, c, d)``."""
    w0, w1, w2, w3 = w[0], w[1], w[2], w[3]
    for i in range(len(out)):
        out[i] = w0 * a[i] + w1 * b[i] + w2 * c[i] + w3 * d[i]


@compiled
def sum_eight(
    out: np.ndarray,
    a: np.ndarray,
    b: np.ndarray,
    c: np.ndarray,
    d: np.ndarray,
    e: np.ndarray,
    f: np.ndarray,
    g: np.ndarray,
    h: np.ndarray,
    w: np.ndarray,
) -> None:
    """``out = w . (a, b, c, d, e, f, g, h)``."""
    w0, w1, w2, w3, w4, w5, w6, w7 = w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7]
    for i in range(len(out)):
        low = w0 * a[i] + w1 * b[i] + w2 * c[i] + w3 * d[i]
        out[i] = low + (w4 * e[i] + w5 * f[i] + w6 * g[i] + w7 * h[i])


@compiled
def add_stretched_roots(
    total: np.ndarray,
    body: np.ndarray,
    gloss: np.ndarray,
    lower: np.ndarray,
    near: np.ndarray,
    far: np.ndarray,
    weight: np.float32,
) -> None:
    """``total += weight sqrt(body + near gloss[lower] + far gloss[lower + 1])``, row by row."""
    for row in range(len(total)):
        a, b = near[row, 0], far[row, 0]
        low, high = gloss[lower[row]], gloss[min(lower[row] + 1, len(gloss) - 1)]
        for i in range(total.shape[1]):
            total[row, i] += weight * np.sqrt(body[row, i] + (a * low[i] + b * high[i]))
