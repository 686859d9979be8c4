"""A real Chromium, drawn by its software rasteriser."""

import shutil
from collections.abc import Generator
from contextlib import contextmanager

import pytest
from patience import PATIENCE
from playwright.sync_api import Browser, Error, sync_playwright

FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--process-per-site",  # a page of a context begins in the process of the others
]


@contextmanager
def chromium() -> Generator[Browser]:
    """A machine's own where there is one, else the one that Playwright installs; skips a test where there is none."""
    with sync_playwright() as playwright:
        try:
            browser = playwright.chromium.launch(
                executable_path=shutil.which("chromium"), args=FLAGS, timeout=1000 * PATIENCE
            )
        except Error as error:
            pytest.skip(
                f"needs a Chromium (`playwright install chromium`): {str(error).splitlines()[0]}"
            )
        yield browser
        browser.close()
