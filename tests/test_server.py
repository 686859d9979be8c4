import importlib.util
import json
import threading
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from httpx import Response
from numpy.testing import assert_allclose, assert_array_equal
from patience import wait_until
from served import HOST, client_of, recipe_of

from halfway.library import ProceduralLibrary
from halfway.recipes import Blend
from halfway.server import create_app
from halfway.server.explorer import QUICK_PACES
from halfway.space import SPACES, Route, make_space
from halfway.tasks import Work

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def client(small_library: ProceduralLibrary) -> TestClient:
    return client_of(small_library)


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


# What it says of the library


def test_the_library_is_described(client: TestClient, small_library: ProceduralLibrary) -> None:
    summary = client.get("/api/library").json()
    assert summary["name"] == "small"
    assert [material["name"] for material in summary["materials"]] == list(small_library.names)
    assert [axis["size"] for axis in summary["grid"]] == [6, 5, 8]
    assert [space["name"] for space in summary["spaces"]] == list(SPACES)
    assert len(summary["lights"]) == 3


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


def test_a_leg_is_that_of_the_package(client: TestClient, small_library: ProceduralLibrary) -> None:
    leg = client.get("/api/legs/paper/material-0/material-4").json()
    route = Route.through(make_space("paper", small_library), ["material-0", "material-4"])
    used = [small_library.names.index(name) for name in leg["names"]]
    assert_allclose(leg["knots"], route.way.knots, rtol=0, atol=0)
    for c, channel in enumerate("rgb"):
        assert_array_equal(leg["weights"][channel], route.way.weights[c][:, used])
    assert set(leg["paces"]) == set(QUICK_PACES)
    paces = client.get("/api/legs/paper/material-0/material-4?pace=people").json()["paces"]
    # No way is shorter than how different its ends are.
    ends = {"library": "small", "weights": {"material-0": 1}}
    apart = client.post("/api/alike", json=ends).json()["distances"][4]
    assert paces["people"]["length"][-1] >= apart > 0
    for pace in paces.values():
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


def test_an_unknown_pace_is_refused(client: TestClient) -> None:
    answer = client.get("/api/legs/paper/material-0/material-4?pace=hurried")
    assert answer.status_code == 400
    assert "perceptual|people|uniform" in answer.json()["error"]


# Mixes


def test_an_unknown_blend_is_refused(client: TestClient) -> None:
    for answer in (
        client.post("/api/mix", json=recipe_of("median")),
        client.get("/api/spaces/paper?blend=median"),
    ):
        assert answer.status_code == 400
        assert answer.json()["error"].startswith("there is no blend 'median': expected linear")


# Taking a material home


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


# The page


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
