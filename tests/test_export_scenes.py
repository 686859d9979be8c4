"""Scene folders: loaded by Mitsuba itself, and held to pbrt's grammar."""

import re

import numpy as np
import pytest
from test_rgl import _mitsuba

from halfway import Grid, tabulate
from halfway.errors import OutputError
from halfway.export.scenes import write_scene
from halfway.formats import read_brdf
from halfway.models import builtin

GRID = Grid.merl(20, 20, 40)


@pytest.fixture(scope="module")
def table():
    return tabulate(builtin("merl-abc").models["gold-paint"], GRID, name="gold-paint")


def rendered(mi, file):
    return np.array(mi.render(mi.load_file(str(file)), spp=4, seed=0))


def test_mitsuba_renders_its_folder(tmp_path, table):
    """The stock plugin with the .bsdf: gold is redder than it is blue, and nothing is black where the sphere is."""
    written = write_scene(tmp_path / "gold", table, "mitsuba")
    assert [f.name for f in written.files] == [
        "material.bsdf",
        "material.binary",
        "scene.xml",
        "scene-exact.xml",
        "README.md",
    ]
    scene = tmp_path / "gold" / "scene.xml"
    scene.write_text(scene.read_text().replace('value="512"', 'value="24"'))
    mi = _mitsuba()
    with mi.variant_context("scalar_rgb"):
        picture = rendered(mi, scene)
    middle = picture[8:16, 8:16].mean(axis=(0, 1))
    assert middle[0] > middle[1] > middle[2] > 0.01


@pytest.mark.parametrize("renderer", ["pbrt-v2", "pbrt-v4"])
def test_pbrt_scenes_follow_the_grammar(tmp_path, table, renderer):
    written = write_scene(tmp_path, table, renderer)
    for line in (tmp_path / "scene.pbrt").read_text().splitlines():
        require_directive(line, renderer)
    (material,) = re.findall(
        r'Material "measured" "string filename" \["(.*)"\]', (tmp_path / "scene.pbrt").read_text()
    )
    assert tmp_path / material in written.files
    up = np.array([0.0, 0.0, 1.0])
    assert read_brdf(tmp_path / material).eval(up, up) == pytest.approx(
        table.eval(up, up), rel=0.02
    )


# A directive: what follows its name, and the parameters it knows, as "type name". From the file format pages.
DIRECTIVES = {
    "LookAt": 9,
    "Camera": {"perspective": {"float fov"}},
    "Sampler": {"lowdiscrepancy": {"integer pixelsamples"}, "zsobol": {"integer pixelsamples"}},
    "Film": {
        name: {"integer xresolution", "integer yresolution", "string filename"}
        for name in ("image", "rgb")
    },
    "SurfaceIntegrator": {"directlighting": {"integer maxdepth"}},
    "Integrator": {"path": {"integer maxdepth"}},
    "LightSource": {"infinite": {"rgb L"}, "point": {"rgb I", "point from", "point3 from"}},
    "Material": {"measured": {"string filename"}},
    "Shape": {"sphere": {"float radius"}},
    "WorldBegin": 0,
    "WorldEnd": 0,
    "AttributeBegin": 0,
    "AttributeEnd": 0,
}
ONLY = {
    "pbrt-v2": {"WorldEnd", "SurfaceIntegrator", "point from", "image", "lowdiscrepancy"},
    "pbrt-v4": {"Integrator", "point3 from", "rgb", "zsobol"},
}
N_VALUES = {"rgb": 3, "point": 3, "point3": 3, "float": 1, "integer": 1, "string": 1}
PARAMETER = re.compile(r'\s*"(\w+) (\w+)" \[([^\]]*)\]')


def require_directive(line, renderer):
    name, _, rest = line.partition(" ")
    known = DIRECTIVES[name]
    (other,) = set(ONLY) - {renderer}
    assert name not in ONLY[other]
    if isinstance(known, int):
        assert len([float(number) for number in rest.split()]) == known
        return
    kind, rest = re.fullmatch(r'"([\w-]+)"(.*)', rest).groups()
    assert kind in known
    assert kind not in ONLY[other]
    end = 0
    for parameter in PARAMETER.finditer(rest):
        assert parameter.start() == end
        end = parameter.end()
        type_, label, values = parameter.groups()
        assert f"{type_} {label}" in known[kind]
        assert f"{type_} {label}" not in ONLY[other]
        assert len(values.split()) == N_VALUES[type_]
        if type_ == "string":
            assert re.fullmatch(r'"[^"]+"', values)
        else:
            assert [float(value) for value in values.split()]
    assert end == len(rest)


def test_the_folder_says_how_to_render_it(tmp_path, table):
    for renderer in ("mitsuba", "pbrt-v2", "pbrt-v4"):
        written = write_scene(tmp_path / renderer, table, renderer)
        readme = (tmp_path / renderer / "README.md").read_text()
        assert readme.startswith("# gold-paint")
        assert written.command in readme


def test_an_unknown_renderer_is_said(tmp_path, table):
    with pytest.raises(
        OutputError, match="arnold is no renderer to export to: expected mitsuba or"
    ):
        write_scene(tmp_path, table, "arnold")
