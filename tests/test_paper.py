"""The paper's experiment on a tiny library: everything is there, and says what is so."""

import json
import re

import numpy as np
import pytest
from PIL import Image
from strategies import random_tables

from halfway.brdf import tabulate
from halfway.errors import LibraryError
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.paper import Experiment, reproduce
from halfway.paper.experiment import largest_share_after, n_components_below
from halfway.paper.reported import FABRICS, FAR_APART, RUNS, SPECULARS

GRID = Grid.merl(12, 8, 10)
STOPS = {name for run in RUNS for name in run.stops}
NAMES = (*sorted(STOPS), "chrome", "teflon", "pink-felt", "gold-paint")


def few(names=NAMES):
    """Some of the analytic fits on a coarse grid."""
    models = builtin("merl-abc").models
    return ProceduralLibrary(
        "few", {name: tabulate(models[name], GRID, name=name) for name in names}, grid=GRID
    )


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paper")
    return folder, reproduce(folder, few(), size=24, spp=1)


def test_every_picture_that_the_page_shows_is_there_and_the_other_way_round(page):
    folder, _ = page
    text = (folder / "page.md").read_text()
    shown = set(re.findall(r"\]\((\S+\.webp)\)", text))
    assert shown == {path.name for path in folder.glob("*.webp")}
    for number in (2, 3, 5, 6, 7, 8):
        assert f"figure-{number}.webp" in shown


def test_the_html_page_shows_what_the_markdown_does(page):
    folder, _ = page
    html, text = ((folder / name).read_text() for name in ("page.html", "page.md"))
    assert html.count("<img") == text.count("![")
    assert html.count("<h2>") == text.count("\n## ")
    assert "<table>" in html


def test_numbers_are_in_the_json(page):
    folder, found = page
    document = json.loads((folder / "paper.json").read_text())
    assert document["format"] == 1
    assert [row["n_components"] for row in document["table_1"]] == [3, 5]
    assert [run["figure"] for run in document["runs"]] == [5, 6, 7]
    assert document == json.loads(json.dumps(found.to_json()))


def test_animations_have_all_51_materials(page):
    folder, _ = page
    milliseconds = 0
    with Image.open(folder / "comparison-5-moving.webp") as animation:
        for i in range(animation.n_frames):
            animation.seek(i)
            animation.load()
            milliseconds += animation.info["duration"]
    # WebP shows a frame that is like the one before for longer instead of storing it again.
    assert milliseconds == 51 * 100


def test_the_mixed_picture_is_the_rendered_one_but_for_its_noise(page):
    # Samples are drawn for the table that is rendered, so two pictures at one sample per pixel have different noise.
    assert page[1].mixed_picture_error < 0.01


def test_a_library_with_the_papers_materials_takes_its_stops(page):
    assert [run.stops for run in page[1].runs] == [run.stops for run in RUNS]
    assert "stand in" not in (page[0] / "page.md").read_text().replace("stand-in", "")


def test_other_materials_stand_in_for_those_that_a_library_lacks():
    library = few([name for name in NAMES if name != "alum-bronze"])
    stops = Experiment.fit(library).stops
    assert stops[FABRICS.figure] == FABRICS.stops
    assert stops[FAR_APART.figure] == FAR_APART.stops
    assert len({name for pair in stops.values() for name in pair}) == 6
    assert set(stops[SPECULARS.figure]) <= set(library.names)


def test_five_materials_are_too_few():
    library = ProceduralLibrary("five", random_tables(5, GRID), grid=GRID)
    with pytest.raises(LibraryError, match=r"^five has 5 materials: the paper's three runs need"):
        Experiment.fit(library)


def test_evenly_seen_materials_start_at_the_first_and_stop_before_the_last():
    experiment = Experiment.fit(few())
    ts = experiment.evenly_seen(FAR_APART, 6)
    assert ts[0] == 0
    assert list(ts) == sorted(set(ts))
    assert ts[-1] < 1
    # All of them are on the paper's list of t.
    np.testing.assert_allclose(np.array(ts) * 10_000 % 1, 0, atol=1e-6)


def test_finer_steps_are_smaller():
    steps = Experiment.fit(few()).largest_steps(FAR_APART)
    assert steps["fine"] < steps["51"]


def test_shares_of_eigenvalues():
    values = np.array([[8.0, 1.5, 0.5], [80.0, 19.9, 0.1], [1.0, 0.0, 0.0]])
    assert n_components_below(values, 0.06) == 2
    assert largest_share_after(values, 1) == pytest.approx(0.199)
    assert largest_share_after(values, 3) == 0
