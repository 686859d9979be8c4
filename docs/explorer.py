"""The pictures and the numbers of the page on the explorer, made by driving it in Chromium.

``python docs/explorer.py`` writes screenshots, and pictures of three materials on a sphere and a teapot in two lights, in the page
beside the same in Mitsuba, and prints how far the two are apart. ``--only compare``, ``--only screens``, ``--only anisotropic`` (the
screenshot of a library of both kinds) or ``--only speed`` does one of them; so do the other measures of ``explorer_speed.py``, which
are made when they are named. The rasteriser is Chromium's own in software;
``--angle vulkan --size 1440x900`` takes a graphics card.
"""

import argparse
import shutil
import tempfile
import threading
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TypeAlias

import explorer_speed
import numpy as np
import uvicorn
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright
from playwright.sync_api import TimeoutError as TooLate

from halfway import Grid, open_library
from halfway.cli.console import cache_folder
from halfway.colour import from_srgb
from halfway.library import Library, build_library
from halfway.render import SCENES, Renderer, pictures
from halfway.server import Page as Files
from halfway.server import create_app
from halfway.server.run import listen
from halfway.tasks import Work

IMAGES = Path(__file__).parent / "images"
SOFTWARE = "swiftshader"
# Without a card the browser itself rasterises the page, and SwiftShader what is drawn by WebGL.
NO_CARD = ["--disable-gpu", "--enable-unsafe-swiftshader"]
CARD = ["--ignore-gpu-blocklist", "--enable-gpu"]
MATERIALS = {"pink-felt": "matte", "cherry-235": "glossy", "chrome": "mirror-like"}
SPHERE = SCENES["spheres"]
# As the page has it: under the sphere's lights, and nothing else stands there.
TEAPOT = replace(SCENES["teapot"], points=SPHERE.points, ground=False)
SCENE_OF = {"sphere": SPHERE, "teapot": TEAPOT}
LIGHTS = {"points": "three lights", "studio": "studio"}
EXPOSURE = -1.0
SPP = 4096
# What the page settles for.
SAMPLES = {"points": 128, "studio": 384}
# Of a screenshot: a third of the samples, for which a rasteriser in software takes minutes, is as good to the eye.
ENOUGH = 128
PATIENCE = 300_000
FINE = """(enough) => {
  const { samples, settled } = document.querySelector(".material")?.dataset ?? {};
  const live = document.querySelector(".live");
  const whole = live && live.width > 0.9 * live.clientWidth;
  return settled === "true" || (whole && Number(samples) >= enough);
}"""
Screen: TypeAlias = tuple[tuple[int, int], str, str]
"""Size of the window, theme, and what the page shows."""
SCREENS: dict[str, Screen] = {
    "explorer-dark": ((1440, 900), "dark", "#space=anchored&stops=gold-metallic-paint,blue-acrylic&t=0.2&shape=teapot&aside=numbers"),
    "explorer-light": ((1440, 900), "light", "#space=paper&stops=cherry-235,tungsten-carbide&t=0.5&light=city&compare=linear"),
    "explorer-narrow-dark": ((800, 900), "dark", "#space=anchored&stops=pink-felt,chrome,teflon&t=0.3&light=sunset&map=Grid"),
    "explorer-narrow-light": ((800, 900), "light", "#space=anchored&stops=green-plastic,gold-paint&t=0.5&shape=teapot&light=forest"),
}  # fmt: skip
OF_BOTH_KINDS: dict[str, Screen] = {
    "explorer-anisotropic": ((1440, 900), "dark", "#space=anchored&stops=brushed-steel,cherry-235&t=0.2&light=points&grain=37&plot=slice"),
}  # fmt: skip


MEASURES = {
    "speed": explorer_speed.speed,
    "large": explorer_speed.large,
    "numbers": explorer_speed.numbers,
}


def main() -> None:
    """Make what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--only", choices=["compare", "screens", "anisotropic", "memory", *MEASURES]
    )
    parser.add_argument(
        "--angle", default=SOFTWARE, help="what WebGL runs on, as Chromium names it"
    )
    parser.add_argument("--size", default="460x560", help="of the window that is measured")
    parser.add_argument("--library", default="builtin:merl-abc", help="that is measured")
    parser.add_argument("--seconds", type=float, default=300, help="of dragging, for --only memory")
    parser.add_argument("--chromium", default=shutil.which("chromium"))
    given = parser.parse_args()
    only = given.only
    library = open_library(given.library)
    with served(library) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=given.chromium,
            args=["--no-sandbox", f"--use-angle={given.angle}"]
            + (NO_CARD if given.angle == SOFTWARE else CARD),
        )
        if only in (None, "compare"):
            compare(browser, address, library)
        if only in (None, "screens"):
            for name, screen in SCREENS.items():
                take(browser, address, name, screen)
        if only in (None, "anisotropic"):
            with tempfile.TemporaryDirectory() as folder, served(of_both_kinds(folder)) as other:
                for name, screen in OF_BOTH_KINDS.items():
                    take(browser, other, name, screen)
        width, height = map(int, given.size.split("x"))
        if only == "memory":
            explorer_speed.memory(browser, address, width, height, given.seconds)
        elif only is None or only in MEASURES:
            MEASURES[only or "speed"](browser, address, width, height)
        browser.close()


@contextmanager
def served(library: Library) -> Generator[str]:
    """The address of an explorer of ``library``, on this machine."""
    with listen(0) as listener:
        app = create_app(library, page=Files.load(), work=Work(cache=cache_folder()))
        server = uvicorn.Server(uvicorn.Config(app, log_level="error"))
        thread = threading.Thread(target=server.run, args=([listener],), daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/"
        server.should_exit = True
        thread.join(20)


def of_both_kinds(folder: str) -> Library:
    """What `halfway library build builtin:anisotropic builtin:merl-abc --grid 32x24x12x12` builds."""
    sources = ["builtin:anisotropic", "builtin:merl-abc"]
    grid = Grid.anisotropic(32, 24, 12, 12)
    return build_library(sources, Path(folder) / "both.brdflib", grid=grid).library


def compare(browser: Browser, address: str, library: Library) -> None:
    """The page beside Mitsuba: the picture, and a table of mean differences."""
    page = browser.new_page(viewport={"width": 480, "height": 640}, color_scheme="dark")
    print(
        "| material | object | light | page | Mitsuba, as many samples and bits |\n|---|---|---|---|---|"
    )
    rows: list[np.ndarray] = []
    for shape, light in product(SCENE_OF, LIGHTS):
        scene = SCENE_OF[shape] if light == "points" else replace(SCENE_OF[shape], points=())
        row: list[np.ndarray] = []
        for name, kind in MATERIALS.items():
            shown, covered = in_page(page, address, name, shape, light)
            height, width = covered.shape
            rendered, as_many = (
                clipped(2**EXPOSURE * Renderer(scene, size=(width, height), spp=spp).picture(library.brdf(name)))
                for spp in (SPP, SAMPLES[light])
            )  # fmt: skip
            inside = eroded(covered)
            differences = [
                f"{np.abs(picture - rendered)[inside].mean() / rendered[inside].mean():.2%}"
                for picture in (shown, from_srgb(pictures.to_8_bit(as_many) / 255))
            ]
            print("|", " | ".join([f"{name} ({kind})", shape, LIGHTS[light], *differences]), "|", flush=True)  # fmt: skip
            row += [square(shown, covered), square(rendered, covered)]
        rows.append(np.concatenate(row, axis=1))
    page.close()
    picture = pictures.to_8_bit(np.concatenate(rows))
    Image.fromarray(picture).save(IMAGES / "explorer-beside-mitsuba.webp", quality=88)


def in_page(
    page: Page, address: str, name: str, shape: str, light: str
) -> tuple[np.ndarray, np.ndarray]:
    """Linear RGB of the page's picture (height, width, 3), and which pixels the object covers."""
    other = next(material for material in MATERIALS if material != name)
    page.goto("about:blank")
    stops = f"stops={name},{other}&t=0"
    page.goto(f"{address}#space=linear&{stops}&shape={shape}&light={light}&exposure={EXPOSURE}")
    page.wait_for_selector(".material[data-settled=true]", timeout=300_000)
    # From the drawing buffer, not a screenshot: neither scaled nor composited.
    width, height, data = page.evaluate(
        """() => {
          const canvas = document.querySelector(".live");
          const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
          copy.drawImage(canvas, 0, 0);
          const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
          return [canvas.width, canvas.height, Array.from(data)];
        }"""
    )
    coded = np.array(data, np.uint8).reshape(height, width, 4)
    return from_srgb(coded[..., :3] / 255), coded[..., 3] == 255


def clipped(radiance: np.ndarray) -> np.ndarray:
    """What a screen can show of it."""
    return radiance.clip(0, 1)


def eroded(covered: np.ndarray) -> np.ndarray:
    """Without the outermost pixels, whose coverage two filters count differently."""
    inside = covered.copy()
    for axis in (0, 1):
        for step in (1, -1):
            inside &= np.roll(covered, step, axis)
    return inside


def square(picture: np.ndarray, covered: np.ndarray) -> np.ndarray:
    """The object in the middle of a square, white paper around it."""
    height, width = covered.shape
    side = min(height, width)
    top, left = (height - side) // 2, (width - side) // 2
    cut = np.where(covered[..., None], picture, 1.0)[top : top + side, left : left + side]
    return np.asarray(cut, np.float32)


def take(browser: Browser, address: str, name: str, screen: Screen) -> None:
    """A screenshot of the page, when its picture is whole and has hardly any noise."""
    (width, height), scheme, fragment = screen
    page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)  # pyright: ignore[reportArgumentType]
    page.goto(address + fragment)
    try:
        page.wait_for_function(FINE, arg=ENOUGH, timeout=PATIENCE)
    except TooLate:
        print(f"{name}: no whole picture within {PATIENCE // 1000} s, left as it was.", flush=True)
        page.close()
        return
    page.screenshot(path=IMAGES / f"{name}.png", full_page=True)
    page.close()
    Image.open(IMAGES / f"{name}.png").convert("RGB").save(IMAGES / f"{name}.webp", quality=86)
    (IMAGES / f"{name}.png").unlink()


if __name__ == "__main__":
    main()
