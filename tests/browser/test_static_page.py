"""The explorer as files, behind a server that knows nothing of it, under a path of its own."""

import json
import threading
from collections.abc import Generator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]
from patience import PATIENCE
from playwright.sync_api import expect

from halfway import route
from halfway.library import ProceduralLibrary, Subset
from halfway.people import distances
from halfway.recipes import Recipe
from halfway.server import Page
from halfway.server.static import export
from halfway.space import make_space

MATERIALS = (
    "blue-fabric", "cherry-235", "chrome", "gold-paint", "green-plastic", "pink-felt", "red-metallic-paint", "teflon",
)  # fmt: skip
PAIR = "#space=anchored&pace=perceptual&light=points&stops=teflon,cherry-235"

OF_A_FOLDER: dict[str, Any] = {"blend": "linear", "n_components": 3}


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
    explorer.page.locator("[name=light]").select_option("city")
    explorer.wait_for_picture(1)
    inside = (explorer.address, "blob:", "data:", "about:blank")
    assert [url for url in asked if not url.startswith(inside)] == []
    assert any("city" in url for url in asked)


def test_the_slider_goes_along_pythons_route(explorer: Explorer, subset: Subset) -> None:
    stops = ["teflon", "cherry-235", "chrome"]
    explorer.open(PAIR + ",chrome&t=0")
    explorer.page.wait_for_selector(".recipe .name")
    assert explorer.recipe == ["teflon"]
    explorer.set_t(0.25)
    recipe = route(subset, *stops, **OF_A_FOLDER).recipe(0.25)
    with explorer.page.expect_download() as file:
        explorer.page.get_by_role("button", name="Recipe", exact=True).click()
    shown = Recipe.from_json(json.loads(file.value.path().read_text()))
    assert shown.library.name == "browser"
    assert dict(zip(shown.names, shown.weights[0], strict=True)) == pytest.approx(
        dict(zip(recipe.names, recipe.weights[0], strict=True)), abs=1e-9
    )


def test_a_free_point_needs_no_server(explorer: Explorer, subset: Subset) -> None:
    space = make_space("anchored", subset, **OF_A_FOLDER)
    # The middle of all materials, in the coordinates of the space.
    point = space.points.mean(axis=0)
    explorer.open(f"{PAIR}&point={','.join(map(str, point.tolist()))}")
    names = space.at(point).recipe.names
    explorer.page.wait_for_function(
        "n => document.querySelectorAll('.recipe .name').length === n", arg=len(names)
    )
    assert set(explorer.recipe) == set(names)


def test_beyond_all_materials_there_is_a_mix_nearby(explorer: Explorer) -> None:
    explorer.open(f"{PAIR}&point={','.join(9 * ['1e6'])}")
    explorer.page.get_by_text("no mix is just there").wait_for()
    assert explorer.recipe


def test_what_takes_a_server_is_not_offered_or_said(explorer: Explorer, subset: Subset) -> None:
    page = explorer.page
    explorer.open(PAIR + "&asked=body:7a2a3a")
    page.wait_for_selector(".recipe .name")
    assert page.get_by_role("button", name="MERL file").count() == 0
    expect(page.get_by_label("Body colour", exact=True)).to_be_hidden()
    expect(page.locator(".recipe .problem")).to_contain_text("open the library with `halfway view`")
    assert page.locator("[name=pace] option").all_text_contents() == ["perceptual", "uniform"]
    # How alike people find its materials it knows.
    page.locator("[name=search]").fill("like chrome")
    order = distances(subset)[subset.index("chrome")].argsort()[1:]
    expect(page.locator(".results li")).to_have_text([subset.names[i] for i in order])


def test_a_folder_that_is_not_whole_says_so(explorer: Explorer, folder: Path) -> None:
    explorer.expected = "Failed to load resource"
    leg = folder / "data" / "legs" / "paper" / "1-2.json"
    aside = leg.rename(leg.with_suffix(".aside"))
    try:
        explorer.open("#space=paper&stops=cherry-235,chrome&light=points")
        said = explorer.page.get_by_text("copy the whole folder that was exported")
        said.wait_for()
        assert "./data/legs/paper/1-2.json is not there (404)" in said.inner_text()
    finally:
        aside.rename(leg)
