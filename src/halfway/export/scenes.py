"""A folder that a renderer runs as it is: a material, a scene that shows it on a sphere, and a page that says how.

The scene is the same everywhere: a sphere of radius 1 at the origin, z up, a camera at (0, -7, 2), an even dim
environment and three point lights; direct light.

    mitsuba   scene.xml with the stock `measured` plugin and material.bsdf; scene-exact.xml with `halfway_table` and
              material.binary, the table itself
    pbrt-v2   scene.pbrt with `measured` and material.binary. pbrt-v2 takes the value of the cell, without interpolation,
              and samples the cosine only: mirror-like materials take many samples
    pbrt-v4   scene.pbrt with `measured` and material.bsdf, spectral

Syntax: the file format pages of Mitsuba 3, pbrt-v2 and pbrt-v4.
"""

from dataclasses import dataclass
from pathlib import Path

from ..brdf import TabularBrdf
from ..errors import OutputError
from ..files import replacing
from ..formats import write_merl, write_rgl

RENDERERS = ("mitsuba", "pbrt-v2", "pbrt-v4")

_ENVIRONMENT = 0.3
_LIGHTS = (((-4.0, -5.0, 6.0), 90.0), ((5.5, -4.0, 2.0), 30.0), ((4.5, 3.0, 5.0), 60.0))
_SIZE, _SAMPLES, _FOV = 512, 64, 20


@dataclass(frozen=True)
class SceneFolder:
    """What was written, and the command that renders it."""

    folder: Path
    files: tuple[Path, ...]
    command: str


def write_scene(folder: str | Path, table: TabularBrdf, renderer: str) -> SceneFolder:
    """Write a material on a MERL grid with a scene for ``renderer`` into ``folder``, which is made if need be.

    Raises
    ------
    OutputError
        When there is no such renderer, the grid is none that a MERL file holds, or a file cannot be written.
    """
    folder = Path(folder)
    if renderer not in RENDERERS:
        raise OutputError(
            f"{renderer} is no renderer to export to: expected {' or '.join(RENDERERS)}."
        )
    binary, bsdf = folder / "material.binary", folder / "material.bsdf"
    folder.mkdir(parents=True, exist_ok=True)
    match renderer:
        case "mitsuba":
            write_rgl(bsdf, table)
            write_merl(binary, table)
            texts = {
                "scene.xml": _mitsuba("measured", bsdf.name),
                "scene-exact.xml": _mitsuba("halfway_table", binary.name),
            }
            written, command = [bsdf, binary], "mitsuba -m scalar_rgb scene.xml"
        case "pbrt-v2":
            write_merl(binary, table)
            texts = {"scene.pbrt": _pbrt_v2(binary.name)}
            written, command = [binary], "pbrt scene.pbrt"
        case _:
            write_rgl(bsdf, table, spectral=True)
            texts = {"scene.pbrt": _pbrt_v4(bsdf.name)}
            written, command = [bsdf], "pbrt scene.pbrt"
    texts["README.md"] = _readme(table.name or "a material", renderer, command)
    for name, text in texts.items():
        with replacing(folder / name) as temporary:
            temporary.write_text(text, encoding="utf-8")
        written.append(folder / name)
    return SceneFolder(folder, tuple(written), command)


def _mitsuba(plugin: str, file: str) -> str:
    lights = "\n".join(
        f"""    <emitter type="point">
        <point name="position" x="{x}" y="{y}" z="{z}"/>
        <rgb name="intensity" value="{intensity}"/>
    </emitter>"""
        for (x, y, z), intensity in _LIGHTS
    )
    return f"""<scene version="3.0.0">
    <integrator type="path">
        <integer name="max_depth" value="2"/>
    </integrator>
    <sensor type="perspective">
        <float name="fov" value="{_FOV}"/>
        <transform name="to_world">
            <lookat origin="0, -7, 2" target="0, 0, 0" up="0, 0, 1"/>
        </transform>
        <film type="hdrfilm">
            <integer name="width" value="{_SIZE}"/>
            <integer name="height" value="{_SIZE}"/>
        </film>
        <sampler type="multijitter">
            <integer name="sample_count" value="{_SAMPLES}"/>
        </sampler>
    </sensor>
    <emitter type="constant">
        <rgb name="radiance" value="{_ENVIRONMENT}"/>
    </emitter>
{lights}
    <shape type="sphere">
        <bsdf type="{plugin}">
            <string name="filename" value="{file}"/>
        </bsdf>
    </shape>
</scene>
"""


def _pbrt_v2(file: str) -> str:
    lights = "\n".join(
        f'LightSource "point" "rgb I" [{i} {i} {i}] "point from" [{x} {y} {z}]'
        for (x, y, z), i in _LIGHTS
    )
    return f"""LookAt 0 -7 2  0 0 0  0 0 1
Camera "perspective" "float fov" [{_FOV}]
Film "image" "integer xresolution" [{_SIZE}] "integer yresolution" [{_SIZE}] "string filename" ["scene.exr"]
Sampler "lowdiscrepancy" "integer pixelsamples" [{_SAMPLES}]
SurfaceIntegrator "directlighting" "integer maxdepth" [1]
WorldBegin
LightSource "infinite" "rgb L" [{_ENVIRONMENT} {_ENVIRONMENT} {_ENVIRONMENT}]
{lights}
AttributeBegin
Material "measured" "string filename" ["{file}"]
Shape "sphere" "float radius" [1]
AttributeEnd
WorldEnd
"""


def _pbrt_v4(file: str) -> str:
    lights = "\n".join(
        f'LightSource "point" "rgb I" [{i} {i} {i}] "point3 from" [{x} {y} {z}]'
        for (x, y, z), i in _LIGHTS
    )
    return f"""LookAt 0 -7 2  0 0 0  0 0 1
Camera "perspective" "float fov" [{_FOV}]
Film "rgb" "integer xresolution" [{_SIZE}] "integer yresolution" [{_SIZE}] "string filename" ["scene.exr"]
Sampler "zsobol" "integer pixelsamples" [{_SAMPLES}]
Integrator "path" "integer maxdepth" [1]
WorldBegin
LightSource "infinite" "rgb L" [{_ENVIRONMENT} {_ENVIRONMENT} {_ENVIRONMENT}]
{lights}
AttributeBegin
Material "measured" "string filename" ["{file}"]
Shape "sphere" "float radius" [1]
AttributeEnd
"""


def _readme(name: str, renderer: str, command: str) -> str:
    notes = {
        "mitsuba": "`scene-exact.xml` shows the table itself: call `halfway.render.register()` before loading it.",
        "pbrt-v2": "pbrt-v2 looks up the nearest cell and samples the cosine only: give mirror-like materials more samples.",
        "pbrt-v4": "The file holds smooth spectra of the table's linear sRGB colours.",
    }
    return f"""# {name}

A sphere of {name}, under an even environment and three point lights. In this folder:

    {command}

{notes[renderer]}
"""
