"""The ABC model in its microfacet form.

    f_r = kD/pi + A D(theta_h) F(theta_d) G / (pi cos_i cos_o)

    D = 1 / (1 + B (1 - cos theta_h))^C
    F = reflectance of a dielectric of refractive index ior, unpolarised, at theta_d
    G = min(1, 2 cos theta_h cos_i / cos theta_d, 2 cos theta_h cos_o / cos theta_d)

Source: J. Löw, J. Kronander, A. Ynnerman, J. Unger, "BRDF Models for Accurate and Efficient Rendering of Glossy
Surfaces", ACM Transactions on Graphics 31(1), 2012, section 4 (the ABC distribution in a Cook-Torrance model).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .._types import Angle
from ..brdf import IsotropicModel, fresnel
from .grazing import GRAZING_DEGREES, held


@dataclass(frozen=True, eq=False)
class AbcModel(IsotropicModel):
    """A diffuse part and a glossy microfacet part that share one shape over the channels.

    Held constant past 80 degrees: the cosines ``cos_i`` and ``cos_o``, in G and in the denominator, are never taken
    below cos(80 degrees), because the published fits say nothing beyond (see `halfway.models.grazing`).

    Parameters
    ----------
    kD, A : float64 arrays, shape (3,)
        Diffuse albedo, and strength of the glossy part (it absorbs the normalisation of D); linear RGB.
    B, C : float
        Width (larger is narrower) and fall-off of the distribution.
    ior : float
        Refractive index, at least 1.
    """

    kD: np.ndarray
    A: np.ndarray
    B: float
    C: float
    ior: float

    formula: ClassVar[str] = f"ABC microfacet, held past {GRAZING_DEGREES:g} degrees"

    def __post_init__(self) -> None:
        for name in ("kD", "A"):
            value = np.array(getattr(self, name), np.float64).reshape(3)
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        del phi_d  # it acts through the two cosines
        cos_d = np.cos(theta_d)
        # 1 - cos(x) = 2 sin^2(x/2) keeps its digits at the peak, where B (up to 8e6) would magnify their loss.
        D = (1 + 2 * self.B * np.sin(theta_h / 2) ** 2) ** -self.C
        F = fresnel(cos_d, self.ior)
        cos_i, cos_o = held(cos_i), held(cos_o)
        G = np.minimum(1, 2 * np.cos(theta_h) / cos_d * np.minimum(cos_i, cos_o))
        glossy = D * F / np.pi * (G / (cos_i * cos_o))
        diffuse = (self.kD / np.pi).reshape(3, *[1] * glossy.ndim)
        return np.multiply.outer(self.A, glossy) + diffuse
