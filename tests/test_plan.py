"""The plan of a PCA: its memory is kept to, whatever the grid, and blocks cover it once."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import random_tables

from halfway.components import Pca, PcaPlan, pca
from halfway.components.gram import Gram
from halfway.components.sketch import sketch
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary, blocks
from halfway.tasks import Threads, Work


@pytest.fixture
def small_blocks(monkeypatch):
    """Blocks as narrow for a hundred materials as they are for thousands."""
    monkeypatch.setattr(blocks, "WORK_BYTES", 2e5)
    monkeypatch.setattr(blocks, "BLOCK_BYTES", 8e5)


def library(n, n_theta_h):
    grid = Grid.merl(n_theta_h, 24, 16)
    return ProceduralLibrary(f"{n} on {grid}", random_tables(n, grid), grid=grid)


def peak_of(work):
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("method", ["exact", "sketch"])
def test_working_memory_is_bounded_by_the_plan(monkeypatch, method):
    """Four times the cells take no more of it: blocks are what is held, not tables."""
    made = library(60, 48)
    Gram.of(made)  # what loads at first use is no working memory
    if method == "sketch":
        monkeypatch.setattr("halfway.components.plan.MOST_EXACT", 10)
    plan = PcaPlan.of(made, n_components=10, n_threads=2)
    work = {
        "exact": lambda: Gram.of(made, work=Work(engine=Threads(2))),
        "sketch": lambda: sketch(made, 10, work=Work(engine=Threads(2))),
    }
    tables = 12 * len(made) * made.grid.size
    assert plan.peak_bytes == PcaPlan.of(library(60, 12), n_components=10, n_threads=2).peak_bytes
    assert peak_of(work[method]) < plan.peak_bytes + 2e5 < tables / 4


@given(st.integers(1, 5), st.integers(1, 7), st.integers(1, 6), st.integers(1, 200))
def test_parts_of_a_grid_cover_it_once_and_in_order(a, b, c, n_columns):
    cells = np.arange(a * b * c).reshape(a, b, c)
    parts = blocks.grid_parts(cells.shape, n_columns)
    for columns, part in parts:
        np.testing.assert_array_equal(cells[part].ravel(), np.arange(columns.start, columns.stop))
    assert [p[0].start for p in parts[1:]] == [p[0].stop for p in parts[:-1]]
    assert parts[-1][0].stop == cells.size


@pytest.mark.usefixtures("small_blocks")
def test_columns_of_a_block_within_a_row_are_those_of_the_rows():
    made = library(300, 6)
    assert any(block.stop - block.start < 24 * 16 for block in made.blocks())
    columns = np.concatenate([made.columns(block) for block in made.blocks()], axis=2)
    np.testing.assert_array_equal(columns[:, 17], made.row(17))


def test_the_plan_says_what_it_takes():
    lines = PcaPlan.of(library(20, 6), n_threads=2).timed(library(20, 6)).lines()
    assert lines[0] == "20 materials x 2,304 cells: exact, one pass"
    assert lines[1] == "1 block of 2,304 columns, 0.6 MB each; 0.000553 GB of samples in all"
    assert lines[2].startswith("memory at most 0.00 GB")
    assert lines[3].endswith("judged by one block")


def test_more_materials_than_a_gram_matrix_takes_are_sketched():
    plan = PcaPlan.of(_Many(pca.MOST_EXACT + 1), n_threads=2)
    assert (plan.n_vectors, plan.n_passes) == (pca.N_KEPT + 32, 2)
    assert "288 test vectors, 2 passes" in plan.lines()[0]


class _Many(ProceduralLibrary):
    """One table under many names."""

    def __init__(self, n):
        grid = Grid.merl(2, 3, 4)
        (table,) = random_tables(1, grid).values()
        super().__init__("many", {str(i): table for i in range(n)}, grid=grid)


def test_two_thousand_materials_fit_in_a_gigabyte():
    """Arithmetic, at the size of the MERL grid; `benchmarks/growth.py` runs it."""
    plan = PcaPlan.of(_Sized(2000), n_threads=2)
    assert plan.peak_bytes < 0.8e9


class _Sized(_Many):
    """As the MERL grid is cut for as many materials."""

    def blocks(self):
        parts = blocks.grid_parts((90, 90, 180), blocks.columns_per_block(len(self)))
        return [columns for columns, _ in parts]


def test_all_components_of_a_library_are_kept_where_they_are_few():
    assert Pca.fit(library(20, 6)).eigenvalues.shape == (3, 20)
