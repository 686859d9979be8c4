"""The command line as a person meets it: real processes for start-up, in-process runs for the rest."""

import importlib.metadata
import json
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from halfway import TabularBrdf
from halfway.cli import arguments
from halfway.cli.library import skipped_lines
from halfway.errors import HalfwayError
from halfway.formats import Skipped, read_merl, write_merl
from halfway.halfdiff import Grid
from halfway.library import open_library
from halfway.measurements import Angles

GRID = Grid.merl(4, 3, 5)
COMMANDS = [
    "demo",
    "view",
    "route",
    "mix",
    "recover",
    "plan",
    "render",
    "report",
    "reproduce",
    "space",
    "check",
    "fit",
    "convert",
    "info",
    "fetch",
    "doctor",
    "library",
]


def test_help_is_quick_and_loads_nothing_heavy():
    script = (
        "import sys; from halfway.cli import app; "
        "heavy = {'numpy', 'scipy', 'numba', 'mitsuba', 'matplotlib', 'h5py', 'rich.progress'} & set(sys.modules); "
        "sys.exit(f'loaded {heavy}' if heavy else 0)"
    )
    subprocess.run([sys.executable, "-c", script], check=True)


def test_importing_the_package_loads_nothing_heavy():
    script = "import sys, halfway; sys.exit('numpy' in sys.modules or 'mitsuba' in sys.modules)"
    subprocess.run([sys.executable, "-c", script], check=True)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(run, command):
    code, out, _ = run(*command.split(), "--help")
    assert code == 0
    assert "Usage: halfway" in out


@pytest.mark.usefixtures("lib")
def test_build_says_what_it_skipped_and_what_is_next(run):
    code, _, talk = run("library", "build", "measured", "-o", "again.brdflib")
    assert code == 0
    assert "skipped measured/README: is text" in talk
    assert "again.brdflib: 7 materials on 4 x 3 x 5, 1 skipped. Next: halfway report" in talk


def test_many_files_that_are_skipped_for_one_reason_are_one_line():
    text = [Skipped(f"notes/{i}", "is text") for i in range(1200)]
    lines = skipped_lines([*text[:600], Skipped("a.zip", "is no zip"), *text[600:]])
    assert lines == [
        "skipped 1,200, notes/0 to notes/1199: is text",
        "skipped a.zip: is no zip",
    ]


def test_info_is_for_people_and_programs(run, lib):
    assert "material-3" in run("library", "info", lib)[1]
    facts = json.loads(run("library", "info", lib, "--json")[1])
    assert (facts["grid"], facts["licence"], len(facts["materials"])) == ([4, 3, 5], "CC0", 7)


def test_route_writes_recipes_and_tables(run, lib, tmp_path):
    words = (
        "route",
        lib,
        "material-0",
        "material-4",
        "-n",
        "5",
        "--space",
        "paper",
        "-o",
        "r",
        "--format",
        "merl",
    )
    code, _, talk = run(*words)
    assert (code, "5 tables written" in talk) == (0, True)
    for file, name in (("000", "material-0"), ("004", "material-4")):
        assert (tmp_path / "r" / f"{file}.binary").read_bytes() == (
            tmp_path / "measured" / f"{name}.binary"
        ).read_bytes()
    assert "0 tables written, 5 kept" in run(*words)[2]


def test_a_route_may_begin_at_a_recipe(run, lib, tmp_path):
    (tmp_path / "found.json").write_text('{"weights": {"material-0": 0.5, "material-1": 0.5}}')
    words = ("route", lib, "found.json", "material-4", "-n", "3", "--blend", "linear", "--json")
    route = json.loads(run(*words)[1])
    assert route["stops"] == ["mix of 2", "material-4"]
    assert route["recipes"][0]["weights"] == {"material-0": 0.5, "material-1": 0.5}
    assert "Take --blend linear" in run(*words[:6], "--blend", "lobes")[2]


def test_route_prints_json_alone_on_stdout(run, lib, tmp_path):
    code, out, _ = run(
        "route",
        lib,
        "material-0",
        "material-4",
        "material-2",
        "--t",
        "0,0.5,1",
        "--space",
        "linear",
        "--pace",
        "uniform",
        "--json",
    )
    document = json.loads(out)
    assert code == 0
    assert [r["weights"] for r in document["recipes"]] == [
        {"material-0": 1.0},
        {"material-4": 1.0},
        {"material-2": 1.0},
    ]
    assert sorted(p.name for p in tmp_path.iterdir() if p.name != "cache") == [
        "measured",
        "tiny.brdflib",
    ]


def test_mix_by_weights_by_recipe_file_and_by_place_on_a_route(run, lib, tmp_path):
    assert run("mix", lib, "material-0=0.5, material-1=0.5", "-o", "a.binary")[0] == 0
    (tmp_path / "recipe.json").write_text(
        json.dumps({"weights": {"material-0": 0.5, "material-1": 0.5}})
    )
    assert run("mix", lib, "recipe.json", "-o", "b.binary")[0] == 0
    run(
        "route",
        lib,
        "material-0",
        "material-1",
        "-n",
        "3",
        "--space",
        "linear",
        "--pace",
        "uniform",
        "-o",
        "r",
    )
    assert run("mix", lib, "r/recipes.json:1", "-o", "c.binary")[0] == 0
    a, b, c = (read_merl(tmp_path / f"{name}.binary").values for name in "abc")
    assert_allclose(b, a, rtol=1e-6)
    assert_allclose(c, a, rtol=1e-6)


def test_a_route_is_anchored_and_paced_unless_asked_otherwise(run, lib):
    document = json.loads(run("route", lib, "material-0", "material-4", "-n", "3", "--json")[1])
    assert (document["space"], document["pace"]) == ("anchored", "perceptual")


def test_places_neighbours_and_free_points(run, lib, tmp_path):
    places = json.loads(run("space", lib, "--json")[1])
    assert places["coordinates"][-3:] == ["body_r", "body_g", "body_b"]
    point = ",".join(map(str, places["points"]["material-2"]))
    assert run("mix", lib, f"--point={point}", "-o", "there.binary")[0] == 0
    there, own = (read_merl(tmp_path / f) for f in ("there.binary", "measured/material-2.binary"))
    assert_allclose(there.values, own.values, rtol=1e-4)
    code, _, talk = run("mix", lib, "--point=1e9,0,0,0,0,0", "-o", "far.binary")
    assert (code, "--clamp takes it" in talk) == (1, True)
    assert run("mix", lib, "--point=1e9,0,0,0,0,0", "--clamp", "-o", "far.binary")[0] == 0


def test_a_material_of_ones_own_is_placed_in_the_space(run, lib):
    """A file is where the material is that it holds, under a header, and what is no mix is said."""
    points = json.loads(run("space", lib, "--json")[1])["points"]
    header, line, measure, *nearest = run("space", lib, "--near", "measured/material-2.binary", "-n", "3")[1].splitlines()  # fmt: skip
    assert header.split()[-2:] == ["body_b", "material"]
    assert_allclose([float(x) for x in line.split()[:-1]], points["material-2"], rtol=1e-4)
    assert (measure.split(), nearest[0].split()[1]) == (["distance", "material"], "material-2")
    assert len(nearest) == 3
    _, line, measure, first, *_ = run("space", lib, "--near", "material-2")[1].splitlines()
    assert_allclose([float(x) for x in line.split()[:-1]], points["material-2"], rtol=1e-4)
    assert "material-2" not in first
    half = json.loads(
        run("space", lib, "--blend", "linear", "--near", "material-1=.5,material-2=.5", "--json")[1]
    )
    middle = np.mean([half["points"]["material-1"], half["points"]["material-2"]], axis=0)
    assert_allclose(half["near"]["point"], middle, rtol=1e-5)
    assert half["near"]["inside"] is True
    code, _, talk = run("space", lib, "--near", "material-22")
    assert (code, "did you mean material-2" in talk) == (1, True)


def test_a_table_that_is_no_mix_is_said_to_be_outside(run, lib, tmp_path):
    bright = read_merl(tmp_path / "measured/material-2.binary")
    write_merl(tmp_path / "bright.binary", TabularBrdf(10 * bright.values, bright.grid))
    _, line, mix, *_ = run("space", lib, "--near", "bright.binary")[1].splitlines()
    assert mix.endswith("(the nearest mix: it is outside the hull)")
    assert line.split()[:6] != mix.split()[:6]
    near = json.loads(run("space", lib, "--near", "bright.binary", "--json")[1])["near"]
    assert near["inside"] is False
    assert_allclose([float(x) for x in mix.split()[:6]], near["mix"], rtol=1e-4)


def test_report_prints_table_1_and_writes_figures(run, lib, tmp_path):
    code, out, _ = run("report", lib, "-o", "report")
    assert code == 0
    assert "mean relative error" in out
    names = {p.name for p in (tmp_path / "report").iterdir()}
    assert names == {
        "report.json",
        "eigenvalues.png",
        "eigenvalues.svg",
        "triangulation.png",
        "triangulation.svg",
        "manifest.json",
    }
    document = json.loads((tmp_path / "report" / "report.json").read_text())
    assert [row["n_components"] for row in document["table_1"]] == [3, 5]
    assert set(document["eigenvalues"]) == {"r", "g", "b"}
    mine = json.loads(run("report", lib, "-k", "1,4", "--json")[1])
    assert [row["n_components"] for row in mine["table_1"]] == [1, 4]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["route", "builtin:merl-abc", "teflon", "gold-pain"],
            "'gold-pain' is not one of the 100 materials",
        ),
        (["route", "nowhere.brdflib", "a", "b"], "there is no library 'nowhere.brdflib'"),
        (["route", "teflon"], "a route with 1 stop goes nowhere"),
        (["route", "teflon", "chrome", "-n", "1"], "expected -n 2 or more"),
        (
            ["route", "teflon", "chrome", "--t", "0,much"],
            "--t 'much' is no finite number and no range",
        ),
        (
            ["route", "teflon", "chrome", "--t", "0:1:1e-9"],
            "a route of 1,000,000,000 materials is too long: expected 100,000 or fewer.",
        ),
        (["route", "teflon", "chrome", "-n", "1000000000"], "is too long: expected 100,000"),
        (
            ["report", "-k", "3,-1"],
            "-k '3,-1' is no list of numbers of components: expected such as",
        ),
        (["mix", "teflon=0.5", "-o", "x.binary"], "sum to 0.5: they must sum to 1"),
        (["mix", "teflon=1", "-o", "x.tiff"], "has the suffix '.tiff', which names no format"),
        (["fit", "teflon", "-o", "x.obj"], "names no format of fitted models: expected .mtlx"),
        (["fit", "teflon", "chrome", "-o", "x.mtlx"], "2 materials are given: -o and --picture"),
        (["fit", "teflom"], "'teflom' is not one of the 100 materials"),
        (
            ["mix", "absent.json", "-o", "x.binary"],
            "absent.json is not there: expected a recipe's file. Check",
        ),
        (["library", "build", "absent", "-o", "x.brdflib"], "absent does not exist"),
        (["render", "absent.binary", "-o", "x.png"], "there is no file absent.binary"),
        (["render", "teflon", "-o", "s3://bucket/frames"], "is a URL: expected a path of this"),
    ],
)
def test_a_mistake_is_one_line_and_exit_1(run, words, message):
    code, out, talk = run(*words)
    assert (code, out) == (1, "")
    (line,) = talk.strip().splitlines()
    assert message in line


def test_an_unknown_option_is_exit_2(run):
    assert run("route", "--sideways")[0] == 2


def test_debug_shows_the_traceback(run):
    with pytest.raises(HalfwayError):
        run("library", "info", "nowhere", "--debug")


def test_an_unwritable_folder_is_one_line(run, lib, tmp_path):
    (tmp_path / "taken").write_text("")
    code, _, talk = run("route", lib, "material-0", "material-1", "-o", "taken/r")
    assert (code, "part of its path is a file, not a folder" in talk) == (1, True)


@pytest.mark.parametrize(
    ("text", "ts"),
    [
        ("0,0.25,1", [0, 0.25, 1]),
        ("0:1:0.25", [0, 0.25, 0.5, 0.75, 1]),
        ("0,0.5:1:0.25", [0, 0.5, 0.75, 1]),
    ],
)
def test_lists_of_t(text, ts):
    assert arguments.parse_t(text) == ts


@pytest.mark.parametrize(
    ("t", "told"),
    [("2", "t = 2 is off the route"), ("nan", "'nan' is no finite number"), ("inf", "'inf' is no")],
)
def test_a_mistake_in_a_route_is_told_before_a_space_is_fitted(run, lib, monkeypatch, t, told):
    monkeypatch.setattr("halfway.space.AnchoredSpace.fit", None)
    code, _, talk = run("route", lib, "material-0", "material-1", "--t", f"0,{t}")
    assert (code, told in talk) == (1, True)


def test_the_papers_fine_list_of_t():
    ts = arguments.parse_t("0.0001:1:0.0001")
    assert (len(ts), ts[0], ts[-1]) == (10_000, 0.0001, 1)
    np.testing.assert_array_equal(ts, np.arange(1, 10_001) / 10_000)


def test_two_routes_stand_below_each_other_and_side_by_side_when_they_move(run, lib):
    for name in ("one", "two"):
        code, _, talk = run(
            *f"route {lib} material-0 material-1 -n 3 --space linear --pace uniform -o {name}".split()
        )
        assert code == 0, talk
    for name in ("rows.png", "moving.webp"):
        words = f"render one two -o {name} --scene sphere --size 40 --spp 4"
        code, _, talk = run(*words.split())
        assert code == 0, talk
    with Image.open("rows.png") as rows, Image.open("moving.webp") as moving:
        assert rows.width == 3 * 40 + 2 * 2
        assert rows.height > 2 * 40
        assert (moving.n_frames, moving.width) == (3, 2 * 40 + 2)


def test_the_version_is_the_packages(run):
    code, out, _ = run("--version")
    assert (code, out.strip()) == (0, importlib.metadata.version("halfway"))


def test_a_plan_is_filled_in_and_recovered(run, lib, tmp_path):
    code, out, talk = run("plan", lib, "-n", "12", "-o", "plan.csv", "--picture", "plan.png")
    assert code == 0, talk
    assert len(out.splitlines()) == 12
    assert "plan.csv: fill in r, g, b. Next: halfway recover plan.csv" in talk
    header, *rows = (tmp_path / "plan.csv").read_text().splitlines()
    angles = np.radians([[float(cell) for cell in row.split(",")[:4]] for row in rows])
    material = open_library(lib).brdf("material-3")
    values = material.eval(*Angles(*angles.T).directions())
    filled = [row.rstrip(",") + ",{},{},{}".format(*v) for row, v in zip(rows, values, strict=True)]
    (tmp_path / "new.csv").write_text("\n".join([header, *filled]))

    code, out, talk = run("recover", "new.csv", "--library", lib, "-o", "new.json", "--json")
    assert code == 0, talk
    assert json.loads(out)["weights"] == {"material-3": 1.0}
    assert json.loads((tmp_path / "new.json").read_text())["weights"] == {"material-3": 1.0}
    words = ["--as", "completion", "-o", "new.binary", "--picture", "sure.png"]
    code, out, talk = run("recover", "new.csv", "--library", lib, *words)
    assert code == 0, talk
    assert "completion: " in talk
    assert "new.binary: new completed" in talk
    assert read_merl(tmp_path / "new.binary").grid == GRID
    assert (tmp_path / "sure.png").stat().st_size > 10_000


def test_what_cannot_be_recovered_is_one_line(run, lib, tmp_path):
    (tmp_path / "bad.csv").write_text("theta_i,theta_o [deg]\n1,1")
    code, _, talk = run("recover", "bad.csv", "--library", lib)
    assert code == 1
    assert talk.startswith("halfway: bad.csv line 1 names the column theta_i without a unit")
    code, _, talk = run("recover", "bad.csv", "--as", "completion", "-o", "a.json")
    assert code == 1
    assert "a.json is a recipe, and a completion has none" in talk
