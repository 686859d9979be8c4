"""The Fresnel term of a smooth dielectric."""

import numpy as np

from .._types import Angle


def fresnel(cosine: Angle, ior: float) -> Angle:
    """Unpolarised reflectance in [0, 1] of a dielectric of index ``ior`` >= 1 met from air at this cosine."""
    g = np.sqrt(ior**2 - 1 + cosine**2)
    across = ((g - cosine) / (g + cosine)) ** 2
    return across / 2 * (1 + ((cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)) ** 2)
