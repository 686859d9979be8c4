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
COMMON = "#space=linear&pace=uniform&shape=teapot&stops=cherry-235,"
BEFORE = "teflon&t=0.05"


@pytest.fixture(scope="module")
def scale() -> float:
    return 1.0


def set_t(explorer: Explorer) -> None:
    explorer.set_t(0.95)


def set_stop(explorer: Explorer) -> None:
    explorer.page.locator("[data-stop=teflon] > button").click()
    explorer.page.locator("[name=search]").fill("yellow-matte")
    explorer.page.keyboard.press("Enter")


def set_exposure(explorer: Explorer) -> None:
    explorer.page.get_by_label("Exposure in stops").fill("3")


# What is done, and a link to (nearly) what is to be seen then.
CHANGES = [
    (set_t, "teflon&t=0.95&blend=lobes"),
    (set_exposure, "teflon&t=0.95&blend=lobes&exposure=3"),
    (set_stop, "yellow-matte-plastic&t=0.95&blend=lobes&exposure=3"),
]


def test_a_change_is_seen_a_second_later(explorer: Explorer) -> None:
    """While the whole picture is made, which takes minutes there."""
    explorer.page.set_viewport_size(SIZE)
    expected = [seen_at(explorer, after) for _, after in CHANGES]
    seen_at(explorer, BEFORE + "&blend=lobes")
    for (change, _), after in zip(CHANGES, expected, strict=True):
        explorer.wait_for_whole_picture(0)
        assert comes_within_a_second(explorer, change, after), change.__name__


def test_a_change_is_seen_a_second_later_while_the_picture_is_small(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SIZE)
    expected = seen_at(explorer, "teflon&t=0.95")
    seen_at(explorer, BEFORE)
    assert comes_within_a_second(explorer, set_t, expected)


def seen_at(explorer: Explorer, stops: str) -> np.ndarray:
    """The first picture of a page that shows nothing else before."""
    explorer.open(COMMON + stops)
    explorer.wait_for_picture(4)
    return seen(explorer)


def comes_within_a_second(
    explorer: Explorer, change: Callable[[Explorer], None], expected: np.ndarray
) -> bool:
    """Whether a person sees what is ``expected`` within a second of a change, on a machine so many times slower."""
    near = difference(seen(explorer), expected) / 2
    session = explorer.page.context.new_cdp_session(explorer.page)
    session.send("Emulation.setCPUThrottlingRate", {"rate": THROTTLED})
    change(explorer)
    comes = False
    for _ in range(THROTTLED):
        explorer.page.wait_for_timeout(SECOND)
        comes = difference(seen(explorer), expected) < near
        if comes:
            break
    session.send("Emulation.setCPUThrottlingRate", {"rate": 1})
    return comes


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
