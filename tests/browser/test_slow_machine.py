"""What a person sees, not what is in a buffer: the page as the browser puts it together, on a slow machine.

The processor is throttled by 6, and the card is a rasteriser in software.
"""

from collections.abc import Callable
from io import BytesIO

import numpy as np
import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]
from PIL import Image

THROTTLED = 6
SIZE = {"width": 1180, "height": 800}
"""So large that a sample of the whole picture takes long."""
SECOND = 1000
MOVED = 2.0
"""Levels of 255, in the mean, by which a picture is another one: more than noise."""
LINK = "#space=linear&pace=uniform&shape=teapot&stops=cherry-235,teflon&t=0.05"


@pytest.fixture(scope="module")
def scale() -> float:
    return 1.0


def set_t(explorer: Explorer) -> None:
    explorer.set_t(0.95)


def set_stop(explorer: Explorer) -> None:
    explorer.page.locator("[data-stop=cherry-235] > button").click()
    explorer.set_t(0.05)
    explorer.page.locator("[name=search]").fill("yellow-matte")
    explorer.page.keyboard.press("Enter")


def set_exposure(explorer: Explorer) -> None:
    explorer.page.get_by_label("Exposure in stops").fill("3")


def test_a_change_is_seen_a_second_later(explorer: Explorer) -> None:
    """While the whole picture is made, which takes minutes there."""
    explorer.page.set_viewport_size(SIZE)
    explorer.open(LINK + "&blend=lobes")
    for change in (set_t, set_exposure, set_stop):
        explorer.wait_for_whole_picture(0)
        assert_seen_a_second_later(explorer, change)


def test_a_change_is_seen_a_second_later_while_the_picture_is_small(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SIZE)
    explorer.open(LINK)
    explorer.wait_for_picture(4)
    assert_seen_a_second_later(explorer, set_t)


def assert_seen_a_second_later(explorer: Explorer, change: Callable[[Explorer], None]) -> None:
    """A person sees within a second what a change comes to, on a machine so many times slower."""
    session = explorer.page.context.new_cdp_session(explorer.page)
    session.send("Emulation.setCPUThrottlingRate", {"rate": THROTTLED})
    before = seen(explorer)
    change(explorer)
    later = before
    for _ in range(THROTTLED):
        explorer.page.wait_for_timeout(SECOND)
        later = seen(explorer)
        if difference(later, before) > MOVED:
            break
    session.send("Emulation.setCPUThrottlingRate", {"rate": 1})
    explorer.wait_for_picture()
    after = seen(explorer)
    assert difference(before, after) > MOVED
    assert difference(later, after) < difference(before, after) / 2, change.__name__


def seen(explorer: Explorer) -> np.ndarray:
    """Mean colours of large squares of the material's panel, in 8 bits: noise and coarse pixels do not count."""
    box = explorer.page.locator(".material").bounding_box()
    assert box is not None
    with Image.open(BytesIO(explorer.page.screenshot())) as page:
        panel = page.crop(
            (box["x"], box["y"] + 50, box["x"] + box["width"], box["y"] + box["height"] - 60)
        )
        return np.asarray(panel.convert("RGB").resize((12, 12), Image.Resampling.BOX), float)


def difference(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).mean())
