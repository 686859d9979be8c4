"""CIEDE2000 of pairs of colours, compiled: pacing a route takes some 200,000 of them.

Source: G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test
Data, and Mathematical Observations", Color Research and Application 30(1), 2005, equations 2 to 22, with kL = kC = kH = 1.

Hues are handled as unit vectors and half angles, where the published formula distinguishes cases: the difference of hues
``2 sqrt(C1 C2) sin(dh/2)`` is ``(a1 b2 - a2 b1) / sqrt((C1 C2 + a1 a2 + b1 b2) / 2)``, and the mean hue points along the sum
of the unit vectors. All in float64, so that near colours in float32 keep their digits.
"""

import math

import numpy as np

from .compiled import compiled

_ROOT_POWER = 25.0**7
_SIXTY = math.radians(60)
_C30, _S30 = math.cos(math.radians(30)), math.sin(math.radians(30))
_C6, _S6 = math.cos(math.radians(6)), math.sin(math.radians(6))
_C63, _S63 = math.cos(math.radians(63)), math.sin(math.radians(63))


@compiled
def differences(first: np.ndarray, second: np.ndarray, out: np.ndarray) -> None:
    """Delta E_00 of each row of two arrays of CIELAB colours, shape (n, 3), into ``out``, shape (n,)."""
    for i in range(len(out)):
        out[i] = _difference(
            float(first[i, 0]), float(first[i, 1]), float(first[i, 2]),
            float(second[i, 0]), float(second[i, 1]), float(second[i, 2]),
        )  # fmt: skip


@compiled
def _difference(l1: float, a1: float, b1: float, l2: float, a2: float, b2: float) -> float:
    stretch = 1.5 - 0.5 * _saturation(
        (math.sqrt(a1 * a1 + b1 * b1) + math.sqrt(a2 * a2 + b2 * b2)) / 2
    )
    a1, a2 = stretch * a1, stretch * a2
    c1, c2 = math.sqrt(a1 * a1 + b1 * b1), math.sqrt(a2 * a2 + b2 * b2)
    l_mean, c_mean = (l1 + l2) / 2, (c1 + c2) / 2
    x, y = _mean_hue(a1, b1, c1, a2, b2, c2)
    away = (l_mean - 50) ** 2
    light = (l2 - l1) / (1 + 0.015 * away / math.sqrt(20 + away))
    chroma = (c2 - c1) / (1 + 0.045 * c_mean)
    hue = _hue_difference(a1, b1, a2, b2, c1 * c2) / (1 + 0.015 * c_mean * _hue_weight(x, y))
    degrees = math.degrees(math.atan2(y, x)) % 360
    turn = _SIXTY * math.exp(-(((degrees - 275) / 25) ** 2))
    rotation = -2 * _saturation(c_mean) * math.sin(turn)
    return math.sqrt(max(light**2 + chroma**2 + hue**2 + rotation * chroma * hue, 0.0))


@compiled
def _saturation(chroma: float) -> float:
    cube = chroma * chroma * chroma
    power = cube * cube * chroma
    return math.sqrt(power / (power + _ROOT_POWER))


@compiled
def _mean_hue(
    a1: float, b1: float, c1: float, a2: float, b2: float, c2: float
) -> tuple[float, float]:
    """Cosine and sine of the hue between two, the short way round; where one has no hue, the other's."""
    x, y = 0.0, 0.0
    if c1 > 0:
        x, y = a1 / c1, b1 / c1
    if c2 > 0:
        x, y = x + a2 / c2, y + b2 / c2
    length = math.sqrt(x * x + y * y)
    return (x / length, y / length) if length > 0 else (1.0, 0.0)


@compiled
def _hue_difference(a1: float, b1: float, a2: float, b2: float, product: float) -> float:
    along = a1 * a2 + b1 * b2
    across = a1 * b2 - b1 * a2
    if along > 0:
        size = abs(across) / math.sqrt(2 * (product + along))
    else:
        size = math.sqrt(max(product - along, 0.0) / 2)
    return 2 * math.copysign(size, across)


@compiled
def _hue_weight(c: float, s: float) -> float:
    """T of the formula, from the cosine and the sine of the mean hue h: cosines of its multiples without trigonometry."""
    c2, s2 = c * c - s * s, 2 * c * s
    c3, s3 = c2 * c - s2 * s, s2 * c + c2 * s
    c4, s4 = c2 * c2 - s2 * s2, 2 * c2 * s2
    return (
        1
        - 0.17 * (c * _C30 + s * _S30)
        + 0.24 * c2
        + 0.32 * (c3 * _C6 - s3 * _S6)
        - 0.20 * (c4 * _C63 + s4 * _S63)
    )
