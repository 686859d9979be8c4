"""How different two pictures look.

Pictures are linear sRGB (D65), shape (..., n_pixels, 3), where 1 is the white of the display. They pass to the eye in
three steps:

    shown       what a display shows of them: a shoulder from .75 upwards that reaches 1 only at infinity
    to_lab      CIELAB of that light, relative to the display's white (`halfway.colour`)
    difference  of two pictures in CIELAB, the mean over their pixels

The shoulder keeps a mirror-like peak, 40 times white and more, from ruling a mean, and still tells a strong peak from a
stronger one; a clip would not. Everything is continuous in the picture, so it can pace a route.

Reference: CIE 15 (the difference of 1976).
"""

import numpy as np
from jaxtyping import Float

from ..colour import ciede2000, to_lab

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
