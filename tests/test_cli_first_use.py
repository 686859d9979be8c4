"""Commands as people write them before they have read anything."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from strategies import random_tables

from halfway.cli.completion import complete_library
from halfway.formats import read_merl, write_merl
from halfway.halfdiff import Grid

GRID = Grid.merl(4, 3, 5)
TABLES = random_tables(7, GRID)


@pytest.fixture
def run(run, tmp_path):
    """The same, in a folder with files and a library."""
    for name, table in TABLES.items():
        write_merl(tmp_path / "measured" / f"{name}.binary", table)
    assert run("library", "build", "measured", "-o", "x.brdflib")[0] == 0
    return run


MIX = "x.brdflib", "material-0=0.5, material-1=0.5"


def test_a_file_of_ones_own_is_replaced_with_force_alone(run, tmp_path):
    ours = "mix", *MIX, "-o", "new.binary"
    assert [run(*ours)[0], run(*ours)[0]] == [0, 0]
    mine = (tmp_path / "new.binary").read_bytes()[:-4] + b"mine"
    (tmp_path / "new.binary").write_bytes(mine)
    code, _, talk = run(*ours)
    assert (code, "add --force to replace it" in talk) == (1, True)
    assert (tmp_path / "new.binary").read_bytes() == mine
    assert run(*ours, "--force")[0] == 0


@pytest.mark.parametrize(
    "words",
    [
        "convert x.brdflib:material-0 mine.bsdf",
        "convert x.brdflib mine --format binary",
        "export measured/material-0.binary --for mitsuba -o mine",
        "report x.brdflib -o mine",
        "fit measured/material-0.binary -o mine.mtlx",
        "check measured/material-0.binary --repair -o mine.binary",
        "library compact x.brdflib -k 2 -o mine.brdfc",
        "render measured/material-0.binary -o mine.png --size 16 --spp 1",
        "view x.brdflib --export mine",
    ],
)
def test_no_command_writes_over_what_it_did_not_write(run, tmp_path, words):
    name = next(word for word in words.split() if word.startswith("mine"))
    mine = tmp_path / name if "." in name else tmp_path / name / "README.md"
    mine.parent.mkdir(exist_ok=True)
    mine.write_text("mine")
    code, out, talk = run(*words.split())
    assert (code, out, "--force" in talk) == (1, "", True)
    assert mine.read_text() == "mine"


def test_json_is_printed_and_files_are_written_where_they_are_asked_for(run, tmp_path):
    before = {path.name for path in tmp_path.iterdir()}
    assert json.loads(run("report", "x.brdflib", "--json")[1])["format"] == 1
    assert {path.name for path in tmp_path.iterdir()} - {"cache"} == before
    assert run("report", "x.brdflib", "--json", "-o", "r")[0] == 0
    assert json.loads(run("verify", "r", "--json")[1])["ok"]


def test_two_materials_are_compared(run):
    code, out, _ = run("diff", "measured/material-0.binary", "x.brdflib:material-1", "--json")
    apart = json.loads(out)
    assert (code, apart["log"]["below"] > 0) == (0, True)
    same = json.loads(run("diff", *["x.brdflib:material-1"] * 2, "--metric", "log", "--json")[1])
    assert same["log"] == {"below": 0.0, "grazing": 0.0}
    assert (
        "there is no metric 'rmse'"
        in run("diff", *["x.brdflib:material-1"] * 2, "--metric", "rmse")[2]
    )


def test_a_folder_and_a_library_are_converted_on_any_grid(run, tmp_path):
    assert run("convert", "measured", "-o", "coarse", "--grid", "3x2x4")[0] == 0
    table = read_merl(tmp_path / "coarse" / "material-0.binary")
    assert table.grid == Grid.merl(3, 2, 4)
    assert run("verify", "coarse")[0] == 0
    assert "name one of them, or a folder" in run("convert", "measured", "one.binary")[2]


def test_check_goes_on_past_what_cannot_be_read(run, tmp_path):
    (tmp_path / "cut.binary").write_bytes(
        (tmp_path / "measured/material-0.binary").read_bytes()[:99]
    )
    code, out, talk = run("check", "cut.binary", "measured/material-1.binary", "--json")
    (cut, whole) = json.loads(out)
    assert "99" in cut["error"] or "shorter" in cut["error"]
    assert "ok" in whole
    assert "1 cannot be read" in talk
    assert run("check", "cut.binary")[0] == 3
    assert code == (3 if whole["ok"] else 1)


def test_a_name_that_steers_a_terminal_is_shown_as_text(run):
    write_merl("\x1b[31mred.binary", TABLES["material-0"])
    for words in (["check", "\x1b[31mred.binary"], ["info", "\x1b[31mred.binary"]):
        _, out, talk = run(*words)
        assert "\x1b" not in out + talk
        assert "red" in out


def test_facts_are_json_as_well(run):
    (facts,) = json.loads(run("info", "measured/material-0.binary", "--json")[1])
    assert (facts["name"], facts["is"]) == ("material-0", "a table of 4 x 3 x 5 cells")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("view x.brdflib --port 80000 --no-browser", "80000 is no port: expected 1 to 65535"),
        ("mix x.brdflib --point=1,nan -o x.binary", "is no list of finite numbers"),
        ("mix deep.json -o x.binary", "nests too deep"),
        ("render x.brdflib -o e.webp --fps 0 --scene sphere --size 16", "0 frames per second are"),
    ],
)
def test_what_used_to_be_a_traceback_is_a_line(run, tmp_path, words, message):
    (tmp_path / "deep.json").write_text("[" * 100_000)
    code, _, talk = run(*words.split())
    assert (code, len(talk.splitlines())) == (1, 1)
    assert message in talk


@pytest.mark.parametrize(
    ("where", "code", "talk"),
    [("| head -c 1", 141, ""), (">/dev/full", 1, "No space left"), (">/dev/full 2>&1", 1, "")],
)
def test_an_answer_that_nobody_takes_is_quiet(where, code, talk):
    script = (
        "import sys; sys.argv = ['halfway']; from halfway.cli import console; "
        "console.run(lambda: [print('x' * 99) for _ in range(9999)] and None)"
    )
    command = f'"{sys.executable}" -c "{script}" {where}; exit ${{PIPESTATUS[0]}}'
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert talk in done.stderr
    assert "Exception ignored" not in done.stderr
    assert len(done.stderr.splitlines()) == bool(talk)


def test_the_shell_completes_libraries():
    assert "builtin:merl-abc" in complete_library("builtin:m")
    assert complete_library("mine") == []


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("route tungs", "tungsten-carbide"),
        ("route cherry-235 tungs", "tungsten-carbide"),
        ("route builtin:merl-sgd cherry-235 tungs", "tungsten-carbide"),
        ("space --near tungs", "tungsten-carbide"),
        ("convert builtin:merl-sgd:tungs", "builtin:merl-sgd:tungsten-carbide"),
    ],
)
def test_the_shell_completes_names(typed, expected):
    words = f"halfway {typed}"
    asked = {"_HALFWAY_COMPLETE": "complete_zsh", "_TYPER_COMPLETE_ARGS": words}
    done = subprocess.run(
        [Path(sys.executable).parent / "halfway"],
        env={**os.environ, **asked},
        capture_output=True,
        text=True,
        check=False,
    )
    assert expected in done.stdout.replace("\\", "")  # before colons
