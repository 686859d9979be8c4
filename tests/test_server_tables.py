"""Tables and pictures as the page gets them."""

import numpy as np
import pytest
from fastapi.testclient import TestClient
from httpx import Response
from numpy.testing import assert_allclose, assert_array_equal
from served import HOST, client_of, recipe_of

from halfway.brdf import TabularBrdf
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.look import Looks
from halfway.look.small_tables import SmallTables
from halfway.recipes import Blend, Recipe, mix
from halfway.server import Explorer, Page, create_app
from halfway.server.blocks import Block
from halfway.server.drawable import drawn_grid
from halfway.server.page import Asset


@pytest.fixture(scope="module")
def client(small_library: ProceduralLibrary) -> TestClient:
    return client_of(small_library)


def halfs(body: bytes, shape: str) -> np.ndarray:
    return np.frombuffer(body, "<f2").reshape([int(n) for n in shape.split(",")])


def pictures(answer: Response) -> np.ndarray:
    """Linear RGB and whether there is something, of bytes with shared exponents."""
    shape = [int(n) for n in answer.headers["halfway-shape"].split(",")]
    block = np.frombuffer(answer.content, np.uint8).reshape(shape)
    exponent = block[..., 3:].astype(float)
    return np.concatenate([block[..., :3] * 2 ** (exponent - 136), exponent > 0], axis=-1)


def test_tables_that_depend_on_phi_h_are_sent_whole_and_taken_home_as_what_holds_them() -> None:
    grid = Grid.anisotropic(4, 6, 3, 4, period=np.pi)
    values = np.random.default_rng(0).random((3, *grid.shape)).astype(np.float16).astype(np.float32)
    brushes = ProceduralLibrary("brushes", {"a": TabularBrdf(values, grid)}, grid=grid)
    explorer = Explorer(brushes)
    summary = explorer.summary()
    assert [(axis.angle, axis.size) for axis in summary.grid] == [
        ("theta_h", 4), ("phi_h", 6), ("theta_d", 3), ("phi_d", 4)
    ]  # fmt: skip
    assert summary.notice == ""
    assert "merl" not in summary.exports
    assert "bsdf" in summary.exports
    sent = halfs(explorer.table("a").body, "4,6,3,4,4")
    assert_array_equal(sent[..., :3], np.moveaxis(values, 0, -1))


@pytest.mark.parametrize(
    ("grid", "expected"),
    [
        (Grid.anisotropic(), Grid.anisotropic()),
        (Grid.anisotropic(90, 360, 12, 40), Grid.anisotropic(64, 180, 12, 20)),
        (Grid.anisotropic(400, 20, 40, 40, period=np.pi), Grid.anisotropic(64, 20, 24, 20, period=np.pi)),
        (Grid.merl(), Grid.merl()),
        (Grid.merl(180, 180, 360), Grid.merl()),
    ],
    ids=str,
)  # fmt: skip
def test_a_table_that_takes_more_than_64_mb_on_a_card_is_drawn_on_no_more_than_the_usual_cells(
    grid: Grid, expected: Grid
) -> None:
    assert drawn_grid(grid) == expected
    assert 8 * drawn_grid(grid).size <= 64e6


def test_a_coarser_grid_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("halfway.server.drawable.MAX_BYTES", 1e5)
    grid = Grid.merl(4, 3, 1200)
    table = TabularBrdf(np.ones((3, *grid.shape), np.float32), grid)
    explorer = Explorer(ProceduralLibrary("fine", {"a": table}, grid=grid))
    assert explorer.table("a").shape == (4, 3, 180, 4)
    assert explorer.summary().grid[2].size == 180
    assert explorer.summary().notice.startswith("fine has tables of 4 x 3 x 1200 cells, 0 MB each")


def test_a_table_is_its_samples_times_a_scale(
    client: TestClient, small_library: ProceduralLibrary
) -> None:
    answer = client.get("/api/tables/material-3")
    block = halfs(answer.content, answer.headers["halfway-shape"])
    scale = [float(x) for x in answer.headers["halfway-scale"].split(",")]
    table = np.moveaxis(small_library.brdf("material-3").values, 0, -1)
    measured = ~np.isnan(table).any(axis=-1)
    assert_array_equal(block[..., 3], measured)
    assert_array_equal(block[~measured], 0)
    # 11 significant bits, rounded to nearest; below 2^-14 the steps are 2^-24.
    assert_allclose(block[measured][:, :3] * scale, table[measured], rtol=2**-11, atol=2**-25)


def test_a_table_that_half_floats_cannot_hold_is_scaled_by_a_power_of_two() -> None:
    grid = Grid.merl(2, 2, 2)
    values = np.full((3, *grid.shape), 1.0, np.float32)
    values[1, 0, 0, 0] = 300_000.0
    block = Block.of_table(TabularBrdf(values, grid))
    assert block.scale == (1.0, 8.0, 1.0)
    assert 8.0 * float(halfs(block.body, "2,2,2,4")[0, 0, 0, 1]) == pytest.approx(
        300_000.0, rel=2**-11
    )


def test_a_table_that_the_browser_has_is_not_sent_again(client: TestClient) -> None:
    first = client.get("/api/tables/material-0")
    again = client.get("/api/tables/material-0", headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


@pytest.mark.parametrize("what", ["tables/material-3", "thumbnails", "environment"])
def test_what_is_large_is_compressed_and_kept_by_its_content(client: TestClient, what: str) -> None:
    plain = client.get(f"/api/{what}", headers={"Accept-Encoding": "identity"})
    packed = client.get(f"/api/{what}", headers={"Accept-Encoding": "gzip"})
    assert packed.headers["content-encoding"] == "gzip"
    assert packed.content == plain.content
    assert int(packed.headers["content-length"]) < len(plain.content)
    again = client.get(f"/api/{what}", headers={"If-None-Match": plain.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_files_named_after_their_content_are_never_asked_for_again(
    small_library: ProceduralLibrary,
) -> None:
    page = Page(
        {name: Asset(b"1", "text/javascript", '"1"') for name in ("index.html", "assets/a-1b.js")}
    )
    client = TestClient(create_app(small_library, page=page), base_url=HOST)
    assert "immutable" in client.get("/assets/a-1b.js").headers["cache-control"]
    assert client.get("/").headers["cache-control"] == "no-cache"


def test_thumbnails_are_the_basis_images(
    client: TestClient, small_library: ProceduralLibrary
) -> None:
    looks = Looks.fit(small_library)
    block = pictures(client.get("/api/thumbnails"))
    assert block.shape == (9, 64, 64, 4)
    mask = looks.scene.mask()
    assert_array_equal(block[..., 3], np.broadcast_to(mask, block.shape[:-1]))
    images = looks.images.clip(0)
    # A step of the brightest channel's mantissa, which is at least 128 of 256.
    step = images.max(axis=-1, keepdims=True) / 128
    assert (np.abs(block[:, mask, :3] - images) <= step + 2.0**-136).all()
    assert (block[:, ~mask] == 0).all()


@pytest.mark.parametrize("blend", Blend)
def test_the_table_of_a_recipe_is_the_mixer_s_to_half_precision(
    client: TestClient, small_library: ProceduralLibrary, blend: Blend
) -> None:
    answer = client.post("/api/mix", json=recipe_of(blend))
    block = halfs(answer.content, answer.headers["halfway-shape"])
    scale = [float(x) for x in answer.headers["halfway-scale"].split(",")]
    mixed = mix(small_library, Recipe.from_json(recipe_of(blend)))
    table = np.moveaxis(mixed.values, 0, -1)
    measured = ~np.isnan(table).any(axis=-1)
    assert_array_equal(block[..., 3], measured)
    assert_allclose(block[measured][:, :3] * scale, table[measured], rtol=2**-11, atol=2**-25)


def test_a_small_table_of_a_recipe_has_the_small_grid_and_its_values(
    client: TestClient, small_library: ProceduralLibrary
) -> None:
    answer = client.post("/api/mix?small=true", json=recipe_of("lobes"))
    block = halfs(answer.content, answer.headers["halfway-shape"])
    axes = client.get("/api/library").json()["small_grid"]
    assert block.shape == (*(axis["size"] for axis in axes), 4)
    scale = [float(x) for x in answer.headers["halfway-scale"].split(",")]
    weights = np.zeros((3, 1, len(small_library)))
    weights[..., [1, 2, 5]] = 0.25, 0.5, 0.25
    (table,) = SmallTables(small_library).mix(weights, Blend.LOBES).swapaxes(0, 1)
    got = np.moveaxis(block[..., :3] * scale, -1, 0).reshape(3, -1)
    assert_allclose(got, table, rtol=2**-11, atol=2**-25)


def test_pictures_of_recipes_are_those_of_the_pacing(client: TestClient) -> None:
    all_pictures = pictures(client.get("/api/thumbnails"))
    alone = {"library": "small", "weights": {"material-3": 1}}
    answer = client.post("/api/thumbnails", json=[alone, recipe_of("linear"), recipe_of("lobes")])
    own, linear, lobes = pictures(answer)
    assert_array_equal(own, all_pictures[3])
    shares = np.array([0.25, 0.5, 0.25])
    summed = np.tensordot(shares, all_pictures[[1, 2, 5]], axes=1)
    # A step of each one's brightest channel, and of the sum's.
    brightest = all_pictures.max(axis=-1, keepdims=True)
    steps = np.tensordot(shares, brightest[[1, 2, 5]], axes=1) + summed.max(axis=-1, keepdims=True)
    assert (np.abs(linear - summed) <= steps / 128).all()
    assert np.abs(lobes - linear).max() > 2**-6
    assert client.post("/api/thumbnails", json=[]).status_code == 400
