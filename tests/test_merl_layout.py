"""How a table's cells lie, told by its horizon: what other programs do to a table, and what is no evidence."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from halfway import MERL, Grid
from halfway.brdf.layout import horizon, layout_of
from halfway.halfdiff import Axis, HalfDiff, cosines

SHAPES = [(6, 6, 12), (8, 12, 20), (12, 10, 16), (20, 20, 20)]


def drawn(grid, seed=0):
    """A table with a value of its own in each cell, unmeasured below the horizon."""
    values = np.random.default_rng(seed).random((3, *grid.shape))
    return np.where(grid.mask(), values, np.nan).astype(np.float32)


def assert_read_as(array, values, grid):
    """An array whose sizes are stated as they are is the table ``values`` on ``grid``."""
    found = layout_of(array, Grid.merl(*array.shape[1:]))
    assert found.grid == grid, found
    assert_array_equal(found.of(array), values)


shapes = pytest.mark.parametrize("grid", [Grid.merl(*shape) for shape in SHAPES], ids=str)


@shapes
def test_a_table_is_on_its_own_grid(grid):
    assert_read_as(drawn(grid), drawn(grid), grid)


@shapes
def test_the_sizes_may_be_stated_in_another_order(grid):
    for sizes in permutations(grid.shape):
        assert_read_as(drawn(grid).reshape(3, *sizes), drawn(grid), grid)


@shapes
def test_the_axes_may_lie_in_another_order(grid):
    for order in permutations(range(1, 4)):
        assert_read_as(np.ascontiguousarray(drawn(grid).transpose(0, *order)), drawn(grid), grid)


@shapes
@pytest.mark.parametrize("axis", [1, 2, 3])
@pytest.mark.parametrize("times", [2, 3])
def test_an_axis_that_is_written_several_times_counts_once(grid, axis, times):
    values = drawn(grid)
    assert_read_as(np.concatenate([values] * times, axis=axis), values, grid)


@pytest.mark.parametrize("axis", [1, 2, 3])
def test_so_it_does_where_nothing_is_unmeasured(axis):
    values = np.random.default_rng(0).random((3, 4, 3, 5)).astype(np.float32)
    assert_read_as(np.concatenate([values, values], axis=axis), values, Grid.merl(4, 3, 5))


def test_an_axis_written_twice_under_sizes_in_another_order():
    grid = Grid.merl(12, 10, 16)
    twice = np.concatenate([drawn(grid)] * 2, axis=3)
    for sizes in permutations(twice.shape[1:]):
        assert_read_as(twice.reshape(3, *sizes), drawn(grid), grid)


def test_sizes_of_the_databases_proportions_need_not_be_stated():
    grid = Grid.merl(8, 8, 16)
    for sizes in ((1024, 1, 1), (1, 64, 16), (32, 32, 1)):
        assert_read_as(drawn(grid).reshape(3, *sizes), drawn(grid), grid)


def test_phi_d_may_cover_a_whole_turn_whose_halves_differ():
    theta_h, theta_d, phi_d = Grid.merl(12, 10, 16).axes
    grid = Grid((theta_h, theta_d, replace(phi_d, stop=2 * np.pi)))
    assert_read_as(drawn(grid), drawn(grid), grid)
    assert (
        str(layout_of(drawn(grid), Grid.merl(12, 10, 16)))
        == "12 x 10 x 16 cells, phi_d over a whole turn"
    )


def test_theta_h_may_be_evenly_spaced():
    theta_h, *others = Grid.merl(12, 10, 16).axes
    grid = Grid((replace(theta_h, power=1), *others))
    assert_read_as(drawn(grid), drawn(grid), grid)
    assert str(layout_of(drawn(grid), Grid.merl(12, 10, 16))).endswith(
        "cells, theta_h evenly spaced"
    )


def test_a_layout_says_what_is_unusual_of_it():
    grid = Grid.merl(8, 12, 20)
    array = np.concatenate([drawn(grid)] * 2, axis=3).transpose(0, 3, 1, 2)
    found = layout_of(np.ascontiguousarray(array), Grid.merl(*array.shape[1:]))
    assert str(found) == (
        "8 x 12 x 20 cells, stored in the order phi_d, theta_h, theta_d, phi_d written 2 times"
    )


# What is no evidence


def test_holes_and_cells_that_the_horizon_cuts_change_nothing():
    """Cells by their lower edges, as other programs take them, and a tenth of the measured ones lost."""
    grid = Grid.merl(24, 24, 48)
    edges = (axis.edges()[:-1] for axis in grid.axes)
    cos_i, cos_o = cosines(*np.ix_(*edges))
    values = np.random.default_rng(0).random((3, *grid.shape)).astype(np.float32)
    values[:, (cos_i <= 0) | (cos_o <= 0)] = np.nan
    assert_read_as(values, values, grid)
    values[:, np.random.default_rng(1).random(grid.shape) < 0.1] = np.nan
    assert_read_as(values, values, grid)


def test_grazing_directions_may_be_left_out():
    grid = Grid.merl(24, 24, 48)
    angles = grid.centres()
    both = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    for degrees in (60, 70, 80, 85):
        values = drawn(grid)
        values[:, np.minimum(*both) < np.cos(np.radians(degrees))] = np.nan
        assert_read_as(values, values, grid)


def test_a_few_cells_are_no_evidence():
    rng = np.random.default_rng(0)
    for shape in ((2, 3, 4), (4, 1, 2), (1, 1, 6), (4, 4, 4)):
        for _ in range(50):
            values = rng.random((3, *shape)).astype(np.float32)
            values[:, rng.random(shape) < rng.random()] = np.nan
            assert_read_as(values, values, Grid.merl(*shape))


@pytest.mark.parametrize("value", [0, 1])
def test_what_is_the_same_along_an_axis_is_not_written_twice(value):
    values = np.full((3, 6, 6, 12), value, np.float32)
    assert_read_as(values, values, Grid.merl(6, 6, 12))
    values = np.repeat(drawn(Grid.merl(6, 6, 1)), 12, axis=3)
    assert_read_as(values, values, Grid.merl(6, 6, 12))


# The horizon


GRIDS = [
    Grid.merl(3, 4, 5),
    Grid.merl(7, 5, 6),
    Grid((Axis("theta_h", 4, np.pi / 2, power=2), Axis("phi_h", 3, 2 * np.pi, periodic=True), *Grid.merl(1, 5, 7).axes[1:])),
    Grid((*Grid.merl(5, 6, 1).axes[:2], Axis("phi_d", 9, 2 * np.pi, periodic=True))),
]  # fmt: skip


@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_a_cell_is_above_or_below_the_horizon_wherever_in_it_one_looks(grid):
    above, below = horizon(grid)
    assert not (above & below).any()
    rng = np.random.default_rng(0)
    for _ in range(200):
        at = dict.fromkeys(HalfDiff._fields, np.zeros(1))
        for axis, cells in zip(grid.axes, np.indices(grid.shape), strict=True):
            at[axis.angle] = axis.to_angle(cells + rng.random(grid.shape))
        lit = np.minimum(*cosines(at["theta_h"], at["theta_d"], at["phi_d"])) > 0
        assert lit[above].all()
        assert not lit[below].any()


def test_the_horizon_cuts_few_cells_of_the_databases_grid():
    above, below = horizon(MERL)
    assert 0.02 < 1 - above.mean() - below.mean() < 0.03
