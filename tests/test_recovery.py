"""Recovering: what is known comes back, what is not is said, and a plan tells more than chance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import halfway
from halfway import Grid, Measurements
from halfway.brdf import tabulate
from halfway.errors import LibraryError
from halfway.library import Library, ProceduralLibrary, Subset
from halfway.models import builtin
from halfway.recovery import Recovery, Setup, plan, recover
from halfway.recovery.log_relative import mapped, unmapped
from halfway.recovery.regression import Regression

GRID = Grid.merl(30, 10, 12)


@pytest.fixture(scope="module")
def library() -> Library:
    models = builtin("merl-abc").models
    tables = {name: tabulate(models[name], GRID, name=name) for name in sorted(models)[:24]}
    return ProceduralLibrary("few", tables, grid=GRID)


def measured(library: Library, weights: dict[str, float], n: int = 40) -> Measurements:
    """A mix at planned directions."""
    directions = plan(library, n)
    values = halfway.mix(library, weights).eval(directions.wi, directions.wo)
    return Measurements(directions.wi, directions.wo, values, name="new")


def test_a_mix_of_library_materials_is_found_from_its_values(library: Library):
    weights = {library.names[2]: 0.5, library.names[9]: 0.3, library.names[20]: 0.2}
    recipe = recover(library, measured(library, weights)).mix()
    assert set(recipe.names) == set(weights)
    wanted = [weights[name] for name in recipe.names]
    # The sum of squares that decides where the measurements leave a choice has a millionth of their weight.
    assert_allclose(recipe.weights, np.broadcast_to(wanted, (3, 3)), atol=1e-3)


@pytest.mark.parametrize("blend", ["root", "log"])
def test_a_mix_is_found_in_the_blend_that_is_asked_for(library: Library, blend: str):
    weights = {library.names[2]: 0.5, library.names[9]: 0.5}
    directions = plan(library, 40)
    values = halfway.mix(library, weights, blend=blend).eval(directions.wi, directions.wo)
    recipe = recover(library, Measurements(directions.wi, directions.wo, values)).mix(blend)
    # Interpolation between cells is of values, and a mix in a blend is of each cell.
    table, truth = (halfway.mix(library, each, blend=blend) for each in (recipe, weights))
    assert halfway.brdf.difference(truth, table).below < 0.01


def test_a_material_of_the_library_is_completed_to_itself_where_nothing_is_penalised(
    library: Library,
):
    directions = plan(library, 60)
    values = library.brdf(library.names[5]).eval(directions.wi, directions.wo)
    setup = Setup.of(library, directions.wi, directions.wo)
    first = Regression(
        setup.regression.known, setup.regression.materials, setup.regression.shares, 1.0, 1e-12
    )
    weights = first.weights(first.known)
    # K (K + eta I)^-1 is 1 but for eta over the least eigenvalue.
    least = np.linalg.eigvalsh(first._kernel(first.known))[0]
    assert_allclose(weights, np.eye(len(weights)), atol=1e-12 / least * len(weights) + 1e-6)
    assert setup.weights(values).shape == (3, 3 * len(library))


def test_weights_are_those_of_ridge_regression_in_principal_components():
    """Nielsen et al. 2015, equation 12, with an infinite width; the constant kernel only weighs the mean row."""
    rng = np.random.default_rng(0)
    rows, samples = rng.normal(size=(12, 30)), [3, 8, 20, 21]
    rows -= rows.mean(axis=0)
    y, eta = rng.normal(size=4), 0.3
    _, s, components = np.linalg.svd(rows, full_matrices=False)
    scaled = (components.T * s)[samples]
    u, t, v = np.linalg.svd(scaled, full_matrices=False)
    expected = (components.T * s) @ (v.T @ (t / (t**2 + 4 * eta) * (u.T @ y)))
    shares = np.full(4, 1 / 4)
    regression = Regression(rows[:, samples], np.arange(12), shares, np.inf, eta)
    assert_allclose(regression.weights(y[None])[0] @ rows, expected, atol=1e-12)


def test_left_out_weights_are_those_of_a_library_without_the_material():
    rng = np.random.default_rng(1)
    known, materials = rng.normal(size=(12, 5)), np.arange(12) % 4
    shares = np.full(5, 1 / 5)
    left_out = Regression(known, materials, shares, 2.0, 0.1).left_out()
    others = materials != 1
    without = Regression(known[others], materials[others], shares, 2.0, 0.1)
    assert_allclose(left_out[~others][:, others], without.weights(known[~others]), atol=1e-12)
    assert not left_out[~others][:, ~others].any()


def test_all_weights_sum_to_1(library: Library):
    recovery = recover(library, measured(library, {library.names[0]: 1.0}, 5))
    assert_allclose(recovery.weights.sum(axis=1), 1)
    assert_allclose(recovery.setup.left_out.sum(axis=1), 1)


def test_the_mapping_is_undone():
    f, cosines = np.array([0, 1e-4, 0.3, 1e3]), (np.full(4, 0.5), np.full(4, 0.25))
    assert_allclose(unmapped(mapped(f, cosines), cosines), f, rtol=1e-12, atol=1e-15)


def test_intervals_hold_what_the_library_missed(library: Library):
    """On the pairs on which they are made, by their making: the share that was asked for."""
    setup = recover(library, measured(library, {library.names[0]: 1.0}, 5)).setup
    n = len(setup.ratios)
    for level in (0.5, 0.9):
        held = (setup.ratios <= setup.half_width(level)).sum()
        assert abs(held - level * n) <= 1


def test_an_interval_is_about_the_completion_and_grows_with_its_level(library: Library):
    recovery = recover(
        library, measured(library, {library.names[0]: 0.5, library.names[4]: 0.5}, 5)
    )
    few, many = recovery.completion(0.5), recovery.completion(0.95)
    lit = GRID.mask()
    assert_allclose(few.table.values[:, lit], many.table.values[:, lit])
    for low, high in zip(
        (many.low, few.low, few.table, few.high),
        (few.low, few.table, few.high, many.high),
        strict=True,
    ):
        assert (low.values[:, lit] <= high.values[:, lit]).all()
    assert few.table.name == "new completed"


def test_a_completion_is_nearer_than_the_nearest_material(library: Library):
    missing = library.names[7]
    others = Subset(library, [name for name in library.names if name != missing])
    truth = library.brdf(missing)
    directions = plan(others, 20)
    recovery = recover(
        others, Measurements(directions.wi, directions.wo, truth.eval(directions.wi, directions.wo))
    )
    completed = halfway.brdf.difference(truth, recovery.completion().table).below
    nearest = min(halfway.brdf.difference(truth, others.brdf(name)).below for name in others.names)
    assert completed < nearest


def test_channels_may_share_their_weights(library: Library):
    weights = {library.names[3]: 0.25, library.names[11]: 0.75}
    recovery = recover(library, measured(library, weights), channels="together")
    recipe = recovery.mix()
    assert_allclose(recipe.weights, np.broadcast_to(recipe.weights[0], recipe.weights.shape))
    table = halfway.mix(library, weights)
    assert halfway.brdf.difference(table, recovery.completion().table).below < 0.05
    assert_allclose(recipe.weights[0], [weights[name] for name in recipe.names], atol=1e-3)


def test_one_sample_is_enough(library: Library):
    up = np.array([[0.0, 0.0, 1.0]])
    recovery = recover(library, Measurements(up, up, np.full((1, 3), 0.1)))
    assert np.isfinite(recovery.completion().table.values[:, GRID.mask()]).all()
    assert_allclose(recovery.mix().weights.sum(axis=1), 1)


def test_where_the_library_is_unmeasured_counts_for_nothing(library: Library):
    holed = {name: library.brdf(name) for name in library.names}
    first = holed[library.names[0]]
    values = first.values.copy()
    values[:, GRID.shape[0] // 2 :] = np.nan
    holed[library.names[0]] = halfway.TabularBrdf(values, GRID)
    lacking = ProceduralLibrary("lacking", holed, grid=GRID)
    given = measured(library, {library.names[2]: 1.0}, 12)
    recovery = recover(lacking, given)
    assert 0 < len(recovery.setup.used) < 12
    away = np.setdiff1d(np.arange(12), recovery.setup.used)
    out = Measurements(given.wi[away], given.wo[away], given.values[away])
    with pytest.raises(LibraryError, match=r"lacking is measured at none of \d+ pairs"):
        recover(lacking, out)


def test_highlights_that_move_have_no_nearest_mix(library: Library):
    recovery = recover(library, measured(library, {library.names[0]: 1.0}, 3))
    with pytest.raises(LibraryError, match="expected linear, root or log"):
        recovery.mix("lobes")


def test_a_plan_stays_within_reach_and_in_its_plane(library: Library):
    directions = plan(library, 6, max_theta=60, in_plane=True)
    assert min(directions.wi[:, 2].min(), directions.wo[:, 2].min()) >= np.cos(np.radians(60))
    across = np.cross(directions.wi, directions.wo)[:, 2]
    assert_allclose(across, 0, atol=1e-9)


def test_a_plan_leaves_ever_less_unknown_and_less_than_chance(library: Library):
    planned = plan(library, 5)
    assert (np.diff([planned.unknown, *planned.left]) < 0).all()
    errors = [
        Setup.of(library, wi, wo).best_error
        for wi, wo in [(planned.wi, planned.wo), *(_random(seed) for seed in range(3))]
    ]
    assert errors[0] < min(errors[1:])


def test_what_is_measured_already_is_not_planned_again(library: Library):
    first = plan(library, 3)
    given = Measurements(first.wi, first.wo, np.ones((3, 3)))
    more = plan(library, 2, given=given)
    assert more.unknown < first.unknown
    assert more.left[-1] < first.left[-1]


def test_a_plan_out_of_reach_is_refused(library: Library):
    with pytest.raises(
        LibraryError, match=r"0 pairs of directions of few are within 0.01 degrees of the normal"
    ):
        plan(library, 1, max_theta=0.01)


def test_one_material_recovers_no_other(library: Library):
    one = ProceduralLibrary("one", {"a": library.brdf(library.names[0])}, grid=GRID)
    up = np.array([[0.0, 0.0, 1.0]])
    with pytest.raises(LibraryError, match="one has one material: expected two or more"):
        Recovery.of(Setup.of(one, up, up), Measurements(up, up, np.ones((1, 3))))


def _random(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Five pairs of directions, each as likely by solid angle."""
    rng = np.random.default_rng(seed)
    z, phi = rng.random((2, 5)), 2 * np.pi * rng.random((2, 5))
    r = np.sqrt(1 - z**2)
    wi, wo = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    return wi, wo
