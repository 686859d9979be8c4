"""Terms that the analytic models share: distributions, shadowing, Fresnel.

    ggx     D = a^2 / (pi (sin^2 theta_h + a^2 cos^2 theta_h)^2)         Walter et al. 2007, equation 33
    gtr1    D = (a^2 - 1) / (pi ln(a^2) (sin^2 theta_h + a^2 cos^2 theta_h))      Burley 2012, equation 4
    smith   G1 = 2 cos / (cos + sqrt(a^2 + (1 - a^2) cos^2))             Walter et al. 2007, equation 34
    schlick F = F0 + (F90 - F0) (1 - cos theta_d)^5                      Schlick 1994

``a`` is the width of the distribution, the square of an artist's roughness. D is written with the sine, which keeps its
digits at the peak of a mirror-like lobe.
"""

import numpy as np

from .._types import Angle


def ggx(theta_h: Angle, a: float) -> Angle:
    """The density of normals of GGX, in 1/sr."""
    return a**2 / (np.pi * _spread(theta_h, a) ** 2)


def gtr1(theta_h: Angle, a: float) -> Angle:
    """The density of normals of GTR with exponent 1, of longer tails than GGX, in 1/sr."""
    return (a**2 - 1) / (np.pi * np.log(a**2) * _spread(theta_h, a))


def smith(cosine: Angle, a: float) -> Angle:
    """The share of the normals that is seen from a direction, under GGX."""
    return 2 * cosine / (cosine + np.sqrt(a**2 + (1 - a**2) * cosine**2))


def smith_correlated(cos_i: Angle, cos_o: Angle, a: float) -> Angle:
    """The share of the normals that is lit and seen, heights correlated: E. Heitz, JCGT 3(2), 2014, equation 99."""
    lit, seen = (np.sqrt(a**2 + (1 - a**2) * c**2) for c in (cos_i, cos_o))
    return 2 * cos_i * cos_o / (lit * cos_o + seen * cos_i)


def schlick(cosine: Angle) -> Angle:
    """The share of the way from F0 to F90."""
    return (1 - cosine) ** 5


def f0_of_ior(ior: float) -> float:
    """The reflectance at normal incidence of a dielectric."""
    return ((ior - 1) / (ior + 1)) ** 2


def _spread(theta_h: Angle, a: float) -> Angle:
    return np.sin(theta_h) ** 2 + (a * np.cos(theta_h)) ** 2
