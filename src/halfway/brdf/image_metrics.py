"""How different two pictures look.

Pictures are linear sRGB (D65), shape (..., n_pixels, 3), where 1 is the white of the display. They pass to the eye in
three steps:

    shown       what a display shows of them: a shoulder from .75 upwards that reaches 1 only at infinity
    to_lab      CIELAB of that light, relative to the display's white
    difference  of two pictures in CIELAB, the mean over their pixels

The shoulder keeps a mirror-like peak, 40 times white and more, from ruling a mean, and still tells a strong peak from a
stronger one; a clip would not. Everything is continuous in the picture, so it can pace a route.

References: IEC 61966-2-1 (sRGB); CIE 15 (CIELAB and its difference, 1976); G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000
Color-Difference Formula: Implementation Notes, Supplementary Test Data, and Mathematical Observations", Color Research
and Application 30(1), 2005; P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
"""

from importlib import import_module

import numpy as np
from jaxtyping import Float

from ..errors import HalfwayError

SHOULDER = 0.75
"""Linear value above which highlights are compressed."""

Pictures = Float[np.ndarray, "... n_pixels 3"]
Lab = Float[np.ndarray, "... n_pixels 3"]
"""L* in [0, 100], a*, b*."""
Means = Float[np.ndarray, "..."] | np.floating
"""Over the pixels of each picture."""

_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
# White is the display's own, so that equal R, G, B have a* = b* = 0.
_TO_RELATIVE_XYZ = _TO_XYZ / _TO_XYZ.sum(axis=1, keepdims=True)
_F_TO_LAB = np.array([[0.0, 500.0, 0.0], [116.0, -500.0, 200.0], [0.0, 0.0, -200.0]])


def shown(rgb: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """What a display shows of linear values, in [0, 1].

    Up to s = `SHOULDER` a value x is itself; above it becomes ``s + (1 - s) (1 - exp(-(x - s)/(1 - s)))``, which has the
    same slope at s, and tends to 1.
    """
    light = np.clip(rgb, 0, SHOULDER)
    # Few values are highlights: the exponential is taken of those alone.
    over = np.nonzero(rgb > SHOULDER)
    light[over] -= (1 - SHOULDER) * np.expm1((SHOULDER - rgb[over]) / (1 - SHOULDER))
    return light


def to_lab(rgb: Pictures) -> Lab:
    """CIELAB of linear sRGB values in [0, 1], in their dtype: (0, 0, 0) is black, (100, 0, 0) the display's white."""
    ratio = rgb @ _TO_RELATIVE_XYZ.T.astype(rgb.dtype)
    delta = 6 / 29
    f = np.where(ratio > delta**3, np.cbrt(ratio), ratio / (3 * delta**2) + 4 / 29)
    lab = f.astype(rgb.dtype) @ _F_TO_LAB.astype(rgb.dtype)
    lab[..., 0] -= 16
    return lab


def appearance(rgb: Pictures) -> Lab:
    """CIELAB of what a display shows of pictures: where their differences are taken."""
    return to_lab(shown(rgb))


def cielab_difference(a: Lab, b: Lab) -> Means:
    """Mean over pixels of the distance in CIELAB, Delta E*ab of 1976; 2.3 is just noticeable on patches."""
    return np.sqrt(np.square(a - b).sum(axis=-1)).mean(axis=-1)


def ciede2000_difference(a: Lab, b: Lab) -> Means:
    """Mean over pixels of CIEDE2000, with kL = kC = kH = 1."""
    return ciede2000(a, b).mean(axis=-1)


def ciede2000(a: Lab, b: Lab) -> Float[np.ndarray, "... n_pixels"]:
    """Delta E_00 of each pixel, with kL = kC = kH = 1; the formula is in `ciede2000_kernel`."""
    from .ciede2000_kernel import differences  # numba takes a second to load

    a, b = np.broadcast_arrays(a, b)
    out = np.empty(a.shape[:-1])
    first, second = (np.ascontiguousarray(x).reshape(-1, 3) for x in (a, b))
    differences(first, second, out.reshape(-1))
    return out


def flip(a: Float[np.ndarray, "height width 3"], b: Float[np.ndarray, "height width 3"]) -> float:
    """Mean FLIP of two pictures (Andersson et al. 2020), in [0, 1], as `shown` at 67 pixels per degree.

    Raises
    ------
    HalfwayError
        Where the package ``flip-evaluator`` is not installed.
    """
    try:
        evaluate = import_module("flip_evaluator").evaluate
    except ImportError:
        raise HalfwayError(
            "FLIP needs the package flip-evaluator, which is not installed: pip install flip-evaluator."
        ) from None
    pictures = (np.ascontiguousarray(_encoded(shown(x)), np.float32) for x in (a, b))
    return float(evaluate(*pictures, "LDR", applyMagma=False)[1])


def _encoded(rgb: np.ndarray) -> np.ndarray:
    """SRGB's transfer function, IEC 61966-2-1."""
    return np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)
