"""A sphere in the light of what surrounds it, and a material found by its picture there."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exr_files import exr
from glossy import GRID, glossy, library
from numpy.testing import assert_allclose
from PIL import Image

from halfway import find
from halfway.brdf import TabularBrdf, directional_albedo
from halfway.cli.arguments import ArgumentError, parse_lights
from halfway.colour import to_srgb
from halfway.errors import RenderError
from halfway.look import FilledSphere, SphereOperator, SphereScene
from halfway.render import SCENES, Renderer, open_environment
from halfway.render.scenes import Camera

N_ROWS = 16
BODY = (0.3, 0.2, 0.1)


def pictured(table: TabularBrdf, scene: SphereScene) -> np.ndarray:
    """The picture of a table's sphere as a square, 0 beside it."""
    picture = np.zeros((scene.size, scene.size, 3))
    picture[scene.mask()] = SphereOperator.of(scene, table.grid).picture(
        table.values.reshape(3, -1)
    )
    return picture


def spot(row: int, column: int, colour: tuple[float, float, float]) -> np.ndarray:
    """A dark environment with one cell that shines, of 11 degrees."""
    radiance = np.zeros((N_ROWS, 2 * N_ROWS, 3), np.float32)
    radiance[row, column] = colour
    return radiance


def direction(row: int, column: int) -> list[float]:
    """To the middle of a cell; right, up, to the viewer. The middle column is away from the viewer."""
    theta, turn = np.pi * (row + 0.5) / N_ROWS, np.pi * (column + 0.5) / N_ROWS - np.pi
    return [np.sin(theta) * np.sin(turn), np.cos(theta), -np.sin(theta) * np.cos(turn)]


def test_in_even_light_a_sphere_shows_its_albedo():
    """By reciprocity: what leaves towards the viewer is the share of light from there that is reflected."""
    table = glossy(BODY, 1.0, 0.15)
    scene = SphereScene.under(np.ones((N_ROWS, 2 * N_ROWS, 3)))
    at = (np.arange(scene.size) + 0.5) * 2 / scene.size - 1
    sin = np.hypot(at, at[:, None])
    shown = pictured(table, scene)
    for least, most in ((0.0, 0.3), (0.4, 0.6), (0.6, 0.8)):
        ring = (least <= sin) & (sin < most)
        expected = [directional_albedo(table, np.arcsin(s)) for s in sin[ring][::40]]
        # A white sphere is .5 in the mean. 64 directions at each of 4 points of a hundred pixels and more: 1 % of noise.
        assert_allclose(2 * shown[ring].mean(axis=0), np.mean(expected, axis=0), rtol=0.03)


@pytest.mark.parametrize(("row", "column"), [(4, 22), (9, 27)])
def test_a_spot_is_a_light_from_there_in_its_colour(row: int, column: int):
    table = glossy(BODY, 1.0, 0.4)  # a lobe that is wider than the spot
    around = pictured(table, SphereScene.under(spot(row, column, (1.0, 0.5, 0.0))))
    parallel = replace(SphereScene.under(np.array([direction(row, column)])), size=48)
    alone = pictured(table, parallel) * (1.0, 0.5, 0.0)
    alone *= around.sum() / alone.sum()
    assert np.abs(around - alone).sum() < 0.08 * alone.sum()
    assert (around[..., 2] == 0).all()


def test_tables_that_are_filled_have_the_same_picture():
    table = glossy(BODY, 1.0, 0.2)
    scene = SphereScene.under(np.random.default_rng(0).random((5, 9, 3)))
    row = np.nan_to_num(table.values.reshape(3, -1))
    filled = FilledSphere.of(scene, GRID).pictures(row[:, None])[0]
    assert_allclose(filled, SphereOperator.of(scene, GRID).picture(row), rtol=1e-4, atol=1e-6)


@pytest.fixture(scope="module")
def place(tmp_path_factory) -> Path:
    """A room with red walls and a lamp, as a file."""
    rng = np.random.default_rng(2)
    radiance = 0.2 + 0.3 * rng.random((8, 16, 3)).repeat(4, axis=0).repeat(4, axis=1)
    radiance *= (1.0, 0.4, 0.3)
    radiance[6:9, 40:44] = (60, 30, 20)
    path = tmp_path_factory.mktemp("place") / "room.exr"
    channels = [(c, 2, radiance[..., i]) for i, c in enumerate("RGB")]
    path.write_bytes(exr(channels))
    return path


def test_a_material_is_found_by_its_picture_in_a_place(place: Path, tmp_path: Path):
    """Rendered by Mitsuba, with noise, at any exposure; where the light is taken for another it is not."""
    materials = library()
    camera = Camera((0.0, -100.0, 1.0), (0.0, 0.0, 1.0), 2 * np.degrees(np.arcsin(1 / 100)))
    filled = replace(SCENES["sphere"], camera=camera)
    picture = Renderer(filled, size=(48, 48), spp=16, env=place).picture(materials.brdf("m10"))
    noise = np.random.default_rng(0).normal(0, 0.01, picture.shape)
    coded = np.clip(to_srgb(np.clip(0.4 * picture, 0, 1)) + noise, 0, 1)
    Image.fromarray(np.round(255 * coded).astype(np.uint8)).save(tmp_path / "photo.png")
    share = {}
    for name, lights in (("there", open_environment(place)), ("elsewhere", None)):
        recipe = find(materials, str(tmp_path / "photo.png"), lights=lights)
        share[name] = recipe.dense(materials.names)[0, materials.index("m10")]
    assert share["there"] > 0.9
    assert share["elsewhere"] < 0.5


def test_lights_are_directions_or_an_environment(place: Path):
    assert_allclose(parse_lights("-1,1,1"), [[-1, 1, 1]])
    assert_allclose(parse_lights("-1,1,1;0,0,1"), [[-1, 1, 1], [0, 0, 1]])
    assert parse_lights("studio").shape == (256, 512, 3)
    assert parse_lights(str(place)).shape == (32, 64, 3)


@pytest.mark.parametrize("text", ["1,2", "0,0,-1", "0,0,0", "nan,1,1", "1,1,1;2"])
def test_what_is_no_direction_is_refused(text: str):
    with pytest.raises(ArgumentError, match="no directions to lights"):
        parse_lights(text)


def test_an_environment_that_is_not_there_is_refused():
    with pytest.raises(RenderError, match=r"the environment forest is of an unknown kind"):
        parse_lights("forest")
