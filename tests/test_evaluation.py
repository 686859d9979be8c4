"""What spaces are measured with, on spaces whose measures are known."""

import dataclasses
import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import random_tables

from halfway.brdf import difference, tabulate
from halfway.brdf.metrics import MAPPINGS
from halfway.components import Pca
from halfway.errors import LibraryError
from halfway.formats import read_nbrdf_archive
from halfway.halfdiff import Grid
from halfway.judge.evaluation import N_STEPS, Bench, evaluate, sample_pairs, uniform
from halfway.judge.leave_one_out import leave_one_out
from halfway.library import LibraryRef, ProceduralLibrary
from halfway.look import JUDGING_SCENE, PACING_SCENE, CellSamples, Looks, body_colours
from halfway.look.appearance import appearance, cielab_difference, to_lab
from halfway.look.samples import body_mask
from halfway.models import AbcModel
from halfway.space import (
    Coordinates,
    LinearSpace,
    Numbers,
    PaperSpace,
    Scores,
    Space,
    Triangulation,
    Way,
)
from halfway.space.chart import Chart
from halfway.space.hull import nearest_in_hull
from halfway.tasks import Work

GRID = Grid.merl(10, 8, 12)
COLOURS = {
    "black": [0.02, 0.02, 0.02],
    "dark": [0.1, 0.1, 0.1],
    "grey": [0.3, 0.3, 0.3],
    "white": [0.7, 0.7, 0.7],
    "red": [0.6, 0.05, 0.05],
    "blue": [0.05, 0.1, 0.5],
}
NAMES = tuple(COLOURS)
PAIRS = sample_pairs(len(COLOURS))


def matte_library(colours: dict[str, list[float]]) -> ProceduralLibrary:
    """Matte materials with these albedos."""
    models = {
        name: tabulate(AbcModel(np.array(kd), np.zeros(3), 1.0, 1.0, 1.5), GRID)
        for name, kd in colours.items()
    }
    return ProceduralLibrary("matte", models, grid=GRID)


def bench_of(library: ProceduralLibrary, *, size: int = 8, n_cells: int = 400) -> Bench:
    pacing, judging = (
        Looks.fit(library, dataclasses.replace(scene, size=size, n_points=2))
        for scene in (PACING_SCENE, JUDGING_SCENE)
    )
    return Bench(pacing, judging, CellSamples.fit(library, n_cells=n_cells), library)


@dataclasses.dataclass(frozen=True)
class Via(Space):
    """Goes from every material to every other through one of them, at t = 1/2."""

    middle: int
    name = "via"

    def leg(self, start: int, stop: int) -> Way:
        weights = np.eye(len(self.names))[[start, self.middle, stop]]
        return Way(np.array([0.0, 0.5, 1.0]), np.stack([weights] * 3))


@pytest.fixture(scope="module")
def library() -> ProceduralLibrary:
    return matte_library(COLOURS)


@pytest.fixture(scope="module")
def bench(library: ProceduralLibrary) -> Bench:
    return bench_of(library)


@pytest.fixture(scope="module")
def linear(library: ProceduralLibrary) -> LinearSpace:
    return LinearSpace.of(library)


def via(name: str) -> Via:
    return Via(LibraryRef("matte"), NAMES, (), NAMES.index(name))


def seen(bench: Bench, name: str) -> np.ndarray:
    return appearance(np.ascontiguousarray(bench.pacing.images[NAMES.index(name)]))


def test_pairs_are_the_same_for_the_same_seed_and_never_twice():
    pairs = sample_pairs(100, 200, seed=3)
    assert (pairs == sample_pairs(100, 200, seed=3)).all()
    assert (pairs != sample_pairs(100, 200, seed=4)).any()
    assert len(np.unique(pairs, axis=0)) == 200
    assert (pairs[:, 0] < pairs[:, 1]).all()
    assert len(sample_pairs(100)) == 4950
    assert len(sample_pairs(5, 200)) == 10


def test_the_detour_through_a_lighter_grey_is_there_and_back(bench: Bench):
    """Lightness rises and falls monotonously at every pixel, so the steps of each half add up to its length."""
    pair = np.array([[NAMES.index("black"), NAMES.index("dark")]])
    there = cielab_difference(seen(bench, "black"), seen(bench, "white"))
    back = cielab_difference(seen(bench, "white"), seen(bench, "dark"))
    direct = cielab_difference(seen(bench, "black"), seen(bench, "dark"))
    evaluation = evaluate(via("white"), bench, pair)
    assert_allclose(evaluation.distance, direct, rtol=1e-5)
    assert_allclose(evaluation.detour, (there + back) / direct, rtol=1e-5)


def test_the_straight_way_between_greys_has_no_detour(bench: Bench, linear: LinearSpace):
    greys = np.array([[0, 1], [0, 3], [2, 3]])
    assert_allclose(evaluate(linear, bench, greys).detour, 1, rtol=1e-5)


def test_no_way_is_shorter_than_the_straight_line(bench: Bench, linear: LinearSpace):
    for space in (linear, via("red"), via("grey")):
        assert (evaluate(space, bench, PAIRS).detour >= 1 - 1e-5).all()


def test_one_step_that_goes_all_the_way_is_n_minus_1_times_the_mean(
    bench: Bench, linear: LinearSpace
):
    paces = {
        "uniform": uniform,
        "leap": lambda route: dataclasses.replace(
            route,
            way=Way(np.array([0.0, 1 - 1 / (N_STEPS - 1), 1.0]), route.way.weights[:, [0, 0, -1]]),
        ),
    }
    evaluation = evaluate(linear, bench, PAIRS, paces=paces)
    for jumps in (evaluation.jump, evaluation.cielab_jump, evaluation.judged_jump):
        assert list(jumps) == ["uniform", "leap"]
        assert_allclose(jumps["leap"], N_STEPS - 1, rtol=1e-4)
        assert (jumps["uniform"] < 10).all()


def test_the_perceptual_pace_evens_the_steps(bench: Bench, linear: LinearSpace):
    jumps = evaluate(linear, bench, PAIRS).jump
    assert (jumps["perceptual"] < 1.05).all()
    assert jumps["uniform"].min() > 1.3


def test_plain_mixing_has_no_hue_excursion(bench: Bench, linear: LinearSpace):
    """But for the curve's being drawn with 200 straight pieces: sampled at 40, they meet it at every fifth corner."""
    assert (evaluate(linear, bench, PAIRS).hue_excursion < 1e-4).all()


def test_the_hue_excursion_from_grey_to_grey_is_the_chroma_on_the_way(bench: Bench):
    pair = np.array([[NAMES.index("black"), NAMES.index("white")]])
    red = np.array(COLOURS["red"])
    chroma = np.hypot(*to_lab(red[None])[0, 1:])
    # The tables are float32.
    assert_allclose(evaluate(via("red"), bench, pair).hue_excursion, chroma, rtol=1e-5)


def test_a_way_through_a_measured_material_is_real_there(bench: Bench, linear: LinearSpace):
    red, black = NAMES.index("red"), NAMES.index("black")
    pair = np.array([[black, NAMES.index("white")]])
    through = evaluate(via("red"), bench, pair)
    plain = evaluate(linear, bench, pair)
    for way, realism in through.realism.items():
        assert_allclose(realism, 0, atol=1e-4)
        assert plain.realism[way] > 0.001
    assert_allclose(through.others, 1)
    assert_allclose(plain.others, 0)
    assert red not in pair


def test_a_pair_that_looks_alike_stays_out_of_the_ratios(bench: Bench, linear: LinearSpace):
    evaluation = evaluate(linear, bench, PAIRS)
    alike = dataclasses.replace(evaluation, distance=np.full(len(PAIRS), 2.9))
    assert alike.to_json()["detour"] == {}
    assert alike.to_json()["n_pairs_apart"] == 0
    document = evaluation.to_json()
    assert document["n_pairs"] == 15
    assert document["others"] == {"median": 0, "90th percentile": 0, "max": 0}
    assert set(json.loads(json.dumps(document))["realism"]) == {"log", "log by cell", "seen"}


def test_samples_of_all_cells_give_the_metrics_themselves(library: ProceduralLibrary):
    """A million draws, half of them even, take each of 600 cells 833 times or more: to 1/833 of its share."""
    samples = CellSamples.fit(library, n_cells=1_000_000)
    brdfs = [library.brdf(name) for name in NAMES]
    for metric in MAPPINGS:
        features = samples.features(samples.values, metric)
        for a, b in PAIRS[:4]:
            expected = difference(brdfs[a], brdfs[b], metric).below
            assert_allclose(np.linalg.norm(features[a] - features[b]), expected, rtol=1 / 800)
    assert_allclose(samples.cell_weights, 1 / len(samples.cell_weights), rtol=1 / 800)


def test_the_body_colour_of_a_mix_is_the_mean_of_its_table(
    library: ProceduralLibrary, bench: Bench
):
    weights = np.random.default_rng(1).dirichlet(np.ones(6), 3)
    row = np.einsum("cn,ncp->cp", weights, np.stack([library.row(i) for i in range(6)]))
    expected = row[:, body_mask(GRID).ravel()].mean(axis=1)
    assert_allclose(bench.samples.body_colour(weights), expected, rtol=1e-6)


def test_body_colours_are_seen_beside_the_highlight_and_away_from_grazing():
    """Row i of theta_h is at 90 ((i + 1/2)/90)^2 degrees: 47 is the first past 25; column j of theta_d at j + 1/2."""
    merl = Grid.merl()
    mask = body_mask(merl)
    assert not (mask & ~merl.mask()).any()
    rows, columns = (np.flatnonzero(mask.any(axis=axes)) for axes in ((1, 2), (0, 2)))
    assert (rows[0], columns[0], columns[-1]) == (47, 0, 49)
    assert (mask[47:, :50] == merl.mask()[47:, :50]).all()


def test_a_material_without_a_body_colour_is_named():
    grid = Grid.merl(4, 4, 4)
    tables = random_tables(2, grid)
    hidden = tables["material-1"]
    values = np.where(body_mask(grid), np.float32(np.nan), hidden.values)
    tables["material-1"] = dataclasses.replace(hidden, values=values)
    library = ProceduralLibrary("two", tables, grid=grid)
    message = "material-1 of two has no measured cell with theta_h above 25 and theta_d below 50"
    for fit in (body_colours, CellSamples.fit):
        with pytest.raises(LibraryError, match=message):
            fit(library)


def test_samples_come_back_from_the_cache(library: ProceduralLibrary, tmp_path):
    first, again = (
        CellSamples.fit(library, n_cells=300, work=Work(cache=tmp_path)) for _ in range(2)
    )
    assert len(list(tmp_path.iterdir())) == 1
    assert (first.values == again.values).all()
    assert (first.body == again.body).all()


def test_a_material_among_others_is_found_again_without_it():
    """A mix of three materials lies in their plane: its coordinates there give back the three weights."""
    three = np.array([COLOURS[name] for name in ("red", "blue", "white")])
    # Per channel the albedos lie on a line, so two of three materials place the mix: its albedo is met all the same.
    library = matte_library(
        {"red": three[0], "blue": three[1], "white": three[2], "mix": three.mean(0)}
    )
    with pytest.warns(UserWarning, match="extend in 1 of 2 dimensions"):
        space = PaperSpace.fit(library, Pca.fit(library), n_components=2)
    with pytest.warns(UserWarning, match="extend in 1 of 2 dimensions"):
        errors = leave_one_out(space, bench_of(library))
    assert errors.errors["log"][3] < 1e-4
    assert errors.errors["seen"][3] < 0.01
    assert (errors.errors["seen"][:3] > 1).all()
    assert errors.to_json()["log"]["max"] == errors.errors["log"].max()


def test_the_scores_without_a_material_are_those_of_the_library_without_it(
    small_library: ProceduralLibrary,
):
    pca = Pca.fit(small_library)
    others = np.delete(np.arange(9), 4)
    placed = Scores.of_channel(pca, 3, 1).without(4)
    brdfs = {name: small_library.brdf(name) for i, name in enumerate(small_library.names) if i != 4}
    alone = Pca.fit(ProceduralLibrary("eight", brdfs, grid=small_library.grid)).scores(3)[1]
    assert_allclose(np.abs(placed.others), np.abs(alone), rtol=1e-6)
    rows = np.stack([small_library.row(i)[1] for i in range(9)]).astype(np.float64)
    u = np.nan_to_num(rows - rows[others].mean(axis=0))
    # A score is u . component, and the component is the sum of the others' u weighed by v / sqrt(L).
    components = placed.others.T @ u[others] / (placed.others**2).sum(axis=0)[:, None]
    assert_allclose(placed.own, components @ u[4], rtol=1e-6)


def test_inside_the_hull_weights_are_those_of_the_triangulation():
    points = np.random.default_rng(2).standard_normal((20, 3))
    points[7] = np.delete(points, 7, axis=0).mean(axis=0)
    others = np.delete(points, 7, axis=0)
    numbers = Numbers(label="numbers", names=("a", "b", "c"), points=points)
    weights = Chart.of(Coordinates((numbers,))).without(7)
    assert weights[7] == 0
    assert_allclose(np.delete(weights, 7), Triangulation.of(others).weights(points[7]), atol=1e-9)


@given(st.integers(0, 2**32 - 1), st.integers(1, 5))
def test_outside_the_hull_the_nearest_point_has_all_materials_behind_it(seed: int, k: int):
    """For the nearest point y of a convex set, (x - y) . (p - y) <= 0 for each of its points p."""
    rng = np.random.default_rng(seed)
    points, x = rng.standard_normal((12, k)), 6 * rng.standard_normal(k)
    weights = nearest_in_hull(points, x)
    assert (weights >= 0).all()
    assert_allclose(weights.sum(), 1)
    y = weights @ points
    assert ((points - y) @ (x - y)).max() <= 1e-7 * (1 + (x - y) @ (x - y))


def test_the_papers_space_wanders_where_plain_mixing_does_not(shared_data):
    """On neural fits of the MERL materials; in full: median detour 3.7, 90th percentile 11.5, uniform jump 4.8 in CIELAB."""
    brdfs = read_nbrdf_archive(shared_data / "nbrdf" / "merl_nbrdf.zip").models
    coarse = ProceduralLibrary("coarse", brdfs, grid=Grid.merl(24, 12, 16))
    bench = bench_of(coarse, size=12, n_cells=1000)
    pairs = sample_pairs(len(coarse), 40, seed=1)
    paper = evaluate(
        PaperSpace.fit(coarse, Pca.fit(coarse)), bench, pairs, paces={"uniform": uniform}
    ).to_json()
    linear = evaluate(LinearSpace.of(coarse), bench, pairs, paces={"uniform": uniform}).to_json()
    assert 2.5 < paper["detour"]["median"] < 6
    assert 3 < paper["cielab_jump"]["uniform"]["median"] < 7
    assert paper["hue_excursion"]["median"] > 15
    assert linear["detour"]["max"] < 1.1
    assert linear["hue_excursion"]["max"] < 2
