"""Pictures of recipes from pictures of materials."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from halfway.brdf import TabularBrdf
from halfway.errors import RenderError
from halfway.halfdiff import Grid
from halfway.library import LibraryRef
from halfway.recipes import Recipe
from halfway.render import BasisPictures, Renderer
from halfway.tasks import Work

GRID = Grid.merl(12, 10, 12)
RNG = np.random.default_rng(5)
TABLES = {
    name: TabularBrdf((RNG.random((3, *GRID.shape)) * scale).astype(np.float32), GRID, name=name)
    for name, scale in [("dark", 0.1), ("light", 0.4), ("bright", 2.0)]
}
NAMES = tuple(TABLES)
WEIGHTS = np.array([[0.2, 0.8, 0.0], [1.0, 0.0, 0.0], [0.3, 0.3, 0.4]])


def recipe(weights: np.ndarray) -> Recipe:
    return Recipe(LibraryRef("three"), NAMES, weights)


@pytest.fixture(scope="module")
def renderer() -> Renderer:
    return Renderer("teapot", size=(40, 32), spp=64)


def test_a_recipe_of_one_material_is_its_picture(renderer):
    basis = BasisPictures(renderer, TABLES.__getitem__)
    alone = np.array([[0.0, 1.0, 0.0]] * 3)
    assert_allclose(basis.picture(recipe(alone)), renderer.picture(TABLES["light"]), rtol=1e-6)


def test_the_picture_of_a_recipe_is_that_of_its_mix(renderer):
    """Equal to a render of the mixed table to Monte Carlo noise: the samples follow another density."""
    basis = BasisPictures(renderer, TABLES.__getitem__)
    mixed = sum(
        WEIGHTS[:, i].astype(np.float32)[:, None, None, None] * TABLES[name].values
        for i, name in enumerate(NAMES)
    )
    full = renderer.picture(TabularBrdf(mixed, GRID))
    got = basis.picture(recipe(WEIGHTS))
    assert got.dtype == np.float32
    assert_allclose(got.mean(axis=(0, 1)), full.mean(axis=(0, 1)), rtol=0.005)
    assert np.abs(got - full).mean() < 0.02 * full.mean()


def test_each_material_is_rendered_once(renderer):
    asked: list[str] = []

    def table(name: str) -> TabularBrdf:
        asked.append(name)
        return TABLES[name]

    basis = BasisPictures(renderer, table)
    basis.render(NAMES)
    for t in np.linspace(0, 1, 5):
        basis.picture(recipe((1 - t) * WEIGHTS + t * WEIGHTS[[1, 2, 0]]))
    assert asked == list(NAMES)


def test_pictures_are_kept_between_runs_by_scene_and_material(renderer, tmp_path):
    first = BasisPictures(renderer, TABLES.__getitem__, work=Work(cache=tmp_path)).picture(
        recipe(WEIGHTS)
    )
    kept = {path: path.stat().st_ino for path in tmp_path.iterdir()}
    assert len(kept) == len(NAMES)
    again = BasisPictures(renderer, TABLES.__getitem__, work=Work(cache=tmp_path)).picture(
        recipe(WEIGHTS)
    )
    assert_array_equal(again, first)
    assert {path: path.stat().st_ino for path in tmp_path.iterdir()} == kept
    other = {"dark": TABLES["bright"]}
    BasisPictures(renderer, other.__getitem__, work=Work(cache=tmp_path)).render(["dark"])
    assert len(list(tmp_path.iterdir())) == len(NAMES)  # the same table under another name


def test_another_scene_or_sampling_has_another_fingerprint(tmp_path):
    options = {"size": (16, 16), "spp": 4}
    env = tmp_path / "env.hdr"
    env.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + bytes([128] * 8))
    renderers = [
        Renderer("sphere", **options),
        Renderer("spheres", **options),
        Renderer("sphere", size=(16, 17), spp=4),
        Renderer("sphere", size=(16, 16), spp=5),
        Renderer("sphere", seed=1, **options),
        Renderer("sphere", denoise=True, **options),
        Renderer("teapot", **options),
        Renderer("teapot", env=env, **options),
    ]
    prints = {renderer.fingerprint() for renderer in renderers}
    assert len(prints) == len(renderers)
    assert Renderer("sphere", **options).fingerprint() in prints


def test_bouncing_light_does_not_mix():
    with pytest.raises(RenderError, match="bounces 5 times in this trio"):
        BasisPictures(Renderer("trio", size=(8, 8), spp=1), TABLES.__getitem__)


def test_memory_is_bounded(renderer, monkeypatch):
    monkeypatch.setattr("halfway.render.basis.MEMORY", 2 * 12 * 40 * 32)
    asked: list[str] = []

    def table(name: str) -> TabularBrdf:
        asked.append(name)
        return TABLES[name]

    basis = BasisPictures(renderer, table)
    basis.render([*NAMES, "dark"])
    assert asked == list(NAMES)
    basis.render(["dark"])
    assert asked[-1] == "dark"
