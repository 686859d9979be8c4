"""Where published fits stop being fits.

The analytic fits of the MERL materials were made on directions below about 80 degrees from the normal. Beyond, the factor
``1 / (cos_i cos_o)`` of a microfacet model is an extrapolation that grows without bound, reflects more light than
arrives, and rules the PCA of a library of them. So our models hold every factor of ``cos_i`` and ``cos_o`` constant past
80 degrees: in place of a cosine they take ``max(cosine, cos 80)``. Factors of theta_h and theta_d stay as published.
Both directions are treated alike, so reciprocity stands.
"""

import math

import numpy as np

from .._types import Angle

GRAZING_DEGREES = 80.0
"""The angle from the normal past which the models are held constant."""
COS_GRAZING = math.cos(math.radians(GRAZING_DEGREES))


def held(cosine: Angle) -> Angle:
    """The cosine, never below that of the grazing angle."""
    return np.maximum(cosine, COS_GRAZING)
