"""Materials as a USD layer, each as MaterialX's OpenPBR with a ``UsdPreviewSurface`` for programs that do not know that.

    materials.usda    /Materials/gold_paint                 one `Material` each, with the name and what the fits are worth in words
                          outputs:mtlx:surface              open_pbr_surface
                          outputs:surface                   UsdPreviewSurface
    scene.usda        /Scene                                spheres that wear them, lights, a camera

Names are USD identifiers: `identifiers`. Colours are linear with the primaries of sRGB, USD's default.

Sources: OpenUSD, "UsdShade" and the MaterialX page of its documentation; UsdPreviewSurface Specification 2.6.
"""

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import OutputError
from ..files import write_text
from ..fit import Fit
from .materialx import NODES, identifier, printable

MATERIALS, SCENE = "materials.usda", "scene.usda"
MATERIALX_VERSION = "1.39"
_LIGHTS = (((-35.0, -40.0, 0.0), 2.4), ((-20.0, 55.0, 0.0), 0.8), ((-35.0, 125.0, 0.0), 1.4))
"""Rotations about x, y and z in degrees of distant lights along -z, and how bright they are."""
_ENVIRONMENT = 0.3
_APART, _FIELD_OF_VIEW = 2.5, 20.0
_PREVIEW = {
    "base_color": "diffuseColor",
    "metallic": "metallic",
    "roughness": "roughness",
    "ior": "ior",
    "clearcoat": "clearcoat",
    "clearcoat_roughness": "clearcoatRoughness",
}
"""Parameters of the model ``preview`` under USD's names."""


class Fits(NamedTuple):
    """A material as OpenPBR and as UsdPreviewSurface."""

    openpbr: Fit
    preview: Fit


def write_usd(folder: Path, fits: Sequence[Fits]) -> tuple[str, str]:
    """Write the two layers into ``folder``; the names of their files."""
    for name, text in ((MATERIALS, to_usda(fits)), (SCENE, _scene(fits))):
        write_text(folder / name, text)
    return MATERIALS, SCENE


def to_usda(fits: Sequence[Fits]) -> str:
    """The layer of the materials, as text."""
    for pair in fits:
        if (pair.openpbr.model_name, pair.preview.model_name) != ("openpbr", "preview"):
            raise OutputError(
                f"USD has no material for the models {pair.openpbr.model_name} and {pair.preview.model_name}: "
                "expected openpbr and preview."
            )
    names = identifiers([pair.openpbr.name for pair in fits])
    body = "\n".join(_material(name, pair) for name, pair in zip(names, fits, strict=True))
    return f'{_header("Materials")}\ndef Scope "Materials"\n{{\n{body}}}\n'


def identifiers(names: Sequence[str]) -> list[str]:
    """A USD identifier for each name, no two alike; those that would be are counted.

    >>> identifiers(["gold-paint", "gold_paint"])
    ['gold_paint', 'gold_paint_2']
    """
    seen = Counter[str]()
    taken = {identifier(name or "material") for name in names}
    unique: list[str] = []
    for name in names:
        own = identifier(name or "material")
        seen[own] += 1
        while seen[own] > 1 and f"{own}_{seen[own]}" in taken:
            seen[own] += 1
        unique.append(f"{own}_{seen[own]}" if seen[own] > 1 else own)
    return unique


def _header(prim: str, more: str = "") -> str:
    return f"""#usda 1.0
(
    defaultPrim = "{prim}"
    metersPerUnit = 1
    upAxis = "Y"
{more})
"""


def _material(name: str, fits: Fits) -> str:
    true_name = printable(fits.openpbr.name) or name
    about = f"{true_name}, {fits.openpbr.summary}; {fits.preview.summary}"
    at = f"/Materials/{name}"
    openpbr = fits.openpbr.model.parameters()
    openpbr.pop("tangent_rotation")  # the node has none, and the materials are isotropic
    preview = {_PREVIEW[ours]: value for ours, value in fits.preview.model.parameters().items()}
    return f"""    def Material "{name}" (
        displayName = {_quoted(true_name)}
        doc = {_quoted(about)}
        prepend apiSchemas = ["MaterialXConfigAPI"]
    )
    {{
        uniform string config:mtlx:version = "{MATERIALX_VERSION}"
        token outputs:mtlx:surface.connect = <{at}/openpbr.outputs:out>
        token outputs:surface.connect = <{at}/preview.outputs:surface>

        def Shader "openpbr"
        {{
            uniform token info:id = "ND_{NODES["openpbr"]}_surfaceshader"
{_inputs(openpbr)}
            token outputs:out
        }}

        def Shader "preview"
        {{
            uniform token info:id = "UsdPreviewSurface"
{_inputs(preview)}
            token outputs:surface
        }}
    }}
"""


def _inputs(parameters: Mapping[str, Any]) -> str:
    return "\n".join(
        f"            color3f inputs:{name} = ({', '.join(f'{x:.7g}' for x in value)})"
        if isinstance(value, list)
        else f"            float inputs:{name} = {value:.7g}"
        for name, value in parameters.items()
    )


def _quoted(text: str) -> str:
    """A string of USD's text format, whose escapes of printable text are JSON's."""
    return json.dumps(text, ensure_ascii=False)


def _scene(fits: Sequence[Fits]) -> str:
    names = identifiers([pair.openpbr.name for pair in fits])
    n_columns = math.ceil(math.sqrt(len(names)))
    n_rows = math.ceil(len(names) / n_columns)
    middle = _APART * (n_columns - 1) / 2, _APART * (n_rows - 1) / 2
    spheres = "\n".join(
        _sphere(name, (_APART * (i % n_columns) - middle[0], middle[1] - _APART * (i // n_columns)))
        for i, name in enumerate(names)
    )
    half = _APART * max(n_columns, n_rows) / 2
    away = half / math.tan(math.radians(_FIELD_OF_VIEW / 2)) + 1
    lights = "\n".join(_light(i, *light) for i, light in enumerate(_LIGHTS))
    return f"""{_header("Scene", f"    subLayers = [@./{MATERIALS}@]{chr(10)}")}
def Xform "Scene"
{{
    def Camera "camera"
    {{
        float2 clippingRange = (0.1, {2 * away:.6g})
        float focalLength = 50
        float horizontalAperture = {100 * math.tan(math.radians(_FIELD_OF_VIEW / 2)):.6g}
        float verticalAperture = {100 * math.tan(math.radians(_FIELD_OF_VIEW / 2)):.6g}
        double3 xformOp:translate = (0, 0, {away:.6g})
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }}

    def DomeLight "environment"
    {{
        float inputs:intensity = {_ENVIRONMENT}
    }}

{lights}
    def Xform "spheres"
    {{
{spheres}    }}
}}
"""


def _light(i: int, rotation: tuple[float, float, float], intensity: float) -> str:
    # A distant light of angle 0 is normalised to its irradiance.
    return f"""    def DistantLight "light_{i}"
    {{
        float inputs:angle = 0
        float inputs:intensity = {intensity}
        bool inputs:normalize = 1
        float3 xformOp:rotateXYZ = {rotation}
        uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
    }}
"""


def _sphere(name: str, at: tuple[float, float]) -> str:
    return f"""        def Sphere "{name}" (
            prepend apiSchemas = ["MaterialBindingAPI"]
        )
        {{
            float3[] extent = [(-1, -1, -1), (1, 1, 1)]
            rel material:binding = </Materials/{name}>
            double radius = 1
            double3 xformOp:translate = ({at[0]:.6g}, {at[1]:.6g}, 0)
            uniform token[] xformOpOrder = ["xformOp:translate"]
        }}
"""
