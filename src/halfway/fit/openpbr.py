"""OpenPBR, the parts of it that reflect from an opaque surface, as MaterialX evaluates it.

From the top: fuzz over coat over base; the base a mixture, by metalness m, of a metal and of a dielectric over diffuse.

    f = fuzz + (1 - w_f E_f) [coat + (1 - w_c E_c) darkening (m metal + (1 - m) (gloss + (1 - E_g) diffuse))]

A layer takes from what is below it its own albedo E seen from ``wo``. That is OpenPBR's albedo scaling: it keeps the
energy and not the reciprocity, by some percent where the two directions differ much.

    metal, gloss, coat   F D(a) G / (4 cos_i cos_o) (1 + F (1 - E(1))/E(1)), a = roughness^2, G height-correlated
                         metal and gloss anisotropic in D: a_t = a sqrt(2 / (1 + (1 - A)^2)), a_b = (1 - A) a_t, G and E at the
                         geometric mean of both
                         F: exact for a dielectric; for the metal S(base_color) bent to meet specular_color at 82 degrees
    diffuse              the energy-preserving Oren-Nayar model ("EON")
    fuzz                 a linearly transformed cosine
    E(F0)                a rational fit of the albedo of GGX under Schlick's F

A coat widens the lobe below it, lowers the contrast of the indices there, and darkens the base.

Sources: OpenPBR Surface 1.1, Academy Software Foundation; ``open_pbr_surface`` 1.1.1 of MaterialX 1.39 (its node graph, and the
closures of its standard library, whose fits of E and of the fuzz these are); F82: N. Hoffman, "Generalization of Adobe's
Fresnel Model", 2023; EON: J. Portsmouth, P. Kutz, S. Hill, JCGT 14(1), 2025; fuzz: T. Zeltner, B. Burley, M. J.-Y. Chiang,
"Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", SIGGRAPH talks 2022; the factor behind F:
E. Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from .._types import Angle
from ..brdf import fresnel
from .microfacet import Pair, Widths, f0_of_ior, ggx, schlick, smith_correlated
from .model import ANY_TURN, AnalyticModel, Range, channels

COAT_IOR = 1.6
LEAST_WIDTH = 1e-6
LEAST_FUZZ = 0.01
"""Least width of a lobe and least roughness of the fuzz, in MaterialX."""


@dataclass(frozen=True, eq=False)
class OpenPbr(AnalyticModel):
    """The parameters of OpenPBR that stand for an opaque table, under their names there; and where its tangent points."""

    base_color: Annotated[Any, Range(0, 1, 0.5)]
    base_diffuse_roughness: Annotated[float, Range(0, 1, 0)] = 0.0
    base_metalness: Annotated[float, Range(0, 1, 0)] = 0.0
    specular_color: Annotated[Any, Range(0, 1, 1)] = 1.0
    specular_roughness: Annotated[float, Range(0.02, 1, 0.3)] = 0.3
    specular_ior: Annotated[float, Range(1, 3, 1.5)] = 1.5
    coat_weight: Annotated[float, Range(0, 1, 0)] = 0.0
    coat_roughness: Annotated[float, Range(0.02, 1, 0.1)] = 0.0
    fuzz_weight: Annotated[float, Range(0, 1, 0)] = 0.0
    fuzz_color: Annotated[Any, Range(0, 1, 1)] = 1.0
    fuzz_roughness: Annotated[float, Range(0.1, 1, 0.5)] = 0.5
    specular_roughness_anisotropy: Annotated[float, Range(0, 0.95, 0)] = 0.0
    tangent_rotation: Annotated[float, ANY_TURN] = 0.0

    formula: ClassVar[str] = "OpenPBR 1.1"
    colours: ClassVar[frozenset[str]] = frozenset({"base_color", "specular_color", "fuzz_color"})
    main_lobe: ClassVar = "specular_roughness", "base_metalness"
    opening: ClassVar = {
        "base_diffuse_roughness": 0.05,
        "specular_color": 0.95,
        "coat_weight": 0.1,
        "coat_roughness": 0.1,
        "fuzz_weight": 0.1,
        "fuzz_color": 0.95,
    }
    grain: ClassVar = "specular_roughness_anisotropy", "tangent_rotation"

    def of(self, pair: Pair) -> np.ndarray:
        f = self._base(pair)
        if self.coat_weight:
            f = self._coated(f, pair)
        return self._fuzzed(f, pair) if self.fuzz_weight else f

    def _base(self, pair: Pair) -> np.ndarray:
        width, ior = self._under_the_coat()
        across = 1 - self.specular_roughness_anisotropy
        a_t = width * math.sqrt(2 / (1 + across**2))
        a_t, a_b = (min(max(LEAST_WIDTH, a), 1.0) for a in (a_t, across * a_t))
        a = Widths.along(a_t, a_b, self.tangent_rotation, pair.azimuths)
        like = pair.cos_i * pair.cos_o
        colour, tint = channels(self.base_color, like), channels(self.specular_color, like)
        gloss, kept = _gloss(pair, a, ior)
        diffuse = eon(colour, self.base_diffuse_roughness, pair.cos_i, pair.cos_o, pair.cos_between)
        metal = _lobe(pair, a, f82(colour, tint, pair.cos_d))
        m = self.base_metalness
        return m * metal + (1 - m) * (tint * gloss + kept * diffuse)

    def _under_the_coat(self) -> tuple[float, float]:
        """Width and index of the base's lobes, as the coat changes them."""
        w, r = self.coat_weight, self.specular_roughness
        wider = min(1.0, 2 * self.coat_roughness**4 + r**4) ** 0.25
        ratio = self.specular_ior / COAT_IOR
        ior = self.specular_ior + w * (max(ratio, 1 / ratio) - self.specular_ior)
        return (r + w * (wider - r)) ** 2, ior

    def _coated(self, f: np.ndarray, pair: Pair) -> np.ndarray:
        k = 1 - (1 - f0_of_ior(COAT_IOR)) / COAT_IOR**2
        darker = (1 - k) / (1 - k * channels(self.base_color, pair.cos_i * pair.cos_o))
        width = Widths.even(max(LEAST_WIDTH, self.coat_roughness**2))
        gloss, kept = _gloss(pair, width, COAT_IOR)
        w = self.coat_weight
        return w * gloss + (1 - w * (1 - kept)) * (1 + w * (darker - 1)) * f

    def _fuzzed(self, f: np.ndarray, pair: Pair) -> np.ndarray:
        r = max(LEAST_FUZZ, self.fuzz_roughness)
        albedo = fuzz_albedo(pair.cos_o, r)
        lobe = albedo * fuzz(r, pair.cos_i, pair.cos_o, pair.cos_between)
        w = self.fuzz_weight
        return w * channels(self.fuzz_color, lobe) * lobe + (1 - w * albedo) * f


def _gloss(pair: Pair, a: Widths, ior: float) -> tuple[Angle, Angle]:
    """The lobe of a dielectric, and what it leaves of the light for what is below it."""
    F = fresnel(pair.cos_d, ior)
    albedo = ggx_albedo(pair.cos_o, a.mean, f0_of_ior(ior)) * _multiple(pair, a.mean, F)
    return _lobe(pair, a, F), 1 - albedo


def _lobe(pair: Pair, a: Widths, F: Angle) -> Angle:
    G = smith_correlated(pair.cos_i, pair.cos_o, a.mean, a.mean) / (4 * pair.cos_i * pair.cos_o)
    return F * (a.density * ggx(pair.theta_h, a.h) * G) * _multiple(pair, a.mean, F)


def _multiple(pair: Pair, a: float, F: Angle) -> Angle:
    """What light that meets several facets adds: a factor."""
    once = ggx_albedo(pair.cos_o, a, 1.0)
    return 1 + F * ((1 - once) / once)


def f82(f0: np.ndarray, tint: np.ndarray, cos_d: Angle) -> np.ndarray:
    """Schlick's curve from ``f0`` to white, times ``tint`` at some 82 degrees, where the cosine is 1/7."""
    at_82 = 1 / 7
    curve = f0 + (1 - f0) * (1 - at_82) ** 5
    dip = curve * (1 - tint) / (at_82 * (1 - at_82) ** 6)
    return f0 + (1 - f0) * schlick(cos_d) - dip * (cos_d * (1 - cos_d) ** 6)


def ggx_albedo(cosine: Angle, a: float, f0: float) -> Angle:
    """The albedo of a GGX lobe under Schlick's F: MaterialX's rational fit."""
    x, y = cosine, a
    terms = np.stack(np.broadcast_arrays(1.0, x, y, x * y, x**2, y**2, x**2 * y, x * y**2, (x * y) ** 2))  # fmt: skip
    low, high, below_low, below_high = np.tensordot(_ALBEDO_FIT, terms, 1)
    return f0 * np.clip(low / below_low, 0, 1) + np.clip(high / below_high, 0, 1)


_ALBEDO_FIT = np.array(
    [
        [0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448],
        [0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286],
        [1.0, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37],
        [1.0, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1],
    ]
)


def eon(
    colour: np.ndarray, roughness: float, cos_i: Angle, cos_o: Angle, cos_between: Angle
) -> np.ndarray:
    """Diffuse reflection of a rough surface of this albedo, in 1/sr."""
    A = 1 / (1 + _EON_1 * roughness)
    s = np.maximum(cos_between, LEAST_WIDTH) - cos_i * cos_o
    s = np.where(s > 0, s / np.maximum(cos_i, cos_o), s)
    once = colour * A * (1 + roughness * s)
    mean = A * (1 + _EON_2 * roughness)
    lost_i, lost_o = (_left(_eon_albedo(c, roughness, A)) for c in (cos_i, cos_o))
    again = colour**2 * mean / (1 - colour * (1 - mean)) / _left(mean)
    return (once + again * (lost_i * lost_o)) / np.pi


def _left(albedo: Angle | float) -> Angle:
    return np.maximum(LEAST_WIDTH, 1 - albedo)


_EON_1 = 0.5 - 2 / (3 * np.pi)
_EON_2 = 2 / 3 - 28 / (15 * np.pi)


def _eon_albedo(cosine: Angle, roughness: float, A: float) -> Angle:
    """Of light reflected once, under white."""
    sin = np.sqrt(1 - cosine**2)
    G = sin * (np.arccos(cosine) - sin * cosine) + 2 / 3 * (sin / cosine * (1 - sin**3) - sin)
    return A * (1 + roughness * G / np.pi)


def fuzz_albedo(cosine: Angle, r: float) -> Angle:
    """The albedo of white fuzz of roughness ``r``: a Gaussian fit."""
    s = r * (0.0206607 + 1.58491 * r) / (0.0379424 + r * (1.32227 + r))
    m = r * (-0.193854 + r * (-1.14885 + r * (1.7932 - 0.95943 * r**2))) / (0.046391 + r)
    o = r * (0.000654023 + r * (-0.0207818 + 0.119681 * r)) / (1.26264 + r * (-1.92021 + r))
    return np.exp(-0.5 * ((cosine - m) / s) ** 2) / (s * np.sqrt(2 * np.pi)) + o


def fuzz(r: float, cos_i: Angle, cos_o: Angle, cos_between: Angle) -> Angle:
    """The lobe of the fuzz over its albedo, in 1/sr: a cosine, stretched and sheared in the plane of ``wo``."""
    stretch = (2.58126 * cos_o + 0.813703 * r) * r / (1 + 0.310327 * cos_o**2 + 2.60994 * cos_o * r)
    shear = np.sqrt(1 - cos_o) * (r - 1) * r**3
    shear = shear / (2.54053e-5 + 1.71228 * cos_o - 1.71506 * cos_o * r + 1.34174 * r**2)
    sin_o = np.sqrt(1 - cos_o**2)
    along = np.divide(cos_between - cos_i * cos_o, np.maximum(sin_o, 1e-12))
    across2 = np.maximum(1 - along**2 - cos_i**2, 0)
    length2 = (stretch * along + shear * cos_i) ** 2 + stretch**2 * across2 + cos_i**2
    # The cosine of the light is in the lobe and not in f.
    return (stretch / length2) ** 2 / np.pi
