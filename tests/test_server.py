import importlib.util
import json
import socket
import threading
import urllib.request
from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from urllib.parse import unquote
from zipfile import ZipFile

import numpy as np
import pytest
from fastapi.testclient import TestClient
from httpx import Response
from numpy.testing import assert_allclose, assert_array_equal
from patience import PATIENCE, wait_until

from halfway.brdf import TabularBrdf
from halfway.formats import write_merl
from halfway.formats.rgl_writer import Resolution
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.look import Looks
from halfway.look.small_tables import SmallTables
from halfway.recipes import Blend, Recipe, mix
from halfway.server import Explorer, Page, create_app, taking
from halfway.server.blocks import Block
from halfway.server.drawable import drawn_grid
from halfway.server.explorer import PACES
from halfway.server.guard import MAX_BODY
from halfway.server.page import Asset
from halfway.space import SPACES, Route, make_space
from halfway.tasks import Work

ROOT = Path(__file__).parents[1]
HOST = "http://127.0.0.1:8765"
PAGE = Page({"index.html": Asset(b"<!doctype html>", "text/html; charset=utf-8", '"1"')})


@pytest.fixture(scope="module")
def client(small_library: ProceduralLibrary) -> TestClient:
    return TestClient(create_app(small_library, page=PAGE), base_url=HOST)


def script(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


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


# What it says of the library


def test_the_library_is_described(client: TestClient, small_library: ProceduralLibrary) -> None:
    summary = client.get("/api/library").json()
    assert summary["name"] == "small"
    assert [material["name"] for material in summary["materials"]] == list(small_library.names)
    assert [axis["size"] for axis in summary["grid"]] == [6, 5, 8]
    assert [space["name"] for space in summary["spaces"]] == list(SPACES)
    assert len(summary["lights"]) == 3


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


def test_what_takes_long_is_answered_with_how_far_it_is(small_library: ProceduralLibrary) -> None:
    go_on = threading.Event()

    def halting(items: Iterable[Any], label: str, total: int) -> Iterator[Any]:  # noqa: ARG001
        for item in items:
            yield item
            go_on.wait()

    app = create_app(small_library, work=Work(track=halting), patience=0.01)
    client = TestClient(app, base_url=HOST)
    try:
        assert client.get("/api/library").status_code == 200
        # The first of nine pictures is drawn, and counted, some time after it was asked for.
        wait_until(
            lambda: (
                (answer := client.get("/api/thumbnails").json())["progress"]
                and answer["progress"]["done"]
            )
        )
        answer = client.get("/api/thumbnails")
        assert answer.status_code == 202
        progress = answer.json()["progress"]
        assert (progress["done"], progress["total"]) == (1, 9)
    finally:
        go_on.set()
    wait_until(lambda: client.get("/api/thumbnails").status_code == 200)


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


def test_a_leg_is_that_of_the_package(client: TestClient, small_library: ProceduralLibrary) -> None:
    leg = client.get("/api/legs/paper/material-0/material-4").json()
    route = Route.through(make_space("paper", small_library), ["material-0", "material-4"])
    used = [small_library.names.index(name) for name in leg["names"]]
    assert_allclose(leg["knots"], route.way.knots, rtol=0, atol=0)
    for c, channel in enumerate("rgb"):
        assert_array_equal(leg["weights"][channel], route.way.weights[c][:, used])
    assert set(leg["paces"]) == set(PACES)
    for pace in leg["paces"].values():
        assert (pace["t"][0], pace["t"][-1], pace["length"][0]) == (0, 1, 0)
        assert (np.diff(pace["t"]) > 0).all()
        assert (np.diff(pace["length"]) > 0).all()


@pytest.mark.parametrize("space", SPACES)
def test_every_space_can_be_looked_at(
    client: TestClient, small_library: ProceduralLibrary, space: str
) -> None:
    view = client.get(f"/api/spaces/{space}").json()
    for embedding in view["embeddings"]:
        assert len(embedding["points"]) == len(small_library)
        assert {i for edge in embedding["edges"] for i in edge} <= set(range(len(small_library)))


def test_what_is_furthest_in_any_direction_is_a_corner_of_the_hull(client: TestClient) -> None:
    rng = np.random.default_rng(5)
    for space in ("anchored", "paper"):
        for embedding in client.get(f"/api/spaces/{space}").json()["embeddings"]:
            # The first three coordinates are looked at.
            points = np.array(embedding["points"])[:, :3]
            directions = rng.normal(size=(points.shape[1], 200)) / np.ptp(points, axis=0)[:, None]
            corners = {i for edge in embedding["edges"] for i in edge}
            assert set((points @ directions).argmax(axis=0)) <= corners


@pytest.mark.parametrize("blend", Blend)
def test_a_space_is_answered_for_in_the_blend_that_is_named(
    client: TestClient, small_library: ProceduralLibrary, blend: Blend
) -> None:
    space = make_space("anchored", small_library, blend=blend)
    view = client.get(f"/api/spaces/anchored?blend={blend}").json()
    points = np.hstack([embedding["points"] for embedding in view["embeddings"]])
    assert_allclose(points, space.points, rtol=1e-6, atol=1e-9)
    leg = client.get(f"/api/legs/anchored/material-0/material-4?blend={blend}").json()
    assert_allclose(leg["knots"], Route.through(space, ["material-0", "material-4"]).way.knots)
    point = {"space": "anchored", "blend": blend, "point": space.points[:6].mean(axis=0).tolist()}
    recipe = client.post("/api/position", json=point).json()["recipe"]
    assert recipe["blend"] == blend


def test_without_a_blend_a_space_is_in_its_usual_one(client: TestClient) -> None:
    for space in client.get("/api/library").json()["spaces"]:
        view = client.get(f"/api/spaces/{space['name']}").json()
        named = client.get(f"/api/spaces/{space['name']}?blend={space['usual_blend']}").json()
        assert view == named


def test_the_point_of_a_material_is_that_material(client: TestClient) -> None:
    for space in ("anchored", "paper"):
        embeddings = client.get(f"/api/spaces/{space}").json()["embeddings"]
        point = [x for embedding in embeddings for x in embedding["points"][4]]
        view = client.post("/api/position", json={"space": space, "point": point}).json()
        assert view["recipe"]["weights"] == {"material-4": 1.0}
        assert view["inside"]
        assert_allclose(view["point"], point)


def test_a_point_outside_is_answered_by_the_nearest_mix(client: TestClient) -> None:
    embeddings = client.get("/api/spaces/anchored").json()["embeddings"]
    point = [100 * x + 1 for embedding in embeddings for x in embedding["points"][0]]
    view = client.post("/api/position", json={"space": "anchored", "point": point}).json()
    assert not view["inside"]
    assert sum(view["recipe"]["weights"].values()) == pytest.approx(1)


def test_outside_the_paper_s_hulls_each_channel_takes_its_nearest_mix(
    client: TestClient, small_library: ProceduralLibrary
) -> None:
    embeddings = client.get("/api/spaces/paper").json()["embeddings"]
    corner = [np.array(embedding["points"])[4] for embedding in embeddings]
    asked = [*corner[0], *corner[1], *(corner[2] + 1e3)]
    found = client.post("/api/position", json={"space": "paper", "point": asked}).json()
    assert not found["inside"]
    weights = found["recipe"]["weights"]
    assert weights["r"] == {"material-4": 1.0}
    assert weights["g"] == {"material-4": 1.0}
    assert sum(weights["b"].values()) == pytest.approx(1)
    # What is reached is the mix of the points.
    blue = np.array(embeddings[2]["points"])
    names = list(small_library.names)
    mixed = sum(w * blue[names.index(name)] for name, w in weights["b"].items())
    assert_allclose(found["point"][6:], mixed, rtol=1e-9)


def test_the_linear_space_has_no_points_to_go_to(client: TestClient) -> None:
    answer = client.post("/api/position", json={"space": "linear", "point": [0, 0, 0]})
    assert answer.status_code == 400


# Mixes


def recipe_of(blend: str) -> dict[str, Any]:
    weights = {"material-1": 0.25, "material-2": 0.5, "material-5": 0.25}
    return {"library": "small", "blend": blend, "weights": weights}


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


def test_an_unknown_blend_is_refused(client: TestClient) -> None:
    for answer in (
        client.post("/api/mix", json=recipe_of("median")),
        client.get("/api/spaces/paper?blend=median"),
    ):
        assert answer.status_code == 400
        assert answer.json()["error"].startswith("there is no blend 'median': expected linear")


# Taking a material home


def test_a_downloaded_file_is_mixed_as_its_recipe_says(
    client: TestClient, small_library: ProceduralLibrary, tmp_path: Path
) -> None:
    answer = client.post("/api/export/merl", json=recipe_of("lobes"))
    write_merl(tmp_path / "mixed.binary", mix(small_library, Recipe.from_json(recipe_of("lobes"))))
    assert answer.content == (tmp_path / "mixed.binary").read_bytes()


def test_the_downloaded_file_is_the_written_one(
    client: TestClient, small_library: ProceduralLibrary, tmp_path: Path
) -> None:
    weights = {
        "r": {"material-1": 1.0},
        "g": {"material-1": 0.25, "material-2": 0.75},
        "b": {"material-5": 1.0},
    }
    answer = client.post("/api/export/merl", json={"library": "small", "weights": weights})
    write_merl(tmp_path / "mixed.binary", mix(small_library, Recipe.of("small", weights)))
    assert answer.content == (tmp_path / "mixed.binary").read_bytes()


def test_a_material_goes_home_to_mitsuba_too(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("halfway.formats.rgl_writer.RESOLUTIONS", [Resolution(8, 8)])
    answer = client.post(
        "/api/export/bsdf", json={"library": "small", "weights": {"material-1": 1}}
    )
    assert answer.content.startswith(b"tensor_file\0")


def test_an_unknown_format_is_refused(client: TestClient) -> None:
    answer = client.post(
        "/api/export/gltf", json={"library": "small", "weights": {"material-1": 1}}
    )
    assert answer.status_code == 400
    assert "expected merl, bsdf, mtlx, glb" in answer.json()["error"]


def test_a_fit_says_how_far_off_it_is(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    # Fitting takes seconds, and has its own tests.
    monkeypatch.setattr(taking, "fit", lambda *_: SimpleNamespace(summary="off by 3.9% ±"))
    monkeypatch.setattr(taking, "write_fit", lambda path, _: path.write_bytes(b"<materialx>"))
    answer = client.post(
        "/api/export/mtlx", json={"library": "small", "weights": {"material-1": 1}}
    )
    assert answer.content == b"<materialx>"
    assert unquote(answer.headers["halfway-summary"]) == "off by 3.9% ±"


def test_a_scene_is_a_zip_of_its_folder(client: TestClient) -> None:
    answer = client.post(
        "/api/export/pbrt-v4", json={"library": "small", "weights": {"material-1": 1}}
    )
    with ZipFile(BytesIO(answer.content)) as archive:
        assert {"scene.pbrt", "material.bsdf"} <= set(archive.namelist())


def test_a_measurement_becomes_a_material(small_library: ProceduralLibrary, tmp_path: Path) -> None:
    client = TestClient(create_app(small_library), base_url=HOST)
    refused = client.post("/api/materials/notes.binary", content=b"nothing")
    assert refused.status_code == 400
    assert refused.json()["error"].startswith("notes.binary ")
    before = client.get("/api/tables/material-1").headers["etag"]
    write_merl(tmp_path / "scan.binary", small_library.brdf("material-2"))
    content = (tmp_path / "scan.binary").read_bytes()
    assert client.post("/api/materials/scan.binary", content=content).json() == {"name": "scan"}
    assert client.post("/api/materials/scan.binary", content=content).json()["name"] == "scan (2)"
    summary = client.get("/api/library").json()
    assert [each["name"] for each in summary["materials"]][-2:] == ["scan", "scan (2)"]
    own, theirs = (client.get(f"/api/tables/{name}") for name in ("scan", "material-2"))
    assert own.content == theirs.content
    assert own.headers["etag"] != before


def test_a_recipe_of_another_library_is_refused(client: TestClient) -> None:
    answer = client.post(
        "/api/export/merl", json={"library": "other", "weights": {"material-1": 1}}
    )
    assert answer.status_code == 400
    assert "'other'" in answer.json()["error"]


# Mistakes


@pytest.mark.parametrize(
    ("path", "status", "said"),
    [
        ("/api/tables/material-77", 400, "'material-77' is not one of the 9 materials"),
        ("/api/tables/..%2F..%2Fetc%2Fpasswd", 404, "nothing this server answers"),
        ("/../../pyproject.toml", 404, "nothing this server answers"),
        ("/api/spaces/cubic", 400, "there is no space 'cubic'"),
        ("/api/legs/paper/material-1/material-77", 400, "'material-77' is not a material"),
        ("/api/legs/paper/material-1/material-1", 400, "follows itself"),
        ("/api/nothing", 404, "nothing this server answers"),
    ],
)
def test_a_mistake_is_one_line(client: TestClient, path: str, status: int, said: str) -> None:
    answer = client.get(path)
    assert answer.status_code == status
    assert list(answer.json()) == ["error"]
    assert said in answer.json()["error"]
    assert "\n" not in answer.json()["error"]


@pytest.mark.parametrize(
    "recipe",
    [
        {"library": "small", "weights": {"material-1": -1, "material-2": 2}},
        {"library": "small", "weights": {"material-1": 0.5}},
        {"library": "small", "weights": {"material-99": 1}},
        {"library": "small"},
        [],
        {"library": "small", "weights": {"r": {"material-1": 1}}},
    ],
)
def test_what_is_no_recipe_is_refused(client: TestClient, recipe: object) -> None:
    answer = client.post("/api/export/merl", json=recipe)
    assert answer.status_code == 400
    assert answer.json()["error"]


def test_another_name_for_this_machine_is_refused(client: TestClient) -> None:
    answer = client.get("/api/library", headers={"Host": "attacker.example:8765"})
    assert answer.status_code == 421
    assert "attacker.example" in answer.json()["error"]


def test_a_page_of_another_origin_is_refused(client: TestClient) -> None:
    assert client.get("/api/library", headers={"Origin": HOST}).status_code == 200
    assert (
        client.get("/api/library", headers={"Origin": "https://attacker.example"}).status_code
        == 403
    )
    assert client.get("/api/library", headers={"Origin": "null"}).status_code == 403


def test_a_request_that_is_too_large_is_refused(client: TestClient) -> None:
    answer = client.post("/api/export/merl", content=b" " * (MAX_BODY + 1))
    assert answer.status_code == 413


def test_a_fault_of_ours_is_one_line_too(
    small_library: ProceduralLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = TestClient(create_app(small_library), base_url=HOST, raise_server_exceptions=False)
    monkeypatch.setattr(ProceduralLibrary, "row", lambda *_: 1 / 0)
    answer = client.get("/api/tables/material-5")
    assert answer.status_code == 500
    assert "ZeroDivisionError" in answer.json()["error"]


# The page


def test_the_page_runs_only_its_own_code(client: TestClient) -> None:
    answer = client.get("/")
    assert answer.content == PAGE.assets["index.html"].body
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self'" in policy
    assert "unsafe" not in policy


def test_it_is_served_over_http_until_stopped(small_library: ProceduralLibrary) -> None:
    import uvicorn

    from halfway.server.run import listen

    with listen(0) as listener:
        config = uvicorn.Config(create_app(small_library, page=PAGE), log_level="error")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, args=([listener],), daemon=True)
        thread.start()
        address = f"http://127.0.0.1:{listener.getsockname()[1]}/"
        with urllib.request.urlopen(address, timeout=PATIENCE) as answer:
            assert answer.read() == b"<!doctype html>"
        server.should_exit = True
        thread.join(PATIENCE)
        assert not thread.is_alive()


def test_a_port_that_is_taken_is_replaced_by_a_free_one() -> None:
    from halfway.server.run import listen

    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with listen(port) as listener:
            assert listener.getsockname()[1] != port


# What is written for the other side


def test_the_typescript_types_are_current() -> None:
    make_types = script(ROOT / "viewer" / "scripts" / "make_types.py")
    assert make_types.TARGET.read_text() == make_types.types(), (
        "run python viewer/scripts/make_types.py"
    )


def test_the_golden_values_are_current() -> None:
    make_golden = script(ROOT / "tests" / "golden" / "make_golden.py")
    for name, document in make_golden.golden().items():
        committed = json.loads((ROOT / "tests" / "golden" / f"{name}.json").read_text())
        assert_same(committed, json.loads(json.dumps(document)))


def assert_same(a: object, b: object) -> None:
    """Equal, numbers to rounding: another machine's sine may differ in the last digit."""
    assert type(a) is type(b)
    if isinstance(a, dict) and isinstance(b, dict):
        assert a.keys() == b.keys()
        for key in a:
            assert_same(a[key], b[key])
    elif isinstance(a, list) and isinstance(b, list):
        assert len(a) == len(b)
        for x, y in zip(a, b, strict=True):
            assert_same(x, y)
    elif isinstance(a, float):
        assert a == pytest.approx(b, rel=1e-9, abs=1e-12)
    else:
        assert a == b
