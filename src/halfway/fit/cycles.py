"""Blender's Principled BSDF as Cycles renders it, with the distribution "GGX": metal, gloss over a diffuse body, coat.

    f = coat + (1 - w E_coat) [ m metal + (1 - m) (gloss + (1 - max_channel E_gloss) base_color/pi) ]

    coat, gloss, metal   F D(a) G / (4 cos_i cos_o),   a = roughness^2, G height-correlated
    F of coat and gloss  f0 + (1 - f0) s,   s = (F_ior - F_ior(0)) / (1 - F_ior(0)), f0 = specular_tint F_ior(0)
    F of the metal       S(base_color) bent to meet specular_tint at 82 degrees
    E                    f0 + (1 - f0) s, with s averaged over the facets that are seen from wo

``specular_tint`` stands for both lobes, as the node has it; the node's level stays at .5 and its coat's index at 1.5. A layer takes its
share of what ``wo`` sees: the model is not reciprocal. Cycles has E in tables; here it is a sum over facets.

Source: Blender 5.3, Cycles, ``closure_principled``, ``bsdf_microfacet``; F82: N. Hoffman, "Generalization of Adobe's Fresnel Model", 2023;
facets: E. Heitz, JCGT 7(4), 2018.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np

from .._types import Angle
from ..brdf import fresnel
from .microfacet import Pair, f0_of_ior, ggx, smith_correlated
from .model import AnalyticModel, Range, channels
from .openpbr import f82

COAT_IOR = 1.5
_COSINES = np.cos(np.radians(np.linspace(89.5, 0, 20)))
_N_RADII, _N_TURNS = 8, 12


@dataclass(frozen=True, eq=False)
class Cycles(AnalyticModel):
    """The inputs of the node that stand for an opaque isotropic table, under their names there."""

    base_color: Annotated[Any, Range(0, 1, 0.5)]
    metallic: Annotated[float, Range(0, 1, 0)] = 0.0
    roughness: Annotated[float, Range(0.02, 1, 0.5)] = 0.5
    ior: Annotated[float, Range(1, 3, 1.5)] = 1.5
    specular_tint: Annotated[Any, Range(0, 1, 1)] = 1.0
    coat_weight: Annotated[float, Range(0, 1, 0)] = 0.0
    coat_roughness: Annotated[float, Range(0.02, 1, 0.1)] = 0.03

    formula: ClassVar[str] = "Blender's Principled BSDF"
    colours: ClassVar[frozenset[str]] = frozenset({"base_color", "specular_tint"})
    main_lobe: ClassVar = "roughness", "metallic"
    opening: ClassVar = {"specular_tint": 0.95, "coat_weight": 0.1, "coat_roughness": 0.1}

    def of(self, pair: Pair) -> np.ndarray:
        lobe = _lobe(pair, self.roughness)
        colour, tint = channels(self.base_color, lobe), channels(self.specular_tint, lobe)
        f0 = tint * f0_of_ior(self.ior)
        gloss = f0 + (1 - f0) * _share(pair.cos_d, self.ior)
        seen = (f0 + (1 - f0) * _mean_share(pair.cos_o, self.roughness, self.ior)).max(axis=0)
        dielectric = gloss * lobe + (1 - seen) * colour / np.pi
        f = dielectric + self.metallic * (f82(colour, tint, pair.cos_d) * lobe - dielectric)
        if not self.coat_weight:
            return f
        f0 = f0_of_ior(COAT_IOR)
        coat = f0 + (1 - f0) * _share(pair.cos_d, COAT_IOR)
        seen = f0 + (1 - f0) * _mean_share(pair.cos_o, self.coat_roughness, COAT_IOR)
        coat = coat * _lobe(pair, self.coat_roughness)
        return self.coat_weight * coat + (1 - self.coat_weight * seen) * f


def _lobe(pair: Pair, roughness: float) -> Angle:
    a = roughness**2
    G = smith_correlated(pair.cos_i, pair.cos_o, a, a) / (4 * pair.cos_i * pair.cos_o)
    return ggx(pair.theta_h, a) * G


def _share(cos_d: Angle, ior: float) -> Angle:
    """How far F has come from its value at the normal to 1."""
    f0 = f0_of_ior(ior)
    return np.clip((fresnel(cos_d, ior) - f0) / (1 - f0), 0, 1)


def _mean_share(cos_o: Angle, roughness: float, ior: float) -> Angle:
    """`_share` over the facets of a lobe that are seen, by how much they reflect."""
    cos_d, weight = _facets(max(1, round(200 * roughness)))
    means = (_share(cos_d, ior) * weight).sum(axis=1) / weight.sum(axis=1)
    return np.interp(cos_o, _COSINES, means)


@lru_cache(256)
def _facets(roughness_200: int) -> tuple[np.ndarray, np.ndarray]:
    """Cosines to the facets seen from `_COSINES` and what each reflects, shape (n_cosines, n_facets): Heitz 2018, listing 1."""
    a = (roughness_200 / 200) ** 2
    u = (np.arange(_N_RADII) + 0.5) / _N_RADII
    phi = 2 * np.pi * (np.arange(_N_TURNS) + 0.5) / _N_TURNS
    radius, phi = (x.ravel() for x in np.meshgrid(np.sqrt(u), phi))
    cos_o = _COSINES[:, None]
    sin_o = np.sqrt(1 - cos_o**2)
    stretched = np.hypot(a * sin_o, cos_o)
    v_x, v_z = a * sin_o / stretched, cos_o / stretched
    t_1, t_2 = radius * np.cos(phi), radius * np.sin(phi)
    s = (1 + v_z) / 2
    t_2 = (1 - s) * np.sqrt(1 - t_1**2) + s * t_2
    t_3 = np.sqrt(np.maximum(0, 1 - t_1**2 - t_2**2))
    # In the plane of wo and across it; the first tangent is across.
    along, across, up = a * (t_3 * v_x - t_2 * v_z), a * t_1, t_3 * v_z + t_2 * v_x
    length = np.sqrt(along**2 + across**2 + up**2)
    cos_d = np.clip((along * sin_o + up * cos_o) / length, 0, 1)
    cos_i = np.maximum(2 * cos_d * up / length - cos_o, 0)
    root_i, root_o = (np.sqrt(a**2 + (1 - a**2) * c**2) for c in (cos_i, cos_o))
    weight = cos_i * (cos_o + root_o) / np.maximum(cos_o * root_i + cos_i * root_o, 1e-12)
    return cos_d, weight
