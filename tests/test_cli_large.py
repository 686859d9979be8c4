"""Large and compact libraries on the command line."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from halfway.cli import arguments
from halfway.errors import HalfwayError
from halfway.formats import write_merl
from halfway.halfdiff import Grid
from halfway.library import CompactLibrary, build_library, compact_file, open_library


def test_a_library_is_built_on_a_grid_added_to_and_kept_compact(run, tmp_path):
    code, _, err = run(
        "library", "build", "builtin:synthetic-8", "--grid", "6x5x4", "-o", "a.brdflib"
    )
    assert (code, err.split(".")[0]) == (0, "a")
    assert "8 materials on 6 x 5 x 4" in err
    code, _, err = run("library", "build", "a.brdflib", "builtin:merl-abc", "-o", "a.brdflib")
    assert "108 materials on 6 x 5 x 4" in err
    code, _, err = run("library", "compact", "a.brdflib", "-k", "9", "-o", "a.brdfc")
    assert code == 0
    assert "compact: 9 log components shared by the channels, int8" in err
    assert "times less than tables of 0.2 MB" in err
    code, out, _ = run("library", "info", "a.brdfc", "--json")
    facts = json.loads(out)
    assert facts["compact"]["n_components"] == 9
    assert facts["compact"]["n_bytes"] == (tmp_path / "a.brdfc").stat().st_size
    assert 0 < facts["compact"]["error"]["mean_relative_error"] < 1
    code, out, _ = run("library", "info", "a.brdfc")
    assert "reconstructed from 9 principal components" in out
    code, out, _ = run("route", "a.brdfc", "chrome", "metal-0002", "-n", "3", "--json")
    assert len(json.loads(out)["recipes"]) == 3


def test_a_compact_library_is_a_source_like_any_other(run):
    run("library", "build", "builtin:synthetic-4", "--grid", "6x5x4", "-o", "a.brdflib")
    run("library", "compact", "a.brdflib", "-k", "3", "-o", "a.brdfc")
    code, _, err = run("library", "build", "a.brdfc", "builtin:merl-abc", "-o", "b.brdflib")
    assert (code, err.partition(".")[0]) == (0, "b")
    assert "104 materials on 6 x 5 x 4" in err
    built, compact = open_library("b.brdflib"), open_library("a.brdfc")
    np.testing.assert_array_equal(built.row(2), compact.row(2))
    assert "reconstructed from 3 principal components" in built.origin.description
    assert "changed" not in run("library", "verify", "b.brdflib")[1]
    run("library", "compact", "a.brdflib", "-k", "2", "-o", "a.brdfc")
    assert run("library", "verify", "b.brdflib")[1].count("changed") == 4


def test_a_compact_library_whose_making_was_stopped_says_so(run, tmp_path):
    """Killed after the file took its place and before its error was written."""
    run("library", "build", "builtin:synthetic-5", "--grid", "4x3x2", "-o", "a.brdflib")
    run("library", "compact", "a.brdflib", "-k", "3", "-o", "a.brdfc")
    made = CompactLibrary(tmp_path / "a.brdfc")
    compact_file.write(made.path, replace(made.header, error={}), made._arrays)
    code, out, err = run("library", "info", "a.brdfc")
    assert (code, err) == (0, "")
    assert "error: not measured, as its making was stopped: make it again" in out


def test_a_dry_run_says_what_it_takes_and_writes_nothing(run, tmp_path):
    run("library", "build", "builtin:synthetic-5", "--grid", "4x3x2", "-o", "a.brdflib")
    code, out, err = run("report", "a.brdflib", "--dry-run")
    assert (code, err) == (0, "")
    assert out.startswith("5 materials x 24 cells: exact, one pass\n1 block of 24 columns")
    assert [path.name for path in tmp_path.iterdir()] == ["a.brdflib"]
    code, out, err = run("report", "a.brdflib", "--dry-run", "--json")
    assert json.loads(out)["n_materials"] == 5


def test_a_compact_library_is_verified_and_one_that_is_computed_cannot_be(run, tmp_path):
    run("library", "build", "builtin:synthetic-5", "--grid", "4x3x2", "-o", "a.brdflib")
    run("library", "compact", "a.brdflib", "-k", "3", "-o", "a.brdfc")
    assert run("library", "verify", "a.brdfc") == (0, "", "a.brdfc: 5 of 5 materials right.\n")
    path = tmp_path / "a.brdfc"
    path.write_bytes(path.read_bytes()[:-40])
    code, _, err = run("library", "verify", "a.brdfc")
    assert (code, "a.brdfc is no sound compact library" in err) == (1, True)
    code, _, err = run("library", "verify", "builtin:synthetic-5")
    assert (code, "is computed when asked for" in err) == (1, True)


def test_a_misspelt_name_is_answered_by_a_command_that_works_from_anywhere(run, tmp_path):
    run("library", "build", "builtin:synthetic-5", "--grid", "4x3x2", "-o", "a b.brdflib")
    code, _, err = run("route", "a b.brdflib", "nothing\nlike it", "matte-0000")
    assert (code, err.count("\n")) == (1, 1)
    assert f"`halfway library info '{tmp_path / 'a b.brdflib'}'` lists them." in err


def test_a_terminal_without_a_letter_gets_its_number(tmp_path, small_library):
    write_merl(tmp_path / "gold \u2600.binary", small_library.brdf(small_library.names[0]))
    build_library([tmp_path], tmp_path / "a.brdflib")
    command = [sys.executable, "-m", "halfway", "library", "info", str(tmp_path / "a.brdflib")]
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert "gold \\u2600" in found.stdout


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ("library", "compact", "nowhere", "-o", "a.brdfc"),
            "there is no library 'nowhere': expected a .brdflib folder, a .brdfc file",
        ),
        (
            ("library", "compact", "builtin:synthetic-2", "-k", "6", "-o", "a.brdfc"),
            "cannot be kept in 6 components: it has 6 rows, and fewer are expected",
        ),
        (
            ("library", "build", "builtin:synthetic-2", "--grid", "4x0x2", "-o", "a.brdflib"),
            "--grid '4x0x2' is no grid: expected cells in theta_h, theta_d and phi_d, such as 30x30x60, or in",
        ),
    ],
)
def test_a_mistake_is_one_line(run, tmp_path, words, message):
    code, out, err = run(*words)
    assert (code, out) == (1, "")
    assert message in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_grid_is_written_by_its_sizes():
    assert arguments.parse_grid("30x20X60") == Grid.merl(30, 20, 60)
    assert arguments.parse_grid("48x36x24x12") == Grid.anisotropic(48, 36, 24, 12)
    for text in ("30", "30x20", "axbxc", "1x1x1001", "-1x2x3"):
        with pytest.raises(HalfwayError, match="is no grid"):
            arguments.parse_grid(text)
