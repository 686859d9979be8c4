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
    begins: bool,
    ends: bool,
) -> None:
    """``total += weight sqrt(body + near gloss[lower] + far gloss[lower + 1])``, row by row.

    What ``begins`` a sum takes the total as 0, and what ``ends`` it squares that.
    """
    for row in range(len(total)):
        a, b = near[row, 0], far[row, 0]
        low, high = _around(gloss, lower[row])
        for i in range(total.shape[1]):
            mean = np.float32(0) if begins else total[row, i]
            mean += weight * np.sqrt(body[row, i] + (a * low[i] + b * high[i]))
            total[row, i] = mean * mean if ends else mean


@compiled
def add_four_stretched_roots(
    total: np.ndarray,
    bodies: tuple[np.ndarray, ...],
    glosses: tuple[np.ndarray, ...],
    lower: tuple[np.ndarray, ...],
    near: tuple[np.ndarray, ...],
    far: tuple[np.ndarray, ...],
    weights: tuple[np.float32, ...],
    begins: bool,
    ends: bool,
) -> None:
    """The same for four, one after another, with the sum in a register."""
    w0, w1, w2, w3 = weights
    for row in range(len(total)):
        out = total[row]
        body0, body1, body2, body3 = bodies[0][row], bodies[1][row], bodies[2][row], bodies[3][row]
        low0, high0 = _around(glosses[0], lower[0][row])
        low1, high1 = _around(glosses[1], lower[1][row])
        low2, high2 = _around(glosses[2], lower[2][row])
        low3, high3 = _around(glosses[3], lower[3][row])
        a0, a1, a2, a3 = near[0][row, 0], near[1][row, 0], near[2][row, 0], near[3][row, 0]
        b0, b1, b2, b3 = far[0][row, 0], far[1][row, 0], far[2][row, 0], far[3][row, 0]
        for i in range(len(out)):
            mean = np.float32(0) if begins else out[i]
            mean += w0 * np.sqrt(body0[i] + (a0 * low0[i] + b0 * high0[i]))
            mean += w1 * np.sqrt(body1[i] + (a1 * low1[i] + b1 * high1[i]))
            mean += w2 * np.sqrt(body2[i] + (a2 * low2[i] + b2 * high2[i]))
            mean += w3 * np.sqrt(body3[i] + (a3 * low3[i] + b3 * high3[i]))
            out[i] = mean * mean if ends else mean


@compiled
def _around(gloss: np.ndarray, lower: int) -> tuple[np.ndarray, np.ndarray]:
    """The rows of a gloss between which another one stands; from its foot on the last, which is 0."""
    last = len(gloss) - 1
    return gloss[min(lower, last)], gloss[min(lower + 1, last)]
