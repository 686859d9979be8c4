"""The widget in a real JupyterLab: what the person moves, Python sees, and the other way round."""

import json
import os
import secrets
import subprocess
import sys
from collections.abc import Callable, Generator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import nbformat
import pytest
from conftest import opened  # pyright: ignore[reportMissingImports]
from patience import PATIENCE, wait_until
from playwright.sync_api import Browser, Page, expect

from halfway.server.page import refresh

TOKEN = secrets.token_hex(16)
LIBRARY = """
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.notebook import Explorer
from halfway.tasks import Work

models = builtin("merl-abc").models
names = ["cherry-235", "chrome", "gold-paint", "pink-felt", "teflon"]
library = ProceduralLibrary("browser", {name: models[name] for name in names}, grid=Grid.merl(60, 30, 36))
explorer = Explorer(library, ["cherry-235", "teflon"], space="linear", pace="uniform", work=Work())
explorer
"""
PYTHON_MOVES = """
explorer.stops = ["chrome", "pink-felt", "teflon"]
explorer.t = 0.25
"""
WHAT_PYTHON_HAS = (
    "print([explorer.stops, explorer.space, explorer.t, explorer.recipe.to_json()['weights']])"
)
RUN = """
async i => {
  const panel = jupyterapp.shell.currentWidget;
  await panel.sessionContext.ready;
  panel.content.activeCellIndex = i;
  return jupyterapp.commands.execute("notebook:run-cell");
}
"""
CELLS = (LIBRARY, PYTHON_MOVES, WHAT_PYTHON_HAS)


@pytest.fixture(scope="module")
def jupyter(tmp_path_factory: pytest.TempPathFactory) -> Generator[str]:
    """The address of a JupyterLab with one notebook of `CELLS`."""
    pytest.importorskip("jupyterlab", reason="needs jupyterlab, of the development packages")
    refresh(Path(__file__).parents[2])
    home = tmp_path_factory.mktemp("jupyter")
    cells = [nbformat.v4.new_code_cell(cell.strip()) for cell in CELLS]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=kernel), home / "explore.ipynb")
    folders = {
        f"JUPYTER_{kind}_DIR": str(home / kind.lower()) for kind in ("CONFIG", "DATA", "RUNTIME")
    }
    command = [
        sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--expose-app-in-browser", "--ServerApp.ip=127.0.0.1", "--ServerApp.port=0",
        f"--IdentityProvider.token={TOKEN}", f"--ServerApp.root_dir={home}",
        "--LabApp.news_url=", "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
    ]  # fmt: skip
    environment = {**os.environ, **folders, "IPYTHONDIR": str(home / "ipython")}
    with (
        (home / "log").open("w") as log,
        subprocess.Popen(command, env=environment, stdout=log, stderr=log) as server,
    ):
        try:
            yield f"{_address(server, home)}lab/tree/explore.ipynb?token={TOKEN}"
        finally:
            server.terminate()
            server.wait(PATIENCE)


def _address(server: subprocess.Popen[bytes], home: Path) -> str:
    """Where Jupyter says that it listens, once it has said so in a whole file."""
    told: list[str] = []

    def listens() -> bool:
        for path in (home / "runtime").glob("jpserver-*.json"):
            with suppress(ValueError):  # half written
                told.append(json.loads(path.read_text())["url"])
        return bool(told) or server.poll() is not None

    wait_until(listens)
    assert told, f"Jupyter ended:\n{(home / 'log').read_text()[-2000:]}"
    return told[0]


@dataclass
class Notebook:
    """The notebook in the browser."""

    page: Page

    def run(self, i: int) -> None:
        """Run cell ``i``, and wait until it is done."""
        assert self.page.evaluate(RUN, i), "the cell failed or was not run"

    def python_has(self, told: Callable[[list], bool]) -> list:
        """What Python has, once it was told: the page tells it when the kernel has time."""
        wait_until(lambda: told(self.python()), lambda: self.page.wait_for_timeout(100))
        return self.python()

    def python(self) -> list:
        """What Python has: stops, space, t, weights."""
        self.run(2)
        text = (
            self.page.locator(".jp-Notebook .jp-CodeCell").nth(2).locator(".jp-OutputArea-output")
        )
        return eval(text.inner_text())

    @property
    def t(self) -> str:
        return self.page.locator(".halfway .t b").inner_text()


@pytest.fixture(scope="module")
def notebook(jupyter: str, browser: Browser) -> Generator[Notebook]:
    errors: list[str] = []
    with opened(browser, viewport={"width": 1300, "height": 1000}) as page:
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on(
            "console",
            lambda message: errors.append(message.text) if "THREE" in message.text else None,
        )
        page.goto(jupyter)
        page.locator(".jp-Notebook .jp-CodeCell").nth(2).wait_for()
        notebook = Notebook(page)
        notebook.run(0)
        page.wait_for_selector(".halfway.ready")
        yield notebook
    assert not errors, "\n".join(errors)


def test_the_page_shows_itself_where_python_says(notebook: Notebook) -> None:
    page = notebook.page
    page.wait_for_function(
        "() => Number(document.querySelector('.halfway .material').dataset.samples) >= 1"
    )
    assert notebook.t == "0.500"
    names = page.locator(".halfway .recipe .name").all_text_contents()
    assert sorted(names) == ["cherry-235", "teflon"]


def test_what_the_person_moves_python_sees(notebook: Notebook) -> None:
    page = notebook.page
    page.locator(".halfway [name=t]").fill("0.75")
    stops, space, t, weights = notebook.python_has(lambda has: has[2] != 0.5)
    assert (stops, space, t) == (["cherry-235", "teflon"], "linear", 0.75)
    assert weights == pytest.approx({"cherry-235": 0.25, "teflon": 0.75})


def test_what_python_moves_the_person_sees(notebook: Notebook) -> None:
    notebook.run(1)
    page = notebook.page
    expect(page.locator(".halfway .t b")).to_have_text("0.250")
    chips = page.locator(".halfway .chip[data-stop]")
    expect(chips).to_have_count(3)
    assert [chip.get_attribute("data-stop") for chip in chips.all()] == [
        "chrome",
        "pink-felt",
        "teflon",
    ]
    names = page.locator(".halfway .recipe .name")
    expect(names.filter(has_text="pink-felt")).to_have_count(1)
    assert sorted(names.all_text_contents()) == ["chrome", "pink-felt"]
    assert notebook.python()[3] == pytest.approx({"chrome": 0.5, "pink-felt": 0.5})


def test_the_page_takes_its_own_keys(notebook: Notebook) -> None:
    page = notebook.page
    page.locator(".halfway [name=search]").fill("gold")
    page.keyboard.press("Enter")
    expect(page.locator(".halfway .chip[data-stop=gold-paint]")).to_have_count(1)
    assert "gold-paint" in notebook.python_has(lambda has: "gold-paint" in has[0])[0]
    # Nothing of it was a command of the notebook.
    assert page.locator(".jp-Notebook .jp-CodeCell").count() == len(CELLS)
