"""Pictures of whole scenes."""

import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from halfway.brdf import TabularBrdf
from halfway.errors import RenderError
from halfway.halfdiff import Grid
from halfway.render import SCENES, Renderer
from halfway.render.exposure import Exposure
from halfway.render.renderer import BACKGROUND
from halfway.render.scenes import PointLight
from halfway.render.studio import _on_the_ground, as_bright_as_the_studio, directions, studio
from halfway.tasks import Work

GRID = Grid.merl(12, 10, 12)


def lambertian(*albedo: float) -> TabularBrdf:
    values = np.array(albedo, np.float32)[:, None, None, None] / np.float32(np.pi)
    return TabularBrdf(np.broadcast_to(values, (3, *GRID.shape)).copy(), GRID)


RED, GREEN, BLACK = lambertian(0.8, 0.1, 0.1), lambertian(0.1, 0.6, 0.1), lambertian(0, 0, 0)


@pytest.fixture(scope="module")
def teapot() -> Renderer:
    return Renderer("teapot", size=(48, 40), spp=16, seed=3)


def test_the_same_seed_gives_the_same_picture(teapot):
    first = teapot.picture(RED)
    teapot.picture(GREEN)
    assert first.shape == (40, 48, 3)
    assert first.dtype == np.float32
    # Threads add up a pixel's samples in another order: some units in the last place.
    again = Renderer("teapot", size=(48, 40), spp=16, seed=3).picture(RED)
    assert_allclose(teapot.picture(RED), first, rtol=2e-6)
    assert_allclose(again, first, rtol=2e-6)
    assert not np.array_equal(Renderer("teapot", size=(48, 40), spp=16, seed=4).picture(RED), first)


def test_the_picture_of_a_mix_is_the_mix_of_the_pictures(teapot):
    mixed = TabularBrdf(0.3 * RED.values + 0.7 * GREEN.values, GRID)
    assert_allclose(
        teapot.picture(mixed), 0.3 * teapot.picture(RED) + 0.7 * teapot.picture(GREEN), atol=0.02
    )


def test_the_material_colours_the_object_and_not_the_ground(teapot):
    red = teapot.picture(RED)
    assert red[24, 22, 0] > 3 * red[24, 22, 1]
    assert_allclose(red[-1, 0], red[-1, 0, 0], rtol=0.02)
    assert_array_equal(red[-1], teapot.picture(GREEN)[-1])
    assert red[-1].min() > 0.2


def test_the_object_before_its_backdrop_is_the_picture_of_one_scene():
    """Of a black object, which no light from the ground changes."""
    renderer = Renderer("teapot", size=(48, 40), spp=256)
    together = renderer._stage.whole([BLACK], Exposure(256, 5), bounces=1).over(renderer.backdrop)
    picture = renderer.picture(BLACK)
    assert_allclose(picture.mean(), together.mean(), rtol=0.005)
    # The noise of 256 samples is 2 % here, and the backdrop is coarse.
    assert np.abs(picture - together).mean() < 0.03 * together.mean()


def test_the_backdrop_is_seen_through_the_object_and_has_its_shadow(teapot):
    backdrop = teapot.backdrop
    assert backdrop.shape == (40, 48, 3)
    assert backdrop[27, 22].max() < 0.05 * backdrop[-1, 0].min()  # under the foot
    assert backdrop[4, 24].min() > 0.2  # behind the lid
    assert_array_equal(teapot.picture(BLACK)[0], backdrop[0])


def test_the_backdrop_is_rendered_once_for_all_materials_and_seeds(tmp_path, monkeypatch):
    work = Work(cache=tmp_path)
    first = Renderer("teapot", size=(24, 20), spp=4, work=work).backdrop
    monkeypatch.setattr("halfway.render.stage.Stage.ground", None)
    assert_array_equal(Renderer("teapot", size=(24, 20), spp=16, seed=1, work=work).backdrop, first)
    with pytest.raises(TypeError):  # another size asks for another
        _ = Renderer("teapot", size=(25, 20), spp=4, work=work).backdrop


def test_an_environment_lights_every_scene(tmp_path):
    env = tmp_path / "red.hdr"
    env.write_bytes(
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + bytes([128, 0, 0, 128] * 2)
    )
    picture = Renderer("spheres", size=(16, 16), spp=4, env=env).picture(lambertian(0.5, 0.5, 0.5))
    assert picture[8, 8, 0] > 10 * picture[8, 8, 1]


def test_a_point_lit_sphere_shows_its_brdf():
    """Where the light meets a white sphere head-on, radiance is albedo / pi times intensity / distance^2."""
    renderer = Renderer("sphere", size=(65, 65), spp=4)
    picture = renderer.picture(lambertian(1, 1, 1))
    scene = SCENES["sphere"]
    light = scene.points[0]
    distance = np.linalg.norm(np.array(light.at) - [0, 0, 1]) - 1
    assert_allclose(picture.max(), light.intensity / distance**2 / np.pi, rtol=0.02)


def test_more_bounces_bring_more_light():
    renderer = Renderer("trio", size=(32, 32), spp=16)
    assert not renderer.linear
    assert Renderer("teapot", size=(8, 8), spp=1).linear
    direct = Renderer("trio", size=(32, 32), spp=16, bounces=1)
    assert renderer.picture(RED).mean() > 1.05 * direct.picture(RED).mean()


def test_a_scene_of_three_takes_one_material_or_three():
    renderer = Renderer("trio", size=(16, 16), spp=1)
    picture = renderer.picture([RED, GREEN, RED])
    assert picture.shape == (16, 16, 3)
    with pytest.raises(RenderError, match=r"trio takes 3 materials: 2 were given"):
        renderer.picture([RED, GREEN])


def test_turning_camera_and_light_with_the_objects_changes_nothing():
    light, eye = PointLight((3.0, -5.0, 6.0), 200.0), SCENES["trio"].camera
    scene = replace(SCENES["trio"], points=(light,), ground=False, bounces=1)
    around = {"at": turned(eye.at, 90), "target": turned(eye.target, 90)}
    moved = replace(
        scene,
        camera=replace(eye, **around),
        points=(replace(light, at=turned(light.at, 90)),),
    )
    options = {"size": (64, 48), "spp": 64}
    still, other = Renderer(scene, **options), Renderer(moved, **options)
    expected, found = still.picture(RED), other.turned(90).picture(RED)
    assert np.abs(other.picture(RED) - expected).mean() > 0.3 * expected.mean()
    # The same samples; a pixel on an edge falls to one side or the other.
    assert np.quantile(np.abs(found - expected), 0.99) < 1e-3 * expected.max()


def turned(at, degrees):
    x, y, z = at
    turn = (x + 1j * y) * np.exp(1j * np.radians(degrees))
    return turn.real, turn.imag, z


def test_a_white_sphere_is_not_seen_in_even_light(tmp_path):
    """A white furnace: it reflects what is behind it."""
    env = write_environment(tmp_path, [(128, 128, 128)] * 8)
    before = {"env": env, "show_env": True, "size": (32, 32), "spp": 64}
    picture = Renderer("spheres", **before).picture(lambertian(1, 1, 1))
    # A pixel of 64 samples is off by 2 %; a hundred of them are not.
    assert_allclose(picture, picture[0, 0, 0], rtol=0.1)
    assert_allclose(picture[11:21, 11:21].mean(axis=(0, 1)), picture[0, 0, 0], rtol=0.01)
    assert picture[0, 0, 0] > 10 * BACKGROUND
    grey = Renderer("teapot", **before).picture(lambertian(0.5, 0.5, 0.5))
    assert_allclose(grey[[0, -1]], picture[0, 0, 0], rtol=1e-3)  # no ground
    assert grey[16, 16].max() < 0.7 * picture[0, 0, 0]


def test_the_middle_of_an_environment_is_behind_the_objects(tmp_path):
    """Of eight columns the two in the middle are red, on the left, and green; a camera of 10 degrees sees a quarter of one."""
    dim, red, green = (3, 3, 3), (128, 0, 0), (0, 128, 0)
    env = write_environment(tmp_path, [dim] * 3 + [red, green] + [dim] * 3)
    picture = Renderer("sphere", env=env, show_env=True, size=(32, 32), spp=4).picture(BLACK)
    left, right = picture[0, 0], picture[0, -1]
    assert left[0] > 1.3 * left[1] > 10 * left[2]
    assert right[1] > 1.3 * right[0] > 10 * right[2]
    assert_array_equal(picture[16, 16], 0)


def write_environment(folder, row):
    """An environment of four rows of the same pixels, RGB with a common exponent of 1."""
    path = folder / "light.hdr"
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X {len(row)}\n".encode()
    path.write_bytes(header + bytes(x for pixel in row * 4 for x in (*pixel, 128)))
    return path


def test_a_mesh_stands_in_for_the_teapot(tmp_path):
    """A cube, y up, in place of the teapot."""
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [
        f"f {a} {b} {c} {d}" for a, b, c, d in quads
    ]
    path = tmp_path / "cube.obj"
    path.write_text("\n".join(lines))
    picture = Renderer("teapot", size=(32, 32), spp=4, mesh=path).picture(RED)
    assert picture[16, 16, 0] > 2 * picture[16, 16, 1] > 0


def test_a_sheet_shows_the_material_from_both_sides(tmp_path):
    """An upright square that faces the camera, or turns its back to it."""
    path = tmp_path / "sheet.obj"
    pictures = []
    for order in ("1 2 3 4", "4 3 2 1"):
        path.write_text(f"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf {order}")
        pictures.append(Renderer("teapot", size=(32, 32), spp=16, mesh=path).picture(RED))
    front, back = pictures
    assert front[16, 16, 0] > 2 * front[16, 16, 1] > 0
    # Of 16 samples each, from frames that are turned against each other.
    assert_allclose(back[16, 16], front[16, 16], rtol=0.2)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"scene": "kitchen"}, "no scene 'kitchen': there are teapot, spheres, sphere, trio"),
        ({"size": (0, 10)}, "width is 0: expected 1 to 8192"),
        ({"size": (10, 9000)}, "height is 9000: expected 1 to 8192"),
        ({"spp": 0}, "spp is 0: expected 1 to 65536"),
        ({"bounces": 0}, "bounces is 0: expected 1 to"),
        ({"seed": -1}, "seed is -1: expected 0 to 4294967295"),
        ({"mesh": "none.ply"}, "there is no mesh none.ply: see where you are"),
        ({"mesh": "dragon.stl"}, r"mesh dragon.stl is of an unknown kind: expected .ply or .obj"),
        (
            {"scene": "spheres", "show_env": True},
            "lit by 3 points, which are no environment to show",
        ),
        ({"env": "sky.jpg"}, r"environment sky.jpg is of an unknown kind: expected .hdr or .exr"),
    ],
)
def test_what_cannot_be_rendered_is_refused_in_one_line(options, message):
    with pytest.raises(RenderError, match=message) as caught:
        Renderer(**options)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bad.ply", "no ply"),
        ("bad.obj", "v 1 2\nf 1 1 1\n"),
        ("none.obj", "v 0 0 0\n"),
        ("bad.hdr", "no hdr"),
        ("bad.exr", ""),
    ],
)
def test_a_damaged_file_is_refused_in_one_line(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    option = "mesh" if path.suffix in (".ply", ".obj") else "env"
    with pytest.raises(RenderError, match=name) as caught:
        Renderer(**{option: path})
    assert "\n" not in str(caught.value)
    assert not re.search(r"\[\w+\.(cpp|h):", str(caught.value))  # nothing of Mitsuba's inside


def test_the_studio_is_light_above_and_never_black():
    image = studio(64)
    assert image.shape == (64, 128, 3)
    assert image.dtype == np.float32
    assert image.min() > 0.1
    assert image[:32].mean() > image[32:].mean()


def test_the_middle_of_an_environment_looks_away_from_the_camera():
    d = directions(64)
    assert_allclose(d[32, 64], [0, 1, 0], atol=0.05)
    assert_allclose(d[32, 96], [1, 0, 0], atol=0.05)
    assert_allclose(d[0, 0], [0, 0, 1], atol=0.05)


def test_an_environment_lights_the_ground_as_the_studio_does():
    """A sky of radiance 1 lights the ground with pi."""
    sky = np.ones((32, 64, 3), np.float32)
    assert_allclose(_on_the_ground(sky), np.pi, rtol=0.01)
    assert_allclose(_on_the_ground(as_bright_as_the_studio(7 * sky)), _on_the_ground(studio(64)))
