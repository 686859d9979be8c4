"""Synthetic materials: reproducible, different from one another, sound, and many-dimensional."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from halfway import Pca
from halfway.brdf.check import check
from halfway.errors import LibraryError
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary, open_library
from halfway.models import builtin, synthetic
from halfway.models.synthetic import KINDS, SyntheticModel

GRID = Grid.merl(12, 10, 8)


def test_a_smaller_set_begins_a_larger_one():
    few, many = synthetic(7), synthetic(20)
    assert list(few) == list(many)[:7]
    assert all(few[name].fingerprint() == many[name].fingerprint() for name in few)


def test_materials_and_seeds_differ():
    prints = {m.fingerprint() for seed in (0, 1) for m in synthetic(200, seed).values()}
    assert len(prints) == 400


@pytest.mark.parametrize("name", list(synthetic(len(KINDS))))
def test_every_kind_is_sound(name):
    """Non-negative, reciprocal, and no more light leaves than arrives."""
    card = check(synthetic(len(KINDS))[name])
    assert card.ok, card.broken


@pytest.mark.parametrize("name", list(synthetic(len(KINDS))))
def test_a_distribution_projects_to_1(name):
    """The integral of D cos(theta_h) over the hemisphere, over nodes of another kind: even in theta_h^(1/2)."""
    model = synthetic(len(KINDS))[name]
    root = (np.arange(20_000) + 0.5) / 20_000
    theta_h, step = np.pi / 2 * root**2, np.pi * root / 20_000
    weights = 2 * np.pi * np.sin(theta_h) * np.cos(theta_h) * step
    for lobe in range(2):
        assert_allclose(model.distribution(theta_h, lobe) @ weights, 1, rtol=1e-3)


def test_parts_of_the_grid_are_the_samples_of_the_whole():
    brdf = synthetic(4)["coated-0003"]
    whole = brdf.sample_rows(GRID, slice(None))
    assert_array_equal(brdf.sample_rows(GRID, (slice(3, 5), slice(2, 7))), whole[:, 3:5, 2:7])


def test_many_at_once_are_the_samples_of_each(monkeypatch):
    models, part = list(synthetic(20).values()), (slice(3, 5), slice(2, 7))
    each = [model.sample_rows(GRID, part) for model in models]
    n_cells = each[0][0].size
    monkeypatch.setattr(SyntheticModel, "cells_in_cache", 7 * n_cells)
    assert_array_equal(SyntheticModel.sample_many(models, GRID, part), np.stack(each, axis=1))


def test_many_materials_have_many_dimensions():
    """More than the 5 whose relative error is below 2 % on this coarse grid; fewer than measured ones have."""
    library = ProceduralLibrary("synthetic", synthetic(100), grid=GRID)
    pca = Pca.fit(library)
    left = [np.sqrt(pca.squared_residuals(k) / pca.squared_residuals(0)).mean() for k in (5, 15)]
    assert left[0] > 0.02
    assert left[1] > 0.001


def test_a_set_is_opened_by_its_number_and_seed():
    library = open_library("builtin:synthetic-12-3")
    assert (library.name, len(library)) == ("builtin:synthetic-12-3", 12)
    assert "12 synthetic materials (parametric families, seed 3), not measurements" in (
        library.origin.description
    )
    assert library.checksum != open_library("builtin:synthetic-12").checksum


@pytest.mark.parametrize("name", ["synthetic-0", "synthetic-100001"])
def test_an_impossible_number_is_refused(name):
    with pytest.raises(LibraryError, match=r"has [\d,]+ materials: expected 1 to 100,000\."):
        builtin(name)
