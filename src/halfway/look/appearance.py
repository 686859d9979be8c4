"""How different two pictures look.

Pictures are linear sRGB (D65), shape (..., n_pixels, 3), where 1 is the white of the display. They pass to the eye in
three steps:

    shown       what a display shows of them: a shoulder from .75 upwards that reaches 1 only at infinity
    to_lab      CIELAB of that light, relative to the display's white (`halfway.colour`)
    difference  of two pictures in CIELAB, the mean over their pixels

The shoulder keeps a mirror-like peak, 40 times white and more, from ruling a mean, and still tells a strong peak from a
stronger one; a clip would not. Everything is continuous in the picture, so it can pace a route.

References: CIE 15 (the difference of 1976); P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
"""

from importlib import import_module

import numpy as np
from jaxtyping import Float

from ..colour import ciede2000, to_lab, to_srgb
from ..errors import HalfwayError

SHOULDER = 0.75
"""Linear value above which highlights are compressed."""

Pictures = Float[np.ndarray, "... n_pixels 3"]
Lab = Float[np.ndarray, "... n_pixels 3"]
"""L* in [0, 100], a*, b*."""
Means = Float[np.ndarray, "..."] | np.floating
"""Over the pixels of each picture."""


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


def appearance(rgb: Pictures) -> Lab:
    """CIELAB of what a display shows of pictures: where their differences are taken."""
    return to_lab(shown(rgb))


def cielab_difference(a: Lab, b: Lab) -> Means:
    """Mean over pixels of the distance in CIELAB, Delta E*ab of 1976; 2.3 is just noticeable on patches."""
    return np.sqrt(np.square(a - b).sum(axis=-1)).mean(axis=-1)


def ciede2000_difference(a: Lab, b: Lab) -> Means:
    """Mean over pixels of CIEDE2000, with kL = kC = kH = 1."""
    return ciede2000(a, b).mean(axis=-1)


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
    pictures = (np.ascontiguousarray(to_srgb(shown(x)), np.float32) for x in (a, b))
    return float(evaluate(*pictures, "LDR", applyMagma=False)[1])
