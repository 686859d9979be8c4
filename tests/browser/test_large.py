"""Libraries of thousands: what a page of hundreds takes, by the material, and how one finds one's way in it."""

from collections.abc import Callable, Generator
from contextlib import ExitStack, contextmanager
from functools import cache

import pytest
from conftest import opened, served  # pyright: ignore[reportMissingImports]
from playwright.sync_api import Browser, Page, expect

from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.models import builtin

GRID = Grid.merl(6, 6, 6)
FEW, MANY = 30, 180
SIZE = {"width": 1000, "height": 800}
PER_MATERIAL = 50_000
"""Bytes that scripts hold: 2,000 materials in 100 MB."""


@pytest.fixture(scope="module")
def crowd() -> Generator[Callable[[int], str]]:
    """The address of an explorer of so many materials."""
    with ExitStack() as stack:

        @cache
        def address(n: int) -> str:
            models = builtin(f"synthetic-{n}").models
            return stack.enter_context(served(ProceduralLibrary("crowd", models, grid=GRID)))

        yield address


def test_what_scripts_hold_of_a_material_lets_2000_be_in_100_mb(
    browser: Browser, crowd: Callable[[int], str]
) -> None:
    held: list[float] = []
    for n in (FEW, MANY):
        with shown(browser, crowd(n)) as page:
            session = page.context.new_cdp_session(page)
            session.send("HeapProfiler.collectGarbage")
            usage = session.send("Runtime.getHeapUsage")
            held.append(usage["usedSize"] + usage["backingStorageSize"])
    assert (held[1] - held[0]) / (MANY - FEW) < PER_MATERIAL


def test_the_grid_paints_what_is_seen(browser: Browser, crowd: Callable[[int], str]) -> None:
    with shown(browser, crowd(MANY)) as page:
        page.get_by_role("button", name="Grid", exact=True).click()
        first, last = page.locator(".grid canvas").first, page.locator(".grid canvas").last
        expect(first).to_have_js_property("width", 64)
        expect(last).to_have_js_property("width", 0)
        assert painted(page) < MANY / 3
        page.locator(".grid button").last.focus()
        expect(last).to_have_js_property("width", 64)
        expect(first).to_have_js_property("width", 0)
        assert painted(page) < MANY / 3


def test_one_comes_near_to_what_one_points_at_and_back(
    browser: Browser, crowd: Callable[[int], str]
) -> None:
    with shown(browser, crowd(FEW)) as page:
        home = page.get_by_role("button", name="See the whole space")
        box = page.locator(".cloud").bounding_box()
        assert box is not None
        expect(home).to_be_hidden()
        page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"])
        page.mouse.wheel(0, -900)
        expect(home).to_be_visible()
        home.click()
        expect(home).to_be_hidden()


@contextmanager
def shown(browser: Browser, address: str) -> Generator[Page]:
    """A page that shows its space."""
    with opened(browser, viewport=SIZE) as page:
        page.goto(address)
        page.wait_for_selector(".labels", state="attached")
        yield page


def painted(page: Page) -> int:
    return page.evaluate(
        "[...document.querySelectorAll('.grid canvas')].filter(({ width }) => width > 0).length"
    )
