"""The explorer as files, behind a server that knows nothing of it, under a path of its own."""

import json
import threading
from collections.abc import Generator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]
from patience import PATIENCE

from halfway.library import ProceduralLibrary, Subset
from halfway.recipes import Recipe
from halfway.server import Page
from halfway.server.explorer import Explorer as Answers
from halfway.server.schema import Point
from halfway.server.static import export

MATERIALS = (
    "blue-fabric", "cherry-235", "chrome", "gold-paint", "green-plastic", "pink-felt", "red-metallic-paint", "teflon",
)  # fmt: skip
PAIR = "#space=anchored&pace=perceptual&stops=teflon,cherry-235"


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Nothing."""


@pytest.fixture(scope="module")
def subset(library: ProceduralLibrary) -> Subset:
    return Subset(library, MATERIALS)


@pytest.fixture(scope="module")
def folder(subset: Subset, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("host") / "people" / "materials"
    export(subset, folder, Page.load())
    return folder


@pytest.fixture(scope="module")
def address(folder: Path) -> Generator[str]:
    handler = partial(QuietHandler, directory=str(folder.parents[1]))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/people/materials/"
        server.shutdown()
        thread.join(PATIENCE)


def test_the_page_opens_and_asks_for_nothing_outside_its_folder(explorer: Explorer) -> None:
    asked: list[str] = []
    explorer.page.on("request", lambda request: asked.append(request.url))
    explorer.open(PAIR + "&t=0.5")
    explorer.wait_for_picture()
    explorer.page.locator(".material select").select_option("city")
    explorer.wait_for_picture(1)
    inside = (explorer.address, "blob:", "data:", "about:blank")
    assert [url for url in asked if not url.startswith(inside)] == []
    assert any("city" in url for url in asked)


def test_the_slider_goes_along_the_servers_route(explorer: Explorer, subset: Subset) -> None:
    explorer.open(PAIR + "&t=0")
    explorer.page.wait_for_selector(".recipe .name")
    assert explorer.recipe == ["teflon"]
    explorer.set_t(0.25)
    answers = Answers(subset)
    route = answers.route("anchored", ["teflon", "cherry-235"], "perceptual")
    with explorer.page.expect_download() as file:
        explorer.page.get_by_role("button", name="Recipe", exact=True).click()
    found = Recipe.from_json(json.loads(file.value.path().read_text()))
    k = max(i for i, knot in enumerate(route.knots) if knot <= 0.25)
    share = (0.25 - route.knots[k]) / (route.knots[k + 1] - route.knots[k])
    expected = {
        name: (1 - share) * a + share * b
        for name, a, b in zip(route.names, route.weights.r[k], route.weights.r[k + 1], strict=True)
    }
    assert found.library.name == "browser"
    assert dict(zip(found.names, found.weights[0], strict=True)) == pytest.approx(
        {name: weight for name, weight in expected.items() if weight}, abs=1e-9
    )


def test_a_free_place_is_found_without_a_server(explorer: Explorer, subset: Subset) -> None:
    # The middle of all materials, in the coordinates of the space.
    view = Answers(subset).space_view("anchored")
    point = [
        sum(row[k] for row in embedding.points) / len(MATERIALS)
        for embedding in view.embeddings
        for k in range(len(embedding.axes))
    ]
    recipe = Answers(subset).position(Point(space="anchored", point=point)).recipe.weights
    explorer.open(f"{PAIR}&point={','.join(map(str, point))}")
    explorer.page.wait_for_function(
        "n => document.querySelectorAll('.recipe .name').length === n", arg=len(recipe)
    )
    assert set(explorer.recipe) == set(recipe)


def test_tables_are_not_offered(explorer: Explorer) -> None:
    explorer.open(PAIR)
    explorer.page.wait_for_selector(".recipe .name")
    assert explorer.page.get_by_role("button", name="MERL file").count() == 0


def test_a_folder_that_is_not_whole_says_so(explorer: Explorer, folder: Path) -> None:
    explorer.expected = "Failed to load resource"
    leg = folder / "data" / "legs" / "paper" / "1-2.json"
    aside = leg.rename(leg.with_suffix(".aside"))
    try:
        explorer.open("#space=paper&stops=cherry-235,chrome")
        said = explorer.page.get_by_text("copy the whole folder that was exported")
        said.wait_for()
        assert "./data/legs/paper/1-2.json is not there (404)" in said.inner_text()
    finally:
        aside.rename(leg)
