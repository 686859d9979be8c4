"""Terms that the analytic models share: distributions, shadowing, Fresnel.

    ggx     D = a^2 / (pi (sin^2 theta_h + a^2 cos^2 theta_h)^2)         Walter et al. 2007, equation 33
    gtr1    D = (a^2 - 1) / (pi ln(a^2) (sin^2 theta_h + a^2 cos^2 theta_h))      Burley 2012, equation 4
    smith   G1 = 2 cos / (cos + sqrt(a^2 + (1 - a^2) cos^2))             Walter et al. 2007, equation 34
    schlick F = F0 + (F90 - F0) (1 - cos theta_d)^5                      Schlick 1994

``a`` is the width of the distribution, the square of an artist's roughness. D is written with the sine, which keeps its
digits at the peak of a mirror-like lobe.

A lobe of width a_t along a direction t of the surface and a_b across it is one of these with a width that depends on the azimuth
phi against t:

    ggx     a_h^-2 = cos^2 phi / a_t^2 + sin^2 phi / a_b^2, and D times a_h^2 / (a_t a_b)     Heitz 2014, equation 85
    smith   a^2 = a_t^2 cos^2 phi + a_b^2 sin^2 phi                                           Heitz 2014, equation 80
"""

import math
from typing import NamedTuple

import numpy as np

from .._types import Angle, Directions
from ..halfdiff import to_half_diff


class Azimuths(NamedTuple):
    """Of the half vector and both directions, in radians from the tangent."""

    h: Angle
    i: Angle
    o: Angle

    @classmethod
    def of(cls, phi_h: Angle, wi: Directions, wo: Directions) -> "Azimuths":
        """Those of pairs of directions whose half vectors are at ``phi_h``."""
        return cls(phi_h, *(np.arctan2(w[..., 1], w[..., 0]) for w in (wi, wo)))


class Pair(NamedTuple):
    """What a lobe needs of a pair of directions; arrays that broadcast together."""

    theta_h: Angle
    cos_d: Angle
    cos_i: Angle
    cos_o: Angle
    azimuths: Azimuths | None = None
    """Only where something is anisotropic."""

    @classmethod
    def of(cls, wi: Directions, wo: Directions) -> "Pair":
        """That of directions above the surface, with its azimuths."""
        angles = to_half_diff(wi, wo)
        azimuths = Azimuths.of(angles.phi_h, wi, wo)
        return cls(angles.theta_h, np.cos(angles.theta_d), wi[..., 2], wo[..., 2], azimuths)

    @property
    def cos_between(self) -> Angle:
        """Of the angle from one direction to the other."""
        return 2 * self.cos_d**2 - 1


class Widths(NamedTuple):
    """Of a lobe, as they are seen from somewhere."""

    h: Angle | float
    i: Angle | float
    o: Angle | float
    density: Angle | float = 1.0
    """A factor of D."""
    mean: float = 0.0

    @classmethod
    def even(cls, a: float) -> "Widths":
        """Those of a lobe that is as wide along the surface as across."""
        return cls(a, a, a, mean=a)

    @classmethod
    def along(cls, a_t: float, a_b: float, direction: float, azimuths: Azimuths | None) -> "Widths":
        """Those of a lobe of width ``a_t`` along a direction, in radians from the tangent, and ``a_b`` across it.

        Without azimuths the two are equal.
        """
        if azimuths is None:
            return cls.even(a_t)
        cos2, *seen2 = (np.cos(phi - direction) ** 2 for phi in azimuths)
        h2 = 1 / (cos2 / a_t**2 + (1 - cos2) / a_b**2)
        i, o = (np.sqrt(a_t**2 * c2 + a_b**2 * (1 - c2)) for c2 in seen2)
        return cls(np.sqrt(h2), i, o, h2 / (a_t * a_b), math.sqrt(a_t * a_b))


def ggx(theta_h: Angle, a: Angle | float) -> Angle:
    """The density of normals of GGX, in 1/sr."""
    return a**2 / (np.pi * _spread(theta_h, a) ** 2)


def gtr1(theta_h: Angle, a: float) -> Angle:
    """The density of normals of GTR with exponent 1, of longer tails than GGX, in 1/sr."""
    return (a**2 - 1) / (np.pi * np.log(a**2) * _spread(theta_h, a))


def smith(cosine: Angle, a: Angle | float) -> Angle:
    """The share of the normals that is seen from a direction, under GGX."""
    return 2 * cosine / (cosine + np.sqrt(a**2 + (1 - a**2) * cosine**2))


def smith_correlated(cos_i: Angle, cos_o: Angle, a_i: Angle | float, a_o: Angle | float) -> Angle:
    """The share of the normals that is lit and seen, heights correlated: E. Heitz, JCGT 3(2), 2014, equation 99."""
    lit, seen = (np.sqrt(a**2 + (1 - a**2) * c**2) for a, c in ((a_i, cos_i), (a_o, cos_o)))
    return 2 * cos_i * cos_o / (lit * cos_o + seen * cos_i)


def schlick(cosine: Angle) -> Angle:
    """The share of the way from F0 to F90."""
    return (1 - cosine) ** 5


def f0_of_ior(ior: float) -> float:
    """The reflectance at normal incidence of a dielectric."""
    return ((ior - 1) / (ior + 1)) ** 2


def _spread(theta_h: Angle, a: Angle | float) -> Angle:
    return np.sin(theta_h) ** 2 + (a * np.cos(theta_h)) ** 2
