"""Basis images: pictures of a small lit sphere that mix as tables do."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from halfway.brdf import TabularBrdf, directional_albedo, tabulate
from halfway.halfdiff import Grid
from halfway.library import LibraryRef, ProceduralLibrary
from halfway.look import JUDGING_SCENE, PACING_SCENE, Looks, SphereOperator, SphereScene
from halfway.look.lit_sphere import N_SKY_NODES, Light, Sky
from halfway.models import AbcModel
from halfway.recipes import Blend, Recipe
from halfway.tasks import Work

GRID = Grid.merl(20, 12, 24)
NO_SKY = Sky((0.0, 1.0, 0.0), 0.0, 0.0)
SMALL = SphereScene(
    "small",
    (Light((1.0, 2.0, 2.0), 3.0), Light((-1.0, 0.0, -0.5), 2.0)),
    Sky((0.3, 0.9, 0.1), 0.7, 0.1),
    size=8,
    n_points=2,
)


def constant_row(value: float, grid: Grid = GRID) -> np.ndarray:
    row = np.where(grid.mask().ravel(), value, np.nan).astype(np.float32)
    return np.stack([row] * 3)


def glossy(roughness: float, red: float = 0.4) -> AbcModel:
    return AbcModel(np.array([red, 0.2, 0.1]), np.array([0.5, 0.5, 0.5]), 1 / roughness, 1.5, 1.4)


@pytest.fixture(scope="module")
def library() -> ProceduralLibrary:
    brdfs = {f"m{i}": tabulate(glossy(0.1 * 2**i, red=0.1 * i), GRID) for i in range(4)}
    return ProceduralLibrary("four", brdfs, grid=GRID)


@pytest.fixture(scope="module")
def images(library: ProceduralLibrary) -> Looks:
    return Looks.fit(library, SMALL)


def test_a_matte_sphere_under_one_light_is_the_cosine():
    """A white matte surface reflects E cos / pi; the pixel is the mean over its points."""
    scene = dataclasses.replace(SMALL, lights=(Light((0.0, 0.0, 5.0), math.pi),), sky=NO_SKY)
    row = SphereOperator.of(scene, GRID).picture(constant_row(1 / math.pi))
    x, y = np.meshgrid(*[(np.arange(16) + 0.5) / 8 - 1] * 2)
    outside = x**2 + y**2 >= 1
    z = np.ma.array(np.sqrt(np.clip(1 - x**2 - y**2, 0, 1)), mask=outside)
    expected = z.reshape(8, 2, 8, 2).mean(axis=(1, 3))
    assert (scene.mask() == ~expected.mask).all()
    assert_allclose(row, expected.compressed()[:, None].repeat(3, 1), rtol=1e-6)


def test_the_first_row_is_on_top():
    scene = dataclasses.replace(SMALL, lights=(Light((0.0, 1.0, 0.0), 1.0),), sky=NO_SKY)
    picture = np.zeros((8, 8))
    picture[scene.mask()] = SphereOperator.of(scene, GRID).picture(constant_row(1.0))[:, 0]
    assert picture[:4].sum() > 0
    assert picture[4:].sum() == 0


def test_under_parallel_light_a_picture_is_the_table_evaluated_point_by_point():
    """The same values as `TabularBrdf.eval`, holes included."""
    scene = dataclasses.replace(SMALL, sky=NO_SKY, n_points=1)
    table = tabulate(glossy(0.2), GRID).values.copy()
    table[:, :, 3:5, ::2] = np.nan
    brdf = TabularBrdf(table, GRID)
    position = (np.arange(8) + 0.5) / 4 - 1
    x, y = np.meshgrid(position, -position)
    x, y = x[scene.mask()], y[scene.mask()]
    normal = np.stack([x, y, np.sqrt(1 - x**2 - y**2)], axis=-1)
    expected = np.zeros((len(x), 3))
    for light in scene.lights:
        to_light = np.array(light.direction) / np.linalg.norm(light.direction)
        wi, wo = in_frame(normal, to_light), in_frame(normal, np.array([0.0, 0.0, 1.0]))
        values = np.nan_to_num(brdf.eval(wi, wo))
        expected += light.irradiance * np.clip(wi[:, 2:], 0, None) * values
    actual = SphereOperator.of(scene, GRID).picture(table.reshape(3, -1))
    # float32 weights and values, sums of a few dozen terms of like size.
    assert_allclose(actual, expected, rtol=1e-5, atol=1e-5 * expected.max())


def in_frame(normal: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """The direction in some frame with each normal as z."""
    tangent = np.cross(normal, [0.0, 0.6, 0.8])
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    axes = np.stack([tangent, np.cross(normal, tangent), normal], axis=-2)
    return axes @ direction


def test_under_an_even_sky_a_pixel_is_the_albedo():
    """Radiance 1 from everywhere: by reciprocity what comes back is the directional albedo towards the viewer."""
    scene = SphereScene("even", (), Sky((0.0, 0.0, 1.0), 1.0, 1.0), size=9, n_points=1)
    brdf = tabulate(glossy(0.3), GRID)
    actual = SphereOperator.of(scene, GRID).picture(brdf.values.reshape(3, -1))
    position = (np.arange(9) + 0.5) / 4.5 - 1
    sin = np.hypot(*np.meshgrid(position, position))[scene.mask()]
    theta = np.arcsin(sin)
    expected = directional_albedo(brdf, theta, n_theta_h=90, n_phi_h=64)
    # Linear between nodes h apart: h^2/8 of the second derivative, which towards the horizon is of order 10.
    h = math.pi / 2 / N_SKY_NODES
    assert_allclose(actual, expected, atol=10 * h**2 / 8)


def test_a_sky_brighter_above_lights_the_top():
    scene = SphereScene("above", (), Sky((0.0, 1.0, 0.0), 1.0, 0.0), size=16, n_points=2)
    picture = np.zeros((16, 16))
    picture[scene.mask()] = SphereOperator.of(scene, GRID).picture(constant_row(1 / math.pi))[:, 0]
    # A matte surface sees (1 + 2/3 up . n) / 2 of it.
    assert_allclose(picture[0, 7], (1 + 2 / 3 * 15 / 16) / 2, atol=0.02)
    assert_allclose(picture + picture[::-1], scene.mask() * 1.0, atol=0.01)
    assert_allclose(picture, picture[:, ::-1], atol=1e-5)


@pytest.mark.parametrize("scene", [PACING_SCENE, JUDGING_SCENE])
def test_a_white_matte_sphere_just_reaches_white(scene: SphereScene):
    picture = SphereOperator.of(dataclasses.replace(scene, n_points=1), GRID).picture(
        constant_row(1 / math.pi)
    )
    assert 0.95 < picture.max() <= 1.02


def test_the_two_scenes_share_no_light():
    assert not {light.direction for light in PACING_SCENE.lights} & {
        light.direction for light in JUDGING_SCENE.lights
    }
    assert PACING_SCENE.fingerprint() != JUDGING_SCENE.fingerprint()


@settings(deadline=None, max_examples=10)
@given(st.lists(st.floats(0.01, 1), min_size=12, max_size=12))
def test_the_picture_of_a_mix_is_the_mix_of_the_pictures(
    library: ProceduralLibrary, images: Looks, numbers: list[float]
):
    weights = np.array(numbers).reshape(3, 4)
    weights /= weights.sum(axis=1, keepdims=True)
    row = np.einsum("cn,ncp->cp", weights, np.stack([library.row(i) for i in range(4)]))
    picture = SphereOperator.of(SMALL, GRID).picture(row.astype(np.float32))
    assert_allclose(images.mix(weights, Blend.LINEAR), picture, rtol=1e-5, atol=1e-6)


def test_one_material_alone_is_its_own_picture(images: Looks):
    for i, alone in enumerate(np.eye(4)):
        assert (images.mix(np.stack([alone] * 3), Blend.LINEAR) == images.images[i]).all()


def test_mixing_keeps_the_axes_between(images: Looks):
    weights = np.random.default_rng(1).dirichlet(np.ones(4), (3, 5, 2))
    together = images.mix(weights, Blend.LINEAR)
    assert together.shape == (5, 2, images.planes.shape[-1], 3)
    assert_allclose(together[3, 1], images.mix(weights[:, 3, 1], Blend.LINEAR), rtol=1e-6)


def test_a_picture_is_square_and_black_beside_the_sphere(images: Looks):
    weights = np.full((3, 4), 0.25)
    picture = images.picture(Recipe(LibraryRef("x"), images.names, weights))
    mask = SMALL.mask()
    assert picture.shape == (8, 8, 3)
    assert (picture[mask] == images.mix(weights, Blend.LINEAR)).all()
    assert not picture[~mask].any()


def test_a_cache_gives_the_same_pictures_and_knows_the_scene(library: ProceduralLibrary, tmp_path):
    first = Looks.fit(library, SMALL, work=Work(cache=tmp_path))
    again = Looks.fit(library, SMALL, work=Work(cache=tmp_path))
    assert len(list(tmp_path.iterdir())) == 1
    assert (first.planes == again.planes).all()
    brighter = dataclasses.replace(SMALL, lights=(Light((1.0, 2.0, 2.0), 6.0), *SMALL.lights[1:]))
    other = Looks.fit(library, brighter, work=Work(cache=tmp_path))
    assert other.planes.sum() > first.planes.sum()
