"""The explorer in a real Chromium, drawn by its software rasteriser.

A console error fails the test: three.js logs a shader that does not compile and carries on.
"""

import threading
from base64 import b64decode, b64encode
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
import uvicorn
from chromium import chromium
from patience import PATIENCE, wait_until
from PIL import Image
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, expect

from halfway.colour import from_srgb
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.render import Renderer, Scene
from halfway.render.scenes import Material
from halfway.server import Page as Files
from halfway.server import create_app
from halfway.server.run import listen

# Matte, glossy and mirror-like materials among them; a coarser grid than MERL's makes a table 1 MB.
MATERIALS = (
    "blue-fabric", "cherry-235", "chrome", "gold-paint", "green-plastic", "pearl-paint", "pink-felt", "red-metallic-paint",
    "teflon", "yellow-matte-plastic",
)  # fmt: skip
GRID = Grid.merl(60, 30, 36)
expect.set_options(timeout=1000 * PATIENCE)
SIZE = {"width": 820, "height": 760}
COARSE = 0.125
"""Pixels of the screen along one of the page, where no test looks at them: the rasteriser draws them all, until the picture has settled."""
EMPTY = "empty"
"""Where there is no explorer, at the same address."""


@pytest.fixture(scope="session")
def library() -> ProceduralLibrary:
    models = builtin("merl-abc").models
    return ProceduralLibrary("browser", {name: models[name] for name in MATERIALS}, grid=GRID)


@pytest.fixture(scope="session")
def address(library: ProceduralLibrary) -> Generator[str]:
    with served(library) as address:
        yield address


@contextmanager
def served(library: ProceduralLibrary, **options: Any) -> Generator[str]:
    """The address of an explorer of ``library``; ``options`` are those of `create_app`."""
    with listen(0) as listener:
        config = uvicorn.Config(
            create_app(library, page=Files.load(), **options), log_level="error"
        )
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, args=([listener],), daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/"
        server.should_exit = True
        thread.join(PATIENCE)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with chromium() as browser:
        yield browser


@contextmanager
def opened(browser: Browser, **options: Any) -> Generator[Page]:
    """A page of its own."""
    with browser.new_context(**{"device_scale_factor": COARSE, **options}) as context:
        context.set_default_timeout(1000 * PATIENCE)
        yield context.new_page()


WHOLE = "() => document.querySelector('.live').width >= Math.floor(devicePixelRatio * document.querySelector('.material').clientWidth)"

# From the drawing buffer, not a screenshot: neither scaled nor composited.
DRAWN = """() => {
  const canvas = document.querySelector(".live");
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  let text = "";
  for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
  return [canvas.height, canvas.width, btoa(text)];
}"""

DROP = """([panel, name, data]) => {
  const bytes = Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
  const files = new DataTransfer();
  files.items.add(new File([bytes], name));
  const dropped = new DragEvent("drop", { dataTransfer: files, bubbles: true, cancelable: true });
  document.querySelector(panel).dispatchEvent(dropped);
  return dropped.defaultPrevented;
}"""


@dataclass
class Explorer:
    """A page of the explorer, and what a test does with it."""

    page: Page
    address: str
    expected: str = "\0"
    """Console errors that begin so are the test's own doing."""

    def open(self, fragment: str = "") -> None:
        if self.page.url != "about:blank":
            self.page.goto(self.address + EMPTY)  # what differs in the fragment is one page
        self.page.goto(self.address + fragment)
        self.page.wait_for_selector("#app.ready")

    def wait_for_picture(self, samples: int = 1) -> None:
        """Until the present recipe has so many samples."""
        self.page.wait_for_function(
            "n => Number(document.querySelector('.material').dataset.samples) >= n",
            arg=samples,
        )

    def wait_for_whole_picture(self, samples: int) -> None:
        """Until the picture has all its pixels, and so many samples."""
        self.page.wait_for_function(WHOLE)
        self.wait_for_picture(samples)

    def wait_until_settled(self) -> None:
        """Until the picture has all its pixels and samples."""
        self.page.wait_for_selector(".material[data-settled=true]")

    def drawn(self) -> np.ndarray:
        """The material's picture, (height, width, RGBA), 8-bit sRGB."""
        height, width, data = self.page.evaluate(DRAWN)
        return np.frombuffer(b64decode(data), np.uint8).reshape(height, width, 4)

    def drawn_after(self, before: np.ndarray) -> np.ndarray:
        """The picture, once it is another one than before."""
        wait_until(lambda: not np.array_equal(self.drawn(), before), self.pause)
        return self.drawn()

    def pause(self) -> None:
        """A moment in which the page goes on."""
        self.page.wait_for_timeout(50)

    @property
    def recipe(self) -> list[str]:
        return self.page.locator(".recipe .name").all_text_contents()

    def wait_for_recipe(self, names: list[str]) -> None:
        """Until the page shows the recipe of these materials."""
        shown = "names => names.join() === [...document.querySelectorAll('.recipe .name')].map(e => e.textContent).join()"
        self.page.wait_for_function(shown, arg=names)

    @property
    def stops(self) -> list[str]:
        return [
            chip.get_attribute("data-stop") or ""
            for chip in self.page.locator(".chip[data-stop]").all()
        ]

    def set_t(self, t: float) -> None:
        self.page.locator("[name=t]").fill(str(t))

    def ask(self, name: str, value: str) -> None:
        """Ask for an attribute, beside its slider."""
        field = self.page.locator(f".dials [name={name}]")
        field.fill(value)
        field.press("Enter")

    def drop(self, panel: str, name: str, content: bytes) -> None:
        """Drop a file on a panel."""
        # What the page does not take, the browser opens in its place.
        assert self.page.evaluate(DROP, [panel, name, b64encode(content).decode()])

    def film(self, **chosen: str) -> tuple[str, bytes]:
        """The name and the content of a short, small film."""
        page = self.page
        page.get_by_role("button", name="Film").click()
        page.locator("[name=film-size]").fill("48")
        page.locator("[name=seconds]").fill("0.2")
        page.locator("[name=quality]").select_option("draft")
        for name, value in chosen.items():
            page.locator(f"[name={name.replace('_', '-')}]").select_option(value)
        with page.expect_download() as file:
            page.get_by_role("button", name="Save", exact=True).click()
        path = file.value.path()
        assert isinstance(path, Path)
        return file.value.suggested_filename, path.read_bytes()


def to_linear(shown: np.ndarray) -> np.ndarray:
    """Linear RGB of drawn pixels, as the display shows them."""
    return from_srgb(shown[..., :3] / 255)


def frames(content: bytes) -> list[np.ndarray]:
    """Linear RGB of the pictures of a film of frames."""
    with ZipFile(BytesIO(content)) as archive:
        names = archive.namelist()
        assert names == [f"{i:04}.png" for i in range(5)]
        pictures = [Image.open(BytesIO(archive.read(name))).convert("RGB") for name in names]
        return [to_linear(np.asarray(picture)) for picture in pictures]


def in_mitsuba(
    scene: Scene, material: Material, like: np.ndarray, *, spp: int, turn_degrees: float = 0.0
) -> np.ndarray:
    """Linear RGB of the same picture by Mitsuba, as large as ``like``."""
    height, width = like.shape[:2]
    renderer = Renderer(scene, size=(width, height), spp=spp, turn_degrees=turn_degrees)
    if not renderer.exact:
        pytest.skip("needs Mitsuba with LLVM, which looks tables up as they are")
    return renderer.picture(material)


SIDE = 4
"""Pixels along a square whose mean is compared: less noise, so fewer samples."""


def squares(picture: np.ndarray) -> np.ndarray:
    """Means over squares of pixels; what is over at the right and below is left out."""
    height, width, depth = picture.shape
    rows, columns = height // SIDE, width // SIDE
    cut = picture[: SIDE * rows, : SIDE * columns].astype(float)
    return cut.reshape(rows, SIDE, columns, SIDE, depth).mean(axis=(1, 3))


@pytest.fixture(scope="session")
def contexts(browser: Browser) -> Generator[Callable[[float], BrowserContext]]:
    """The one context of each scale, with a page that keeps its process alive: the next page begins in half the time."""
    with ExitStack() as stack:

        @cache
        def context(scale: float) -> BrowserContext:
            page = stack.enter_context(
                opened(
                    browser,
                    viewport=SIZE,
                    device_scale_factor=scale,
                    accept_downloads=True,
                    color_scheme="dark",
                )
            )
            page.context.route("**/" + EMPTY, lambda route: route.fulfill(body=""))
            page.goto("http://127.0.0.1/" + EMPTY)  # of any port
            return page.context

        yield context


@pytest.fixture(scope="module")
def scale() -> float:
    return COARSE


@pytest.fixture
def explorer(
    contexts: Callable[[float], BrowserContext], scale: float, address: str
) -> Iterator[Explorer]:
    errors: list[str] = []

    def on_console(message: ConsoleMessage) -> None:
        if message.type == "error":
            errors.append(message.text)

    page = contexts(scale).new_page()
    page.on("console", on_console)
    page.on("pageerror", lambda error: errors.append(str(error)))
    explorer = Explorer(page, address)
    yield explorer
    # What fails from here on, such as a question to a server that is gone, is no fault.
    page.remove_listener("console", on_console)
    page.unroute_all(behavior="ignoreErrors")
    page.goto(address + EMPTY)
    page.evaluate("localStorage.clear()")
    page.close()
    unexpected = [error for error in errors if not error.startswith(explorer.expected)]
    assert not unexpected, "\n".join(unexpected)
