"""Where things are on the page: many stops, long names, narrow windows."""

from collections.abc import Generator
from dataclasses import replace

import pytest
from conftest import (  # pyright: ignore[reportMissingImports]
    GRID,
    MATERIALS,
    Explorer,
    served,
)
from patience import wait_until

from halfway.library import ProceduralLibrary
from halfway.models import builtin

WIDE = {"width": 1440, "height": 900}
NARROW = {"width": 800, "height": 900}
LONG = "a-name-that-says-who-measured-it-and-when-and-where-and-at-what-temperature-of-the-room"


@pytest.fixture(scope="module")
def long_names() -> Generator[str]:
    """The address of an explorer of materials with long names."""
    models = builtin("merl-abc").models
    renamed = {f"{LONG}-{i}": models[name] for i, name in enumerate(MATERIALS)}
    with served(ProceduralLibrary("long", renamed, grid=GRID)) as address:
        yield address


def test_the_button_that_adds_a_stop_stands_beside_the_last(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(NARROW)
    explorer.open("#space=linear&stops=pink-felt,chrome,teflon&light=points")
    assert middle_of(explorer, ".stops .icon[title='Add a stop']") == pytest.approx(
        middle_of(explorer, ".chip[data-stop=teflon]"), abs=2
    )
    assert middle_of(explorer, ".route .t") == pytest.approx(
        middle_of(explorer, "[name=compare]"), abs=2
    )


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_many_stops_leave_room_for_the_strip(explorer: Explorer, size: dict[str, int]) -> None:
    explorer.page.set_viewport_size(size)
    explorer.open(f"#space=linear&pace=uniform&stops={','.join((4 * MATERIALS)[:32])}&light=points")
    assert len(explorer.stops) == 32
    assert bottom_of(explorer, ".strip") < bottom_of(explorer, ".route")
    last = explorer.page.locator(".chip[data-stop]").last
    last.scroll_into_view_if_needed()
    last.click()


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_long_names_stay_on_their_line(
    explorer: Explorer, long_names: str, size: dict[str, int]
) -> None:
    explorer = replace(explorer, address=long_names)
    explorer.page.set_viewport_size(size)
    stops = ",".join(f"{LONG}-{i}" for i in range(3))
    explorer.open(f"#space=linear&stops={stops}&light=points&compare=stop:{LONG}-1")
    explorer.page.wait_for_selector(".label")
    for line in (".chip .name", ".split span", ".label"):
        heights = explorer.page.locator(line).evaluate_all("all => all.map(e => e.clientHeight)")
        assert max(heights) < 26, line
    assert right_of(explorer, "[name=compare]") < right_of(explorer, ".route")
    assert explorer.page.evaluate("document.documentElement.scrollWidth") <= size["width"]


def box(explorer: Explorer, selector: str) -> dict[str, float]:
    found = explorer.page.locator(selector).bounding_box()
    assert found is not None
    return dict(found)


def middle_of(explorer: Explorer, selector: str) -> float:
    found = box(explorer, selector)
    return found["y"] + found["height"] / 2


def bottom_of(explorer: Explorer, selector: str) -> float:
    found = box(explorer, selector)
    return found["y"] + found["height"]


def right_of(explorer: Explorer, selector: str) -> float:
    found = box(explorer, selector)
    return found["x"] + found["width"]


@pytest.mark.parametrize("scale", [1.0], scope="module")
def test_the_names_of_compared_rows_stand_below_their_pictures(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(NARROW)
    explorer.open("#space=linear&stops=pink-felt,teflon&light=points&compare=paper")

    def overlaps() -> list[float]:
        return explorer.page.evaluate(PICTURES_UNDER_NAMES)

    # Until the other row has come, the pictures of the one are large.
    wait_until(lambda: len(now := overlaps()) == 2 and max(now) <= 0, explorer.pause)


# How far the pictures of each row reach below the top of the row's name.
PICTURES_UNDER_NAMES = """() => {
  const canvas = document.querySelector(".strip canvas");
  const { left, top } = canvas.getBoundingClientRect();
  return [...document.querySelectorAll(".strip .names span")].flatMap((name, row, { length }) => {
    const box = name.getBoundingClientRect();
    const start = Math.round((row + 0.25) * canvas.clientHeight / length);
    const { data, width, height } = canvas.getContext("2d").getImageData(
      Math.round(box.left - left), start, Math.round(box.width), canvas.height - start);
    let reach = 0;
    for (let x = 0; x < width; x++) {
      let y = 0;
      while (y < height && data[4 * (y * width + x) + 3] > 64) y++;
      reach = Math.max(reach, y);
    }
    return reach ? [top + start + reach - box.top] : [];
  });
}"""
