"""CIEDE2000 of pairs of colours.

Source: G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test
Data, and Mathematical Observations", Color Research and Application 30(1), 2005, equations 2 to 22, with kL = kC = kH = 1.

Hues are handled as unit vectors and half angles, where the published formula distinguishes cases: the difference of hues
``2 sqrt(C1 C2) sin(dh/2)`` is ``(a1 b2 - a2 b1) / sqrt((C1 C2 + a1 a2 + b1 b2) / 2)``, and the mean hue points along the sum
of the unit vectors. All in float64, so that near colours in float32 keep their digits.
"""

import cmath
import math

import numpy as np
from jaxtyping import Complex128, Float64

Numbers = Float64[np.ndarray, "n"]
Hues = Complex128[np.ndarray, "n"]
"""a + ib."""
N_AT_ONCE = 1 << 13
"""Colours whose numbers stay in a core's cache."""


def differences(
    first: Float64[np.ndarray, "n 3"], second: Float64[np.ndarray, "n 3"]
) -> Float64[np.ndarray, "n"]:
    """Delta E_00 of each row of two arrays of CIELAB colours."""
    starts = range(0, len(first), N_AT_ONCE)
    parts = [_some(first[i : i + N_AT_ONCE], second[i : i + N_AT_ONCE]) for i in starts]
    return np.concatenate([np.zeros(0), *parts])


def _some(first: Float64[np.ndarray, "n 3"], second: Float64[np.ndarray, "n 3"]) -> Numbers:
    l1, l2 = first[:, 0], second[:, 0]
    p, q = (_stretched(first, second, colour) for colour in (first, second))
    c1, c2 = np.abs(p), np.abs(q)
    c_mean = (c1 + c2) / 2
    mean_hue = _mean_hue(p, c1, q, c2)
    away = ((l1 + l2) / 2 - 50) ** 2
    light = (l2 - l1) / (1 + 0.015 * away / np.sqrt(20 + away))
    chroma = (c2 - c1) / (1 + 0.045 * c_mean)
    hue = _hue_difference(p, q, c1 * c2) / (1 + 0.015 * c_mean * _hue_weight(mean_hue))
    degrees = np.degrees(np.angle(mean_hue)) % 360
    turn = math.radians(60) * np.exp(-(((degrees - 275) / 25) ** 2))
    rotation = -2 * _saturation(c_mean) * np.sin(turn)
    squared = light**2 + chroma**2 + hue**2 + rotation * chroma * hue
    return np.sqrt(np.maximum(squared, 0))


def _stretched(
    first: Float64[np.ndarray, "n 3"],
    second: Float64[np.ndarray, "n 3"],
    colour: Float64[np.ndarray, "n 3"],
) -> Hues:
    """One of two colours, its a* stretched where both are near to grey."""
    chroma = (np.hypot(*first[:, 1:].T) + np.hypot(*second[:, 1:].T)) / 2
    return (1.5 - 0.5 * _saturation(chroma)) * colour[:, 1] + 1j * colour[:, 2]


def _saturation(chroma: Numbers) -> Numbers:
    cube = chroma * chroma * chroma
    power = cube * cube * chroma
    return np.sqrt(power / (power + 25.0**7))


def _mean_hue(p: Hues, c1: Numbers, q: Hues, c2: Numbers) -> Hues:
    """The hue between two, the short way round, of length 1; where one has no hue, the other's."""
    total = p / np.where(c1 > 0, c1, 1) + q / np.where(c2 > 0, c2, 1)
    length = np.abs(total)
    return np.where(length > 0, total / np.where(length > 0, length, 1), 1)


def _hue_difference(p: Hues, q: Hues, product: Numbers) -> Numbers:
    a1, b1, a2, b2 = np.real(p), np.imag(p), np.real(q), np.imag(q)
    along, across = a1 * a2 + b1 * b2, a1 * b2 - b1 * a2
    small = np.abs(across) / np.sqrt(2 * np.where(along > 0, product + along, 1))
    large = np.sqrt(np.maximum(product - along, 0) / 2)
    return 2 * np.copysign(np.where(along > 0, small, large), across)


def _hue_weight(hue: Hues) -> Numbers:
    """T of the formula: cosines of the mean hue's multiples are real parts of its powers."""
    square = hue * hue
    cosines = [
        -0.17 * np.real(hue * cmath.rect(1, math.radians(-30))),
        0.24 * np.real(square),
        0.32 * np.real(square * hue * cmath.rect(1, math.radians(6))),
        -0.20 * np.real(square * square * cmath.rect(1, math.radians(-63))),
    ]
    return 1 + np.sum(cosines, axis=0)
