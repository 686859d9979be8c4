"""Mitsuba 3's ``principled``: the Disney model of 2012 and 2015, without its transmission.

    f = specular + clearcoat + diffuse + sheen

    specular   F D(r^2) G1(cos_i) G1(cos_o) / (4 cos_i cos_o)
               F = (1 - m) ((1 - t) F_eta + t S(tint F0)) + m S(base_color)
    clearcoat  c/4 S(.04) GTR1(.1 - .099 gloss) G1(cos_i) G1(cos_o)            shadowing of width 1/4
    diffuse    (1 - m) base_color/pi [(1 - S_i/2)(1 - S_o/2) + R (S_i + S_o + S_i S_o (R - 1))],  R = 2 r cos^2 theta_d
    sheen      (1 - m) s (1 - st + st tint) (1 - cos theta_d)^5

with r roughness, m metallic, t spec_tint, S Schlick's mixture with white, F_eta the exact Fresnel term of the index that
``specular`` stands for, D and G1 of the specular lobe anisotropic, r^2/q along the tangent and r^2 q across it, q^2 = 1 - .9 anisotropic, and tint = base_color over its luminance. ``flatness`` leads the diffuse term over to
1.25 (L_i L_o (1/(cos_i + cos_o) - 1/2) + 1/2),  L = 1 + (R/2 - 1) S_i, the same for o.

Source: B. Burley, "Physically-Based Shading at Disney", SIGGRAPH course 2012, and "Extending the Disney BRDF to a BSDF
with Integrated Subsurface Scattering", 2015; what Mitsuba makes of them: the page of its plugin ``principled``.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from .._types import Angle
from ..brdf import fresnel
from .microfacet import Pair, Widths, ggx, gtr1, schlick, smith
from .model import ANY_TURN, AnalyticModel, Range, channels

_LUMINANCE = np.array([0.212671, 0.715160, 0.072169])
"""Mitsuba's, which differs from sRGB's in the fourth digit."""
LEAST_WIDTH = 0.001
"""Of the specular lobe, in Mitsuba."""


@dataclass(frozen=True, eq=False)
class Principled(AnalyticModel):
    """The parameters of Mitsuba's ``principled``, under their names there; and where its tangent points."""

    base_color: Annotated[Any, Range(0, 1, 0.5)]
    roughness: Annotated[float, Range(0.02, 1, 0.5)] = 0.5
    metallic: Annotated[float, Range(0, 1, 0)] = 0.0
    specular: Annotated[float, Range(0.01, 1, 0.5)] = 0.5
    spec_tint: Annotated[float, Range(0, 1, 0)] = 0.0
    clearcoat: Annotated[float, Range(0, 1, 0)] = 0.0
    clearcoat_gloss: Annotated[float, Range(0, 1, 0)] = 0.0
    sheen: Annotated[float, Range(0, 1, 0)] = 0.0
    sheen_tint: Annotated[float, Range(0, 1, 0)] = 0.0
    flatness: Annotated[float, Range(0, 1, 0)] = 0.0
    anisotropic: Annotated[float, Range(0, 1, 0)] = 0.0
    tangent_rotation: Annotated[float, ANY_TURN] = 0.0

    formula: ClassVar[str] = "Mitsuba principled"
    colours: ClassVar[frozenset[str]] = frozenset({"base_color"})
    main_lobe: ClassVar = "roughness", "metallic"
    opening: ClassVar = {
        "spec_tint": 0.1,
        "clearcoat": 0.1,
        "clearcoat_gloss": 0.5,
        "sheen": 0.05,
        "sheen_tint": 0.1,
        "flatness": 0.2,
    }
    grain: ClassVar = "anisotropic", "tangent_rotation"

    def of(self, pair: Pair) -> np.ndarray:
        cos_d, cos_i, cos_o = pair.cos_d, pair.cos_i, pair.cos_o
        white = schlick(cos_d)
        body = self._diffuse(cos_d, cos_i, cos_o) / np.pi
        colour = channels(self.base_color, body)
        tint = channels(self._tint(), body)
        aspect = math.sqrt(1 - 0.9 * self.anisotropic)
        a_t, a_b = (max(LEAST_WIDTH, self.roughness**2 * q) for q in (1 / aspect, aspect))
        a = Widths.along(a_t, a_b, self.tangent_rotation, pair.azimuths)
        lobe = ggx(pair.theta_h, a.h) * smith(cos_i, a.i) * smith(cos_o, a.o) / (4 * cos_i * cos_o)
        lobe = a.density * lobe
        coat = gtr1(pair.theta_h, 0.1 - 0.099 * self.clearcoat_gloss) * smith(cos_i, 0.25)
        coat = self.clearcoat / 4 * (0.04 + 0.96 * white) * coat * smith(cos_o, 0.25)
        sheen = self.sheen * (1 + self.sheen_tint * (tint - 1)) * white
        # Without an index Mitsuba leaves the whole lobe out, the metal's too; fits stay clear of that.
        lobe = lobe * (self.specular > 0)
        f = self._fresnel(cos_d, white, colour, tint)
        return f * lobe + coat + (1 - self.metallic) * (colour * body + sheen)

    def _diffuse(self, cos_d: Angle, cos_i: Angle, cos_o: Angle) -> Angle:
        s_i, s_o = schlick(cos_i), schlick(cos_o)
        retro = 2 * self.roughness * cos_d**2
        f = (1 - s_i / 2) * (1 - s_o / 2) + retro * (s_i + s_o + s_i * s_o * (retro - 1))
        if not self.flatness:
            return f
        flat = (1 + (retro / 2 - 1) * s_i) * (1 + (retro / 2 - 1) * s_o)
        flat = 1.25 * (flat * (1 / (cos_i + cos_o) - 0.5) + 0.5)
        return f + self.flatness * (flat - f)

    def _fresnel(
        self, cos_d: Angle, white: Angle, colour: np.ndarray, tint: np.ndarray
    ) -> np.ndarray:
        m, t = self.metallic, self.spec_tint
        root = np.sqrt(0.08 * self.specular)
        exact = fresnel(cos_d, (1 + root) / (1 - root))
        f0 = tint * 0.08 * self.specular
        tinted = f0 + (1 - f0) * white
        metal = colour + (1 - colour) * white
        return (1 - m) * ((1 - t) * exact + t * tinted) + m * metal

    def _tint(self) -> np.ndarray:
        luminance = float(self.base_color @ _LUMINANCE)
        return self.base_color / luminance if luminance > 0 else np.ones(3)
