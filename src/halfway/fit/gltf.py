"""The material of glTF 2.0: metallic-roughness, with index, specular, clearcoat and anisotropy.

    base        mix(dielectric, metal; metallic)
    dielectric  (1 - w max_channel F) base_color/pi + w F V D,      F = f0 + (1 - f0) S, f0 = min(1, specular_color f0(ior))
    metal       (base_color + (1 - base_color) S) V D
    coated      mix(base, V D of the coat; clearcoat (.04 + .96 (1 - cos_o)^5))

    V D = D(a) G1(cos_i) G1(cos_o) / (4 cos_i cos_o),   a = roughness^2,    S = (1 - cos theta_d)^5,    w = specular

An anisotropic base is wider along the tangent, a_t = a + (1 - a) strength^2; its G is height-correlated, as that extension has it.

Programs do not agree on it. Many leave the extensions out, and Blender lets ``specular`` scale f0 and not the whole of F. A fit keeps an eye
on what these make of the material: `Gltf.readings`.

The base is reciprocal. The coat takes its share of what ``wo`` sees, as the extension says; that is not.

Source: Khronos Group, glTF 2.0 specification, appendix B; KHR_materials_ior, KHR_materials_specular,
KHR_materials_clearcoat, KHR_materials_anisotropy, the sections "Implementation".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from .._types import Angle
from .microfacet import Pair, Widths, f0_of_ior, ggx, schlick, smith, smith_correlated
from .model import ANY_TURN, AnalyticModel, Range, channels

LEAST_WIDTH = 1e-6
COAT_F0 = 0.04


@dataclass(frozen=True, eq=False)
class Gltf(AnalyticModel):
    """The parameters of a glTF material, in the order of its extensions."""

    base_color: Annotated[Any, Range(0, 1, 0.5)]
    metallic: Annotated[float, Range(0, 1, 0)] = 0.0
    roughness: Annotated[float, Range(0.02, 1, 0.5)] = 1.0
    ior: Annotated[float, Range(1, 3, 1.5)] = 1.5
    specular: Annotated[float, Range(0, 1, 1)] = 1.0
    specular_color: Annotated[Any, Range(0, 1, 1)] = 1.0
    clearcoat: Annotated[float, Range(0, 1, 0)] = 0.0
    clearcoat_roughness: Annotated[float, Range(0.02, 1, 0.1)] = 0.0
    anisotropy_strength: Annotated[float, Range(0, 1, 0)] = 0.0
    anisotropy_rotation: Annotated[float, ANY_TURN] = 0.0

    formula: ClassVar[str] = "glTF 2.0 metallic-roughness"
    colours: ClassVar[frozenset[str]] = frozenset({"base_color", "specular_color"})
    main_lobe: ClassVar = "roughness", "metallic"
    opening: ClassVar = {
        "specular": 0.95,
        "specular_color": 0.95,
        "clearcoat": 0.1,
        "clearcoat_roughness": 0.1,
    }
    grain: ClassVar = "anisotropy_strength", "anisotropy_rotation"

    n_searches: ClassVar[int] = 4
    simpler: ClassVar = (
        {"metallic": 1.0, "ior": 1.5, "specular": 1.0, "specular_color": 1.0},
        {"specular": 1.0},
    )

    @property
    def readings(self) -> Mapping[str, AnalyticModel]:
        return {
            "without extensions": Gltf(self.base_color, self.metallic, self.roughness),
            "in Blender": _InBlender.from_vector(self.to_vector()),
        }

    def of(self, pair: Pair) -> np.ndarray:
        white = schlick(pair.cos_d)
        lobe = self._base(pair)
        colour = channels(self.base_color, lobe)
        f0 = np.minimum(1, channels(self.specular_color, lobe) * f0_of_ior(self.ior))
        F = self._fresnel(f0, white)
        dielectric = (1 - F.max(axis=0)) * colour / np.pi + F * lobe
        metal = (colour + (1 - colour) * white) * lobe
        f = dielectric + self.metallic * (metal - dielectric)
        if not self.clearcoat:
            return f
        coat = _lobe(pair, self.clearcoat_roughness)
        share = self.clearcoat * (COAT_F0 + (1 - COAT_F0) * schlick(pair.cos_o))
        return f + share * (coat - f)

    def _base(self, pair: Pair) -> Angle:
        if pair.azimuths is None:
            return _lobe(pair, self.roughness)
        a_b = max(LEAST_WIDTH, self.roughness**2)
        a_t = a_b + (1 - a_b) * self.anisotropy_strength**2
        a = Widths.along(a_t, a_b, self.anisotropy_rotation, pair.azimuths)
        G = smith_correlated(pair.cos_i, pair.cos_o, a.i, a.o) / (4 * pair.cos_i * pair.cos_o)
        return a.density * ggx(pair.theta_h, a.h) * G

    def _fresnel(self, f0: np.ndarray, white: Angle) -> np.ndarray:
        return self.specular * (f0 + (1 - f0) * white)


class _InBlender(Gltf):
    """The dielectric as Blender's Principled BSDF has it, whose edge is white."""

    def _fresnel(self, f0: np.ndarray, white: Angle) -> np.ndarray:
        return self.specular * f0 + (1 - self.specular * f0) * white


class _Part(Gltf):
    """Fewer parameters, which no program reads in another way."""

    simpler: ClassVar = ()

    @property
    def readings(self) -> Mapping[str, AnalyticModel]:
        return {}


class GltfCore(_Part):
    """The part without extensions, which all programs read alike."""

    formula = "glTF 2.0 without extensions"
    ranges: ClassVar = {name: Gltf.ranges[name] for name in ("base_color", "metallic", "roughness")}
    grain: ClassVar = ()


class GltfBlender(_Part):
    """The part that Blender reads as the specification has it: its edge is white, and so is glTF's where ``specular`` is 1."""

    formula = "glTF 2.0 as Blender reads it"
    ranges: ClassVar = {name: r for name, r in Gltf.ranges.items() if name != "specular"}


class PreviewSurface(_Part):
    """``UsdPreviewSurface`` in its metallic workflow: glTF's model with an index and a clearcoat, without tints of the gloss, and isotropic.

    Source: Pixar, UsdPreviewSurface Specification 2.6.
    """

    formula = "UsdPreviewSurface"
    ranges: ClassVar = {
        name: r
        for name, r in Gltf.ranges.items()
        if not name.startswith(("specular", "anisotropy"))
    }
    grain: ClassVar = ()


def _lobe(pair: Pair, roughness: float) -> Angle:
    a = max(LEAST_WIDTH, roughness**2)
    shadowed = smith(pair.cos_i, a) * smith(pair.cos_o, a) / (4 * pair.cos_i * pair.cos_o)
    return ggx(pair.theta_h, a) * shadowed
