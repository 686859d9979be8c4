"""The widget without a browser: its traits, and the messages that it answers."""

import asyncio
import json
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from fastapi.testclient import TestClient
from patience import PATIENCE

from halfway.errors import HalfwayError, LibraryError, RecipeError, SpaceError
from halfway.library import Library
from halfway.notebook import Explorer
from halfway.notebook.messages import Answerer
from halfway.server.app import app_of
from halfway.server.explorer import Explorer as Answers
from halfway.server.schema import Point
from halfway.tasks import Work

ENDS = ["material-0", "material-4"]


@pytest.fixture(scope="module")
def answers(small_library: Library) -> Answers:
    return Answers(small_library)


@pytest.fixture
def explorer(small_library: Library) -> Explorer:
    return Explorer(small_library, ENDS, space="linear", pace="uniform", work=Work())


def test_the_recipe_follows_the_place(explorer: Explorer) -> None:
    seen: list[dict[str, float]] = []
    explorer.observe(lambda change: seen.append(change.new.to_json()["weights"]), "recipe")
    explorer.t = 0.25
    explorer.stops = ["material-1", "material-2", "material-3"]
    assert seen == [
        {"material-0": 0.75, "material-4": 0.25},
        {"material-1": 0.5, "material-2": 0.5},
    ]
    assert explorer.route.stops == ("material-1", "material-2", "material-3")


def test_at_a_free_place_the_recipe_is_that_of_the_space(
    explorer: Explorer, answers: Answers
) -> None:
    explorer.space = "anchored"
    explorer.blend = "lobes"
    middle = answers.space("anchored").points.mean(axis=0).tolist()  # pyright: ignore
    explorer.point = middle
    place = answers.position(Point(space="anchored", point=middle))
    assert explorer.recipe.blend == place.recipe.blend == "lobes"
    assert explorer.recipe.to_json()["weights"] == pytest.approx(place.recipe.weights)
    # Along the route again.
    explorer.t = 0.0
    assert explorer.point is None
    assert explorer.recipe.to_json()["weights"] == {"material-0": 1.0}


def test_what_the_page_holds_is_the_recipe_until_the_place_changes(
    explorer: Explorer, small_library: Library
) -> None:
    """As the page tells it: beside leaving a free place, and taken back."""
    weights = {"material-1": 0.5, "material-2": 0.5}
    held = {
        "library": small_library.name,
        "blend": "root",
        "weights": weights,
        "body_scale": [1, 2, 1],
    }
    explorer.set_state({"point": None, "_held": held})
    assert explorer.recipe.to_json()["weights"] == weights
    assert explorer.recipe.body_scale == (1, 2, 1)
    explorer.set_state({"_held": None})
    assert explorer.recipe.to_json()["weights"] == {"material-0": 0.5, "material-4": 0.5}
    explorer.set_state({"_held": {**held, "body_scale": None}})
    assert explorer.recipe.to_json()["weights"] == weights
    explorer.t = 0.25
    assert explorer.recipe.to_json()["weights"] == {"material-0": 0.75, "material-4": 0.25}


@pytest.mark.parametrize(
    ("trait", "value", "error", "message"),
    [
        ("t", 1.5, SpaceError, "t = 1.5 is off the route: expected 0"),
        ("space", "outer", SpaceError, "there is no space 'outer': expected one of anchored"),
        ("pace", "brisk", SpaceError, "there is no pace 'brisk': expected one of perceptual"),
        ("blend", "median", RecipeError, "there is no blend 'median': expected linear"),
        ("stops", ["material-0"], SpaceError, "a route with 1 stop goes nowhere"),
        ("stops", ["material-0", "materiel-1"], LibraryError, "did you mean material-1"),
    ],
)
def test_a_place_that_is_none_is_refused(
    explorer: Explorer, trait: str, value: object, error: type[HalfwayError], message: str
) -> None:
    before = getattr(explorer, trait)
    with pytest.raises(error, match=message):
        setattr(explorer, trait, value)
    assert getattr(explorer, trait) == before


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("GET", "api/library", None),
        ("GET", "api/tables/material-3", None),
        ("GET", "api/tables/unobtainium", None),
        ("GET", "api/legs/linear/material-0/material-1", None),
        ("POST", "api/export/merl", {"library": "small", "weights": {"material-1": 1.0}}),
        ("POST", "api/position", {"space": "linear", "point": [0.0]}),
        ("GET", "../../etc/passwd", None),
    ],
)
def test_a_message_is_answered_as_a_request(
    answers: Answers, method: str, path: str, body: dict[str, Any] | None
) -> None:
    app = app_of(answers)
    sent: list[tuple[dict[str, Any], list[bytes]]] = []
    text = None if body is None else json.dumps(body)
    message = {"id": 7, "method": method, "path": path, "body": text}
    answerer = Answerer(app, lambda content, buffers: sent.append((content, buffers)))
    _apart(lambda: answerer.receive(message))
    client = TestClient(app, base_url="http://localhost", raise_server_exceptions=False)
    expected = client.request(method, f"/{path}", json=body)
    ((content, buffers),) = sent
    assert (content["id"], content["status"]) == (7, expected.status_code)
    assert buffers == [expected.content]
    for name, value in content["headers"].items():
        assert expected.headers[name] == value


def test_a_kernel_that_runs_a_loop_answers_in_it(answers: Answers) -> None:
    sent: list[dict[str, Any]] = []
    answerer = Answerer(app_of(answers), lambda content, _: sent.append(content))

    async def kernel() -> None:
        message = {"id": 1, "method": "GET", "path": "api/library", "body": None}
        answerer.receive(message)
        assert not sent
        while not sent:
            await asyncio.sleep(0.01)

    _apart(lambda: asyncio.run(asyncio.wait_for(kernel(), PATIENCE)))
    assert sent[0]["status"] == 200


def _apart(f: Callable[[], None]) -> None:
    """In a thread without a loop: tests in a browser leave one running in theirs."""
    with ThreadPoolExecutor(1) as pool:
        pool.submit(f).result()


def test_without_the_extra_one_line_says_how_to_get_it() -> None:
    code = "import sys; sys.modules['anywidget'] = None; import halfway.notebook"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr.splitlines()[-1].endswith(
        "halfway.notebook needs the package anywidget, which is not installed: expected the extra 'notebook'. "
        "Install it with `pip install anywidget`."
    )
