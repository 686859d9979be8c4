"""A folder that a renderer runs as it is: a material, a scene that shows it on a sphere, and a page that says how.

The scene is the same everywhere: a sphere of radius 1 at the origin, z up, a camera at (0, -7, 2) that sees x to the right,
an even dim environment and three point lights; direct light.

    mitsuba   scene.xml with the stock `measured` plugin and material.bsdf; scene-exact.xml with `halfway_table` and
              material.binary, the table itself; material.zarr where it depends on phi_h
    pbrt-v2   scene.pbrt with `measured` and material.binary, on the database's grid: it reads no other
    pbrt-v4   scene.pbrt with `measured` and material.bsdf, spectral

pbrt's coordinates are left-handed: a scale of -1 along x before the camera makes its pictures those of the other.

Syntax: the plugin reference of Mitsuba 3; https://pbrt.org/fileformat-v2 and https://pbrt.org/fileformat-v4.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ..brdf import Brdf, TabularBrdf, tabulate
from ..errors import OutputError
from ..files import write_text
from ..formats import write_brdf, write_merl, write_rgl
from ..halfdiff import MERL

RENDERERS = ("mitsuba", "pbrt-v2", "pbrt-v4")

_ENVIRONMENT = 0.3
_LIGHTS = (((-4.0, -5.0, 6.0), 90.0), ((5.5, -4.0, 2.0), 30.0), ((4.5, 3.0, 5.0), 60.0))
_SIZE, _SAMPLES, _FOV = 512, 64, 20


class _Pbrt(NamedTuple):
    """What the versions of pbrt call differently."""

    film: str
    sampler: str
    integrator: str
    point: str
    end: str


_PBRT = {
    "pbrt-v2": _Pbrt("image", "lowdiscrepancy", 'SurfaceIntegrator "directlighting"', "point", "WorldEnd\n"),
    "pbrt-v4": _Pbrt("rgb", "zsobol", 'Integrator "path"', "point3", ""),
}  # fmt: skip


@dataclass(frozen=True)
class SceneFolder:
    """What was written, and the command that renders it."""

    folder: Path
    files: tuple[Path, ...]
    command: str


def write_scene(
    folder: str | Path, brdf: Brdf, renderer: str, *, name: str = "", origin: str = ""
) -> SceneFolder:
    """Write a material with a scene for ``renderer`` into ``folder``, which is made if need be.

    Parameters
    ----------
    folder : path
        What is there under the same names is replaced.
    brdf : Brdf
        Any; pbrt-v2, and the exact scene for Mitsuba, take it as a table.
    renderer : str
        One of `RENDERERS`.
    name : str
        What the page calls the material; by default its own name.
    origin : str
        Lines for the page: what the material is made of, whose numbers it stands on.

    Raises
    ------
    OutputError
        When there is no such renderer, the table's grid is none that it reads, or a file cannot be written.
    """
    folder = Path(folder)
    name = name or str(getattr(brdf, "name", "")) or "a material"
    match renderer:
        case "mitsuba":
            notes = _write_bsdf(folder / "material.bsdf", brdf)
            table = _table(brdf, name)
            exact = "material.binary" if table.is_isotropic else "material.zarr"
            write_brdf(folder / exact, table)
            texts = {
                "scene.xml": _mitsuba("measured", "material.bsdf"),
                "scene-exact.xml": _mitsuba("halfway_table", exact),
            }
            files, command = ["material.bsdf", exact], "mitsuba -m scalar_rgb scene.xml"
            notes = f"{notes}\n\n{_EXACT}"
        case "pbrt-v2":
            write_merl(folder / "material.binary", _on_the_grid_of_the_database(_table(brdf, name)))
            texts = {"scene.pbrt": _pbrt(_PBRT[renderer], "material.binary")}
            files, command, notes = ["material.binary"], "pbrt scene.pbrt", _FLOOR
        case "pbrt-v4":
            notes = _write_bsdf(folder / "material.bsdf", brdf, spectral=True)
            texts = {"scene.pbrt": _pbrt(_PBRT[renderer], "material.bsdf")}
            files, command = ["material.bsdf"], "pbrt scene.pbrt"
        case _:
            raise OutputError(
                f"{renderer} is no renderer to export to: expected {' or '.join(RENDERERS)}."
            )
    what = f"A sphere of {name}, under an even environment and three point lights."
    texts["README.md"] = readme(name, origin, f"{what} In this folder:", command, notes)
    for file, text in texts.items():
        write_text(folder / file, text)
    return SceneFolder(folder, tuple(folder / file for file in (*files, *texts)), command)


def _write_bsdf(path: Path, brdf: Brdf, *, spectral: bool = False) -> str:
    """Write the file, and say how well it stands for the material."""
    written = write_rgl(path, brdf, spectral=spectral)
    n_theta_i, side = written.resolution
    colours = "smooth spectra of linear sRGB colours" if spectral else "linear sRGB colours"
    return (
        f"`{path.name}` holds {colours} for {n_theta_i} directions of {side} x {side} values each: on a lit sphere "
        f"{written.quality.psnr:.1f} dB from the material, {written.quality.relative_l1:.2%} mean error."
    )


def _table(brdf: Brdf, name: str) -> TabularBrdf:
    return brdf if isinstance(brdf, TabularBrdf) else tabulate(brdf, brdf.own_grid, name=name)


def _on_the_grid_of_the_database(table: TabularBrdf) -> TabularBrdf:
    if table.grid != MERL:
        raise OutputError(
            f"{table.name or 'the table'} has {table.grid} cells, and pbrt-v2 reads none but the database's {MERL}: "
            "export it for mitsuba or pbrt-v4, or sample it on that grid first, with "
            f"`halfway convert IN OUT.binary --grid {'x'.join(map(str, MERL.shape))}`."
        )
    return table


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


def _pbrt(version: _Pbrt, file: str) -> str:
    lights = "\n".join(
        f'LightSource "point" "rgb I" [{i} {i} {i}] "{version.point} from" [{x} {y} {z}]'
        for (x, y, z), i in _LIGHTS
    )
    return f"""Scale -1 1 1
LookAt 0 -7 2  0 0 0  0 0 1
Camera "perspective" "float fov" [{_FOV}]
Film "{version.film}" "integer xresolution" [{_SIZE}] "integer yresolution" [{_SIZE}] "string filename" ["scene.exr"]
Sampler "{version.sampler}" "integer pixelsamples" [{_SAMPLES}]
{version.integrator} "integer maxdepth" [1]
WorldBegin
LightSource "infinite" "rgb L" [{_ENVIRONMENT} {_ENVIRONMENT} {_ENVIRONMENT}]
{lights}
AttributeBegin
Material "measured" "string filename" ["{file}"]
Shape "sphere" "float radius" [1]
AttributeEnd
{version.end}"""


_EXACT = """`scene-exact.xml` shows the table itself, where halfway is installed:

    python -c "
    from halfway.render import register
    register()
    import mitsuba as mi
    mi.util.write_bitmap('scene-exact.exr', mi.render(mi.load_file('scene-exact.xml')))
    \""""

_FLOOR = """pbrt-v2 takes the value of the cell that a pair of directions falls into, without interpolation, shows what was not measured
as black, and samples the cosine only: give mirror-like materials more `pixelsamples`."""


def readme(title: str, origin: str, what: str, command: str, notes: str) -> str:
    """The page of a folder: what is in it, whose numbers those are, the command that shows it."""
    paragraphs = [f"# {title}", origin, what, f"    {command}", notes]
    return "\n\n".join(filter(None, paragraphs)) + "\n"
