"""What goes wrong on a long day, and what is said of it: a cold start, a server that is away, files that are none, narrow screens."""

import threading
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from conftest import (  # pyright: ignore[reportMissingImports]
    GRID,
    MATERIALS,
    Explorer,
    served,
)
from patience import wait_until
from PIL import Image
from playwright.sync_api import Route, expect

from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.tasks import Work

SMALL = {"width": 460, "height": 560}
WIDE = {"width": 1440, "height": 900}
PHONE = {"width": 390, "height": 844}
PAIR = "#space=linear&pace=uniform&stops=cherry-235,gold-paint&t=0.5&light=points"
TRIANGLE = b"v 0 2 0\nv 1 0 1\nv -1 0 1\nf 1 2 3\n"


def test_a_cold_start_says_how_far_it_is_and_what_is_ready_can_be_used(explorer: Explorer) -> None:
    go_on = threading.Event()

    def halting(items: Iterable[Any], label: str, total: int) -> Iterable[Any]:  # noqa: ARG001
        for i, item in enumerate(items):
            yield item
            if i == 2:
                go_on.wait()

    models = builtin("merl-abc").models
    library = ProceduralLibrary("cold", {name: models[name] for name in MATERIALS}, grid=GRID)
    explorer.page.set_viewport_size(SMALL)
    try:
        with served(library, work=Work(track=halting), patience=0.05) as address:
            explorer = replace(explorer, address=address)
            explorer.open("#space=linear&stops=cherry-235,gold-paint&t=0.6&light=points")
            explorer.page.get_by_text("3 of 10").wait_for()
            # Tables need nothing of it: the stop that is nearest is shown, and can be replaced.
            explorer.wait_for_picture(1)
            assert explorer.recipe == ["gold-paint"]
            explorer.page.locator("[name=search]").fill("teflon")
            explorer.page.keyboard.press("Enter")
            assert explorer.stops == ["cherry-235", "teflon"]
            go_on.set()
            explorer.page.wait_for_selector(".here")
            expect(explorer.page.locator(".status")).to_be_hidden()
    finally:
        go_on.set()


def test_small_pictures_that_come_late_are_in_every_row(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    late: list[Route] = []
    explorer.page.route("**/api/thumbnails", lambda route: late.append(route))
    explorer.open(PAIR.replace("0.5", "0"))
    explorer.wait_for_recipe(["cherry-235"])
    explorer.set_t(1)
    explorer.wait_for_recipe(["gold-paint"])
    painted = """(selector) => [...document.querySelectorAll(selector)].map((canvas) =>
        canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data[3])"""
    late[0].continue_()
    wait_until(lambda: explorer.page.evaluate(painted, ".chip .thumbnail")[0], explorer.pause)
    # The other row was not on the page when they came.
    explorer.set_t(0.5)
    explorer.wait_for_recipe(["cherry-235", "gold-paint"])
    assert explorer.page.evaluate(painted, ".recipe .thumbnail") == [255, 255]


def test_the_picture_is_as_large_as_asked_whole_and_named_after_the_material(
    explorer: Explorer,
) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open(PAIR.replace("0.5", "0.25"))
    explorer.wait_for_picture(1)
    explorer.page.get_by_role("button", name="Picture", exact=True).click()
    for background, corner in (("transparent", 0), ("backdrop", 255)):
        explorer.page.locator("[name=size]").fill("48")
        explorer.page.locator("[name=background]").select_option(background)
        with explorer.page.expect_download() as file:
            explorer.page.get_by_role("button", name="Save", exact=True).click()
        assert file.value.suggested_filename == "cherry-235-to-gold-paint-0.250.png"
        with Image.open(file.value.path()) as saved:
            pixels = np.asarray(saved.convert("RGBA"))
        assert pixels.shape == (48, 48, 4)
        assert pixels[0, 0, 3] == corner
        assert pixels[24, 24, 3] == 255
        assert pixels[24, 24, :3].max() > 30


@pytest.mark.parametrize("width", [390, 1180])
def test_nothing_that_is_drawn_is_under_a_button(explorer: Explorer, width: int) -> None:
    explorer.page.set_viewport_size({"width": width, "height": 844})
    explorer.open(PAIR)
    explorer.page.wait_for_selector(".here")
    hidden = explorer.page.evaluate(
        """() => [...document.querySelectorAll(".live, .cloud")].flatMap((canvas) => {
          const a = canvas.getBoundingClientRect();
          const buttons = canvas.closest(".panel").querySelectorAll("button:not(.here), select, input");
          return [...buttons].filter((button) => {
            const b = button.getBoundingClientRect();
            return b.width && b.left < a.right && b.right > a.left && b.top < a.bottom && b.bottom > a.top;
          }).map((button) => button.outerHTML);
        })"""
    )
    assert hidden == []


def test_a_finger_scrolls_past_the_space_and_the_material(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(PHONE)
    explorer.open(PAIR)
    explorer.page.wait_for_selector(".here")
    session = explorer.page.context.new_cdp_session(explorer.page)
    for canvas in (".cloud", ".live"):
        explorer.page.locator(canvas).scroll_into_view_if_needed()
        box = explorer.page.locator(canvas).bounding_box()
        assert box is not None
        before = explorer.page.evaluate("scrollY")
        x, y = box["x"] + box["width"] / 2, box["y"] + 0.8 * box["height"]
        for i in range(8):
            at = {"x": x, "y": y - 20 * i}
            kind = "touchMove" if i else "touchStart"
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [at]})
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        explorer.page.wait_for_function("y => scrollY > y + 60", arg=before)


def test_nothing_moves_when_something_is_said_added_or_compared(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(WIDE)
    explorer.open("#space=linear&stops=cherry-235,gold-paint,teflon&light=points")
    explorer.page.wait_for_selector(".here")
    before = explorer.page.locator(".live").bounding_box()
    explorer.drop(".material", "notes.obj", b"nothing")
    said = explorer.page.locator(".material .problem")
    expect(said).to_contain_text("notes.obj has no triangles")
    assert explorer.page.locator(".live").bounding_box() == before
    explorer.drop(".material", "notes.obj", TRIANGLE)
    expect(said).to_have_count(0)
    explorer.page.locator("[name=compare]").select_option("paper")
    explorer.page.get_by_label("Add a stop").click()
    explorer.page.locator("[name=search]").fill("pearl")
    explorer.page.keyboard.press("Enter")
    assert len(explorer.stops) == 4
    assert explorer.page.locator(".live").bounding_box() == before


def test_what_cannot_be_done_is_said_and_can_be_closed(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(WIDE)
    explorer.open("#space=cubic&stops=cherry-235,unobtainium,gold-paint&t=1&light=points")
    said = explorer.page.locator(".route .problem")
    expect(said).to_contain_text("space cubic, unobtainium")
    said.get_by_label("Close").click()
    expect(said).to_have_count(0)
    explorer.page.locator("[name=search]").fill("cherry")
    explorer.page.keyboard.press("Enter")
    expect(said).to_contain_text("cherry-235 is the stop beside it already")
    explorer.page.locator("[name=search]").fill("teflon")
    explorer.page.keyboard.press("Enter")
    expect(said).to_have_count(0)
    explorer.drop(".space", "notes.txt", b"nothing")
    expect(explorer.page.locator(".space .problem")).to_contain_text("notes.txt is nothing that")


def test_what_failed_is_asked_for_again(explorer: Explorer) -> None:
    explorer.expected = "Failed to load resource"  # the browser's own words
    page = explorer.page
    page.set_viewport_size(SMALL)
    page.route("**/api/tables/gold-paint", lambda route: route.fulfill(status=500, body="{}"))
    explorer.open(PAIR)
    said = page.locator(".material .problem")
    expect(said).to_contain_text("500")
    page.unroute("**/api/tables/gold-paint")
    explorer.wait_for_picture(1)
    expect(said).to_have_count(0)
    page.route("**/forest*", lambda route: route.abort())
    page.locator("[name=light]").select_option("forest")
    expect(said).to_contain_text("forest could not be loaded")
    page.unroute("**/forest*")
    page.get_by_text("/ 384 samples").wait_for()


def test_a_server_that_is_away_is_said_and_waited_for(explorer: Explorer) -> None:
    explorer.expected = "Failed to load resource"
    page = explorer.page
    explorer.open(PAIR)
    explorer.wait_for_recipe(["cherry-235", "gold-paint"])
    page.route("**/api/legs/**", lambda route: route.abort())
    page.locator("[name=search]").fill("teflon")
    page.keyboard.press("Enter")
    expect(page.locator(".status")).to_contain_text("halfway view")
    # What is asked for and what is shown.
    assert explorer.stops == ["cherry-235", "teflon"]
    expect(page.locator(".behind")).to_have_text("still shown: cherry-235 to gold-paint, linear")
    assert explorer.recipe == ["cherry-235", "gold-paint"]
    page.unroute("**/api/legs/**")
    explorer.wait_for_recipe(["teflon"])
    expect(page.locator(".status")).to_be_hidden()
    expect(page.locator(".behind")).to_be_hidden()


def test_a_card_that_is_lost_is_said(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open(PAIR)
    explorer.wait_for_picture(1)
    card = "document.querySelector('.live').getContext('webgl2').getExtension('WEBGL_lose_context')"
    explorer.page.evaluate(f"() => {{ window.card = {card}; window.card.loseContext(); }}")
    said = explorer.page.locator(".material .problem")
    expect(said).to_contain_text("took the graphics card away")
    explorer.page.evaluate("window.card.restoreContext()")
    expect(said).to_have_count(0)


def test_stops_are_inserted_and_moved_by_touch(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(WIDE)
    explorer.open(PAIR)
    explorer.page.get_by_label("Insert a stop between cherry-235 and gold-paint").click()
    explorer.page.locator("[name=search]").fill("teflon")
    explorer.page.keyboard.press("Enter")
    assert explorer.stops == ["cherry-235", "teflon", "gold-paint"]
    session = explorer.page.context.new_cdp_session(explorer.page)
    start, end = (
        explorer.page.locator(f".chip[data-stop={name}] .thumbnail").bounding_box()
        for name in ("gold-paint", "cherry-235")
    )
    assert start is not None
    assert end is not None
    for kind, box in (("touchStart", start), ("touchMove", end), ("touchEnd", None)):
        points = [{"x": box["x"] + 12, "y": box["y"] + 12}] if box else []
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    assert explorer.stops == ["gold-paint", "cherry-235", "teflon"]


def test_keys_lead_off_the_route_and_lists_can_be_scrolled_by_them(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(WIDE)
    explorer.open("#space=anchored&stops=cherry-235,teflon&t=0.5&light=points")
    explorer.page.get_by_role("button", name="Body colour").click()
    assert explorer.page.locator("main").count() == 1
    for scrolling in (".recipe ol", ".stops"):
        assert explorer.page.locator(scrolling).get_attribute("tabindex") == "0"
    handle = explorer.page.get_by_label("to leave the route")
    handle.focus()
    handle.press("ArrowRight")
    explorer.page.get_by_role("button", name="Back to route").wait_for()
    explorer.page.wait_for_function("() => location.hash.includes('point=')")


def test_the_command_that_makes_the_picture_is_copied(explorer: Explorer) -> None:
    explorer.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    explorer.open(PAIR + "&exposure=1")
    explorer.wait_for_recipe(["cherry-235", "gold-paint"])
    explorer.page.get_by_label("Copy the command").click()
    explorer.page.get_by_text("Copied").wait_for()
    assert explorer.page.evaluate("navigator.clipboard.readText()") == (
        "halfway route browser cherry-235 gold-paint --space linear --blend linear --pace uniform --t 0.5"
        " -o cherry-235-to-gold-paint-0.500 && halfway render cherry-235-to-gold-paint-0.500"
        " --scene spheres --exposure 1 -o cherry-235-to-gold-paint-0.500.png"
    )
