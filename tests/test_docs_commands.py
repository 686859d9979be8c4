"""Every command, every Python block and every example that README and the documentation show does what it says.

All of them run in-process, page by page in an empty folder, on a part of the built-in library at a coarse grid and with small
pictures; what cannot is in `NOT_RUN`, with its reason. Every command of ours, run or not, must have the options that it shows.
"""

import re
import shlex
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import pytest
import typer

from halfway.cli import app, console
from halfway.cli import main as halfway
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.yardstick.splits import split

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")])
EXAMPLES = sorted((ROOT / "examples").iterdir())
NAMED = {word for path in [*PAGES, *EXAMPLES] for word in re.findall(r"[\w-]+", path.read_text())}
"""Materials among them."""
JUDGED = set(split("liu2023", list(builtin("merl-abc").models)).test)
"""What the benchmark needs."""
N_MATERIALS = 24
"""Of a built-in set, beside those; an example shows 60 components."""
COARSE = Grid.merl(18, 12, 12)
COARSE_ANISOTROPIC = Grid.anisotropic(18, 12, 8, 12)

NOT_RUN = {
    r"^halfway fetch ": "downloads",
    r"^halfway (view|doctor)\b": "serves until it is stopped; looks at the machine (tested elsewhere)",
    r"^halfway demo\b": "takes a minute (run by the test of the release)",
    r"^halfway .*(merl|mine|rgl|neural)\.brdflib": "needs measurements",
    r"^halfway .*(BRDFDatabase|merl_nbrdf\.zip|rgl/|rgl\.brdflib|library build (merl|rgl) )": "needs measurements",
    r"^halfway .*(s3://|gs://|--scheduler|tcp://)": "needs a cluster or a bucket",
    r"^halfway .*(FILE|FOLDER|LIB|DIR|NAME|IN|OUT|WHAT|URL)\b": "names what the reader has",
    r"^halfway .*(--env|--mesh) ": "takes a file that the reader has",
    r"^halfway find --like (sphere|photo)\.png": "takes a picture that the reader has (tested in test_environment)",
    r"^halfway .*both\.brdflib": "takes gigabytes (tested in test_anisotropy)",
    r"^halfway .*fabric\.bin": "needs a measurement (tested in test_goniometric)",
    r"^halfway fit ": "takes a minute and more (tested in test_fit and test_export_fits)",
    r"^halfway benchmark": "takes a minute and more (tested in test_yardstick)",
    r"^halfway reproduce": "takes a minute (tested in test_paper)",
    r"^halfway .*--pairs": "takes minutes (tested in test_cli)",
    r"^halfway .*--for pbrt-v2": "takes the database's grid alone (tested in test_export_scenes)",
    r"^halfway library build builtin:synthetic-2000": "takes ten seconds (another page builds 200 of them)",
    r"^halfway export .*--for blender": "fits sixteen models (tested in test_export_blender)",
    r"^halfway .*--turntable": "sets up a scene for each side (tested in test_render_pictures)",
    r"\.mp4": "needs an extra",
}
"""Which commands are not run here, and why."""
BLOCKS_NOT_RUN = {"cluster": "needs a cluster (tested in test_cluster)"}
"""The pages whose Python is not run here, and why."""
GIVEN = {
    "metal": "halfway route cherry-235 tungsten-carbide -n 5 -o metal",
    "set": "halfway sample -n 3 --split all=100 --blend linear -o set",
    "new.binary": 'halfway mix "gold-paint=0.7, teflon=0.3" -o new.binary',
}
"""What pages beside the tutorial take for made, and how."""
SMALLER = {"render": ["--size", "24x20", "--spp", "1"]}
"""Options that make a command quick without changing what it does."""


def commands(page: Path) -> list[str]:
    """The lines of the page that are typed at a prompt: in ``sh`` blocks, or indented."""
    text = page.read_text()
    fenced = re.findall(r"^```(?:sh|console)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    indented = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    lines = [line for block in fenced for line in block.splitlines()]
    lines += [
        line[4:] for line in indented.splitlines() if re.match(r"    (\$ )?(halfway|make) ", line)
    ]
    return [line.removeprefix("$ ") for line in lines if line.strip()]


def blocks(page: Path) -> list[str]:
    """The Python blocks of the page."""
    return re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def small(monkeypatch, tmp_path, cache):
    """Tables of some built-in materials on a coarse grid, an empty folder, and a cache of our own."""

    def coarse(name, brdfs, **options):
        kept = NAMED | JUDGED | set(list(brdfs)[:N_MATERIALS])
        few = {each: brdf for each, brdf in brdfs.items() if each in kept}
        grid = COARSE if options["grid"].is_isotropic else COARSE_ANISOTROPIC
        return ProceduralLibrary(name, few, **{**options, "grid": grid})

    monkeypatch.setattr("halfway.library.opening.ProceduralLibrary", coarse)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(console, "cache_folder", lambda: cache)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_have_the_options_that_they_show(page):
    root = typer.main.get_command(app)
    for line in commands(page):
        words = shlex.split(line, comments=True)
        if words[0] == "make":
            assert all(f"\n{target}:" in (ROOT / "Makefile").read_text() for target in words[1:]), (
                line
            )
        if words[0] != "halfway":
            continue
        command, name, rest = root, "halfway", words[1:]
        while hasattr(command, "commands") and rest and rest[0] != "--help":
            assert rest[0] in command.commands, f"{page.name}: {line}"
            command, name, rest = command.commands[rest[0]], f"{name} {rest[0]}", rest[1:]
        if "--help" not in rest:
            command.make_context(name, [word for word in rest if word != "--debug"])


@pytest.mark.parametrize("page", [p for p in PAGES if commands(p)], ids=lambda page: page.stem)
def test_commands_run(page, monkeypatch, capsys):
    n_run = 0
    shown = commands(page)
    given = [made for what, made in GIVEN.items() if any(what in line.split() for line in shown)]
    for line in given + shown:
        words = shlex.split(line, comments=True)
        if words[0] == "cd" and n_run:
            break  # from there on another program is at work, in what was written
        if words[0] != "halfway" or any(re.search(pattern, line) for pattern in NOT_RUN):
            continue
        monkeypatch.setattr(sys, "argv", [*words, *SMALLER.get(words[1], [])])
        code = 0
        try:
            halfway()
        except SystemExit as stop:
            code = stop.code
        assert not code, f"{page.name}: {line}\n{capsys.readouterr().err}"
        n_run += 1


@pytest.mark.parametrize(
    "page",
    [page for page in PAGES if blocks(page) and page.stem not in BLOCKS_NOT_RUN],
    ids=lambda page: page.stem,
)
def test_python_blocks_run(page):
    """Those of a page are one program."""
    run(blocks(page), page.name)


def test_the_example_notebook_runs_and_carries_no_outputs():
    notebook = nbformat.read(ROOT / "examples" / "explore.ipynb", as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in code)
    run([cell.source for cell in code], "explore.ipynb")


@pytest.mark.parametrize(
    "example", [path for path in EXAMPLES if path.suffix == ".py"], ids=lambda path: path.stem
)
def test_examples_of_the_gallery_run(example):
    run([example.read_text()], example.name)
    assert plt.get_fignums()
    plt.close("all")


def run(blocks, name):
    names: dict[str, object] = {"__name__": "__main__"}
    for block in blocks:
        exec(compile(block, name, "exec"), names)
