"""Scene folders: rendered by Mitsuba itself, and held to pbrt's grammar."""

import re
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from pbrt_grammar import parse
from typer.testing import CliRunner

from halfway import MERL, Grid, TabularBrdf, tabulate
from halfway.cli import app
from halfway.errors import OutputError
from halfway.export.scenes import RENDERERS, write_scene
from halfway.fit import OpenPbr
from halfway.formats import read_brdf
from halfway.formats.rgl_writer import RESOLUTIONS, Resolution
from halfway.formats.tensor_file import read_tensors
from halfway.models import builtin
from halfway.render import register
from halfway.render.variant import load_mitsuba

GRID = Grid.merl(20, 20, 40)
UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def table():
    return tabulate(builtin("merl-abc").models["gold-paint"], GRID, name="gold-paint")


@pytest.fixture(scope="module")
def gold(tmp_path_factory, table):
    """The folder for Mitsuba, with small pictures."""
    folder = tmp_path_factory.mktemp("gold")
    written = write_scene(folder, table, "mitsuba", name="gold-paint")
    for scene in folder.glob("*.xml"):
        small = scene.read_text().replace('value="512"', 'value="32"')
        scene.write_text(small.replace('value="64"', 'value="16"'))
    return written


def rendered(mi, file):
    return np.array(mi.render(mi.load_file(str(file)), seed=0))


def psnr(a, b):
    a, b = (np.clip(x, 0, 1) ** (1 / 2.2) for x in (a, b))
    return -10 * np.log10(np.mean((a - b) ** 2))


def test_mitsuba_renders_both_of_its_scenes(gold):
    """The stock plugin with the .bsdf, and the table itself: gold is redder than it is blue, and lit from the left."""
    assert [f.name for f in gold.files] == [
        "material.bsdf",
        "material.binary",
        "scene.xml",
        "scene-exact.xml",
        "README.md",
    ]
    mi = load_mitsuba()
    with mi.variant_context("scalar_rgb"):
        stock = rendered(mi, gold.folder / "scene.xml")
    register()
    exact = rendered(mi, gold.folder / "scene-exact.xml")
    for picture in (stock, exact):
        middle = picture[11:21, 11:21].mean(axis=(0, 1))
        assert middle[0] > middle[1] > middle[2] > 0.01
        assert picture[10:15, 10:15].mean() > 1.1 * picture[10:15, 17:22].mean()
    # One seed, two samplers: the rest is noise.
    assert psnr(stock, exact) > 25


def test_an_anisotropic_material_takes_a_file_that_keeps_it_whole(tmp_path, monkeypatch):
    """Both of Mitsuba's scenes, and that of pbrt-v4, whose files hold several azimuths."""
    monkeypatch.setattr("halfway.formats.rgl_writer.RESOLUTIONS", RESOLUTIONS[:1])
    grid = Grid.anisotropic(24, 12, 6, 12, period=np.pi)
    model = OpenPbr([0.9, 0.6, 0.3], base_metalness=1.0, specular_roughness=0.5, specular_roughness_anisotropy=0.7)  # fmt: skip
    brushed = tabulate(model, grid, name="brushed")
    written = write_scene(tmp_path, brushed, "mitsuba")
    assert "material.zarr" in [file.name for file in written.files]
    assert_array_equal(read_brdf(tmp_path / "material.zarr").values, brushed.values)
    for scene in tmp_path.glob("*.xml"):
        scene.write_text(scene.read_text().replace('value="512"', 'value="32"'))
    register()
    mi = load_mitsuba()
    stock, exact = (rendered(mi, tmp_path / f"{name}.xml") for name in ("scene", "scene-exact"))
    # The noise of 64 samples, and a small file.
    assert psnr(stock, exact) > 27
    monkeypatch.setattr("halfway.formats.rgl_writer.RESOLUTIONS", [Resolution(4, 8)])
    write_scene(tmp_path / "pbrt", brushed, "pbrt-v4")
    assert len(tensors(tmp_path / "pbrt" / "material.bsdf")["phi_i"]) > 2


def tensors(path):
    with path.open("rb") as file:
        return read_tensors(file, path.name)


@pytest.mark.parametrize("renderer", ["pbrt-v2", "pbrt-v4"])
def test_pbrt_scenes_follow_the_grammar(tmp_path, table, renderer):
    brdf = builtin("merl-abc").models["gold-paint"] if renderer == "pbrt-v2" else table
    written = write_scene(tmp_path, brdf, renderer)
    directives = parse((tmp_path / "scene.pbrt").read_text(), renderer)
    (material,) = [d for d in directives if d.name == "Material"]
    path = tmp_path / material.parameters["filename"][0]
    assert path in written.files
    assert_allclose(read_brdf(path).eval(UP, UP), table.eval(UP, UP), rtol=0.02)
    if renderer == "pbrt-v4":
        assert {"wavelengths", "spectra"} < set(tensors(path))


@pytest.mark.parametrize(
    ("change", "version"),
    [
        (("Scale -1 1 1", "Scale -1 1"), "pbrt-v4"),
        (("point3 from", "point from"), "pbrt-v4"),
        (("float fov", "integer fov"), "pbrt-v4"),
        (("zsobol", "sobl"), "pbrt-v4"),
        (("WorldBegin", ""), "pbrt-v4"),
        (("AttributeEnd", ""), "pbrt-v4"),
        (("[512] ", "[51.2] "), "pbrt-v4"),
        (("", ""), "pbrt-v2"),
    ],
)
def test_the_grammar_is_strict(tmp_path, table, change, version):
    write_scene(tmp_path, table, "pbrt-v4")
    with pytest.raises((AssertionError, KeyError, ValueError)):
        parse((tmp_path / "scene.pbrt").read_text().replace(*change), version)


def test_the_key_light_is_on_the_left_of_pbrts_picture(tmp_path, table):
    """As in Mitsuba's. The pages: left-handed coordinates; LookAt puts up x direction along the camera's x, its right."""
    write_scene(tmp_path, table, "pbrt-v4")
    directives = parse((tmp_path / "scene.pbrt").read_text(), "pbrt-v4")
    (scale,) = [d.numbers for d in directives if d.name == "Scale"]
    eye, target, up = np.reshape([d.numbers for d in directives if d.name == "LookAt"], (3, 3))
    key = max((d for d in directives if d.kind == "point"), key=lambda d: d.parameters["I"][0])
    to_the_right = scale[0] * np.cross(up, target - eye)
    assert to_the_right @ (np.array(key.parameters["from"]) - eye) < 0
    assert directives[0].name == "Scale"


def test_pbrt_v2_reads_no_other_grid(tmp_path, table):
    with pytest.raises(
        OutputError, match="gold-paint has 20 x 20 x 40 cells, and pbrt-v2 reads none but"
    ):
        write_scene(tmp_path, table, "pbrt-v2")


def test_the_folder_says_how_to_render_it(tmp_path, table):
    for renderer in RENDERERS:
        brdf = (
            TabularBrdf(np.full((3, *MERL.shape), 0.1, np.float32), MERL)
            if renderer == "pbrt-v2"
            else table
        )
        written = write_scene(
            tmp_path / renderer, brdf, renderer, name="gold-paint", origin="Made of gold."
        )
        readme = (tmp_path / renderer / "README.md").read_text()
        assert readme.startswith("# gold-paint\n\nMade of gold.\n")
        assert f"\n    {written.command}\n" in readme
    assert "without interpolation" in (tmp_path / "pbrt-v2" / "README.md").read_text()
    assert "samples the cosine only" in (tmp_path / "pbrt-v2" / "README.md").read_text()


def test_what_the_page_says_of_the_exact_scene_works(gold):
    """Python of the page, in a process of its own, in the folder."""
    (code,) = re.findall(r'python -c "\n(.*?)\n    "', (gold.folder / "README.md").read_text(), re.DOTALL)  # fmt: skip
    code = "\n".join(line.removeprefix("    ") for line in code.splitlines())
    subprocess.run([sys.executable, "-c", code], cwd=gold.folder, check=True, capture_output=True)
    assert (gold.folder / "scene-exact.exr").stat().st_size > 1000


def test_an_unknown_renderer_is_said(tmp_path, table):
    with pytest.raises(
        OutputError, match="arnold is no renderer to export to: expected mitsuba or"
    ):
        write_scene(tmp_path / "x", table, "arnold")
    assert not (tmp_path / "x").exists()


# The command


@pytest.fixture
def halfway():
    return lambda *words: CliRunner().invoke(app, list(words))


def test_export_writes_a_mix_and_says_whose_numbers_it_stands_on(tmp_path, halfway):
    done = halfway("export", "gold-paint=0.7, teflon=0.3", "--for", "pbrt-v2", "-o", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert f"cd {tmp_path} && pbrt scene.pbrt" in done.stderr
    readme = (tmp_path / "README.md").read_text()
    assert '`{"gold-paint": 0.7, "teflon": 0.3}`' in readme
    assert "not measurements" in readme
    assert_allclose(
        read_brdf(tmp_path / "material.binary").eval(UP, UP),
        0.7 * read_eval("gold-paint") + 0.3 * read_eval("teflon"),
        rtol=1e-5,
    )


def read_eval(name):
    return tabulate(builtin("merl-abc").models[name], MERL).eval(UP, UP)


def test_several_materials_get_a_folder_each(tmp_path, halfway, table):
    from halfway.formats import write_merl

    for name in ("a", "b"):
        write_merl(tmp_path / f"{name}.binary", table)
    files = [str(tmp_path / f"{name}.binary") for name in ("a", "b")]
    done = halfway("export", *files, "--for", "pbrt-v4", "-o", str(tmp_path / "out"))
    assert done.exit_code == 0, done.output
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["a", "b", "manifest.json"]
    done = halfway("export", files[0], files[0], "--for", "pbrt-v4", "-o", str(tmp_path / "twice"))
    assert sorted(p.name for p in (tmp_path / "twice").iterdir()) == ["a", "a-2", "manifest.json"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["gold-paint", "--for", "arnold", "-o", "x"], "'arnold' is not one of"),
        (["gold-paint", "-o", "x"], "Missing option '--for'"),
        (["gold-paint", "--for", "mitsuba"], "Missing option '--output'"),
    ],
)
def test_a_mistake_is_said(halfway, words, said):
    done = halfway("export", *words)
    assert done.exit_code == 2
    assert said in done.stderr
