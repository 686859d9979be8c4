"""Compact libraries: what is kept comes back, what is lost is stated, what is damaged is refused."""

import json
import pickle
import time
import zipfile

import numpy as np
import pytest
from numpy.testing import assert_allclose
from strategies import random_tables

from halfway import Pca, Recipe, TabularBrdf, mix, open_library
from halfway.brdf.metrics import difference
from halfway.components import compact_library
from halfway.errors import LibraryError
from halfway.halfdiff import Grid
from halfway.library import Coding, CompactLibrary, ProceduralLibrary, blocks
from halfway.models import synthetic

GRID = Grid.merl(12, 8, 6)
CODINGS = [
    Coding(mapping, shared, precision)
    for mapping in ("log", "linear")
    for shared in (True, False)
    for precision in ("int8", "float16", "float32")
]


@pytest.fixture(scope="module")
def library():
    return ProceduralLibrary("twelve", synthetic(12), grid=GRID)


@pytest.fixture(scope="module")
def compact(library, tmp_path_factory):
    return compact_library(library, tmp_path_factory.mktemp("compact") / "a.brdfc", n_components=9)


@pytest.mark.parametrize("coding", CODINGS, ids=str)
def test_all_components_give_the_samples_back(library, tmp_path, coding):
    """To the precision: a component in 127 steps of a run is off by half a step, 1/254 of its largest."""
    k = 35 if coding.shared else 11
    kept = compact_library(library, tmp_path / "all.brdfc", n_components=k, coding=coding)
    rtol = {"int8": 2e-2, "float16": 2e-3, "float32": 2e-5}[coding.precision]
    for i in (0, 4, 11):
        found, wanted = kept.row(i), library.row(i)
        np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
        if coding.mapping == "log":
            # An error of the logarithm is a share of f w + .001.
            assert difference(as_table(wanted), as_table(found), "log-relative").below < rtol
        else:
            # A step is shared by a run of cells, here the whole grid: its error is a share of the largest value.
            largest = max(np.nanmax(library.row(j)) for j in range(12))
            assert np.nanmax(abs(found - wanted)) < rtol * largest


def as_table(row):
    return TabularBrdf(row.reshape(3, *GRID.shape), GRID)


def test_linear_components_per_channel_are_the_truncated_pca(library, tmp_path):
    coding = Coding("linear", shared=False, precision="float32")
    kept = compact_library(library, tmp_path / "k.brdfc", n_components=4, coding=coding)
    wanted = Pca.fit(library).reconstruct(library, "metal-0002", 4).values
    assert_allclose(kept.brdf("metal-0002").values, np.maximum(wanted, 0), rtol=1e-3, atol=1e-4)
    relative = np.sqrt(
        Pca.fit(library).squared_residuals(4) / Pca.fit(library).squared_residuals(0)
    )
    # Clamped at 0, an error can only be smaller.
    assert kept.header.error["mean_relative_error"] <= relative.mean() * 1.0001
    assert_allclose(kept.header.error["mean_relative_error"], relative.mean(), rtol=0.1)


def test_the_stated_error_is_that_of_the_tables(library, compact):
    tables = np.stack([library.row(i) for i in range(12)], axis=1).astype(float)
    kept = np.stack([compact.row(i) for i in range(12)], axis=1)
    both = ~np.isnan(tables[0, 0])
    p, q = tables[..., both], kept[..., both]
    centred = p - p.mean(axis=1, keepdims=True)
    relative = np.linalg.norm(p - q, axis=2) / np.linalg.norm(centred, axis=2)
    assert_allclose(compact.header.error["mean_relative_error"], relative.mean(), rtol=1e-6)
    apart = [
        difference(library.brdf(name), compact.brdf(name), "log-relative").below
        for name in library.names
    ]
    assert_allclose(
        compact.header.error["log_relative"], np.sqrt(np.mean(np.square(apart))), rtol=1e-5
    )


def test_a_file_is_opened_as_a_library(library, compact):
    opened = open_library(compact.path)
    assert isinstance(opened, CompactLibrary)
    assert (opened.names, opened.grid) == (library.names, library.grid)
    assert opened.checksum == compact.checksum != library.checksum
    assert "synthetic" not in opened.name
    assert opened.origin.description == "twelve; reconstructed from 9 principal components"
    table = mix(opened, Recipe.of(opened.name, {"metal-0002": 0.5, "matte-0000": 0.5}))
    a, b = opened.brdf("metal-0002").values, opened.brdf("matte-0000").values
    assert_allclose(table.values, (a + b) / 2, rtol=1e-6)
    assert Pca.fit(opened).eigenvalues.shape == (3, 12)


def test_rows_and_columns_are_the_same_samples(compact, monkeypatch):
    monkeypatch.setattr(blocks, "WORK_BYTES", 9000)
    monkeypatch.setattr(blocks, "BLOCK_BYTES", 9000)
    assert len(compact.blocks()) > 5
    columns = np.concatenate([compact.columns(block) for block in compact.blocks()], axis=2)
    for i in (0, 7):
        assert_allclose(compact.row(i), columns[:, i], rtol=1e-5)


def test_samples_are_never_negative(library, tmp_path):
    """One linear component leaves large errors on both sides."""
    coding = Coding("linear")
    kept = compact_library(library, tmp_path / "one.brdfc", n_components=1, coding=coding)
    rows = np.stack([kept.row(i) for i in range(12)])
    assert np.nanmin(rows) == 0


def test_more_components_lose_less(library, tmp_path):
    errors = [
        compact_library(library, tmp_path / f"{k}.brdfc", n_components=k).header.error
        for k in (1, 4, 12)
    ]
    assert errors[0]["log_relative"] > errors[1]["log_relative"] > errors[2]["log_relative"]


def test_a_cell_unmeasured_in_one_channel_of_one_material_is_unmeasured_in_all(tmp_path):
    tables = random_tables(5, GRID)
    holed = tables["material-2"].values.copy()
    holed[1, 3, 1, 2] = np.nan
    tables["material-2"] = TabularBrdf(holed, GRID)
    library = ProceduralLibrary("holed", tables, grid=GRID)
    kept = compact_library(library, tmp_path / "holed.brdfc", n_components=3)
    for name in library.names:
        assert np.isnan(kept.brdf(name).values[:, 3, 1, 2]).all()
        assert (np.isnan(kept.brdf(name).values) == ~GRID.mask()).sum() == 3 * (GRID.size - 1)


def test_the_same_library_gives_the_same_bytes(library, compact, tmp_path, monkeypatch):
    """On any day."""
    tomorrow = time.time() + 86400
    monkeypatch.setattr("time.time", lambda: tomorrow)
    again = compact_library(library, tmp_path / "again.brdfc", n_components=9)
    assert again.checksum == compact.checksum
    assert again.path.read_bytes() == compact.path.read_bytes()


@pytest.mark.parametrize("k", [0, 36])
def test_an_impossible_number_of_components_is_refused(library, tmp_path, k):
    with pytest.raises(LibraryError, match=r"cannot be kept in \d+ components: it has 36 rows"):
        compact_library(library, tmp_path / "k.brdfc", n_components=k)
    assert list(tmp_path.iterdir()) == []


def rewrite(path, change):
    """The file with one member changed, or left out where it becomes None."""
    name, edit = change
    with zipfile.ZipFile(path) as archive:
        members = {info.filename: archive.read(info) for info in archive.infolist()}
    members[name] = edit(members[name])
    with zipfile.ZipFile(path, "w") as archive:
        for key, data in members.items():
            if data is not None:
                archive.writestr(key, data)


def header(**changes):
    return lambda data: json.dumps(json.loads(data) | changes)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("compact.json", lambda _: "{"), "compact.json cannot be read"),
        (("compact.json", lambda _: "[]"), "compact.json is no object"),
        (
            ("compact.json", header(format=2)),
            "has compact format 2, and this version .* reads format 1",
        ),
        (("compact.json", header(mapping="cube")), "lacks what a compact library needs"),
        (("compact.json", header(n_components=8)), "steps has .* bytes where .* are expected"),
        (("compact.json", header(materials=["a"])), "scores has .* bytes where"),
        (("compact.json", header(materials=[])), "0 materials have 0 names"),
        (("compact.json", header(materials=["a"] * 12)), "12 materials have 1 names"),
        (("compact.json", header(materials=list("abcdefghijkl"))), "its numbers have checksum"),
        (("compact.json", header(mapping="linear")), "its numbers have checksum"),
        (("scores", lambda data: bytes(len(data))), "its numbers have checksum"),
        (("cells", lambda data: data[:-1]), "cells has .* bytes where .* are expected"),
        (("starts", lambda data: data[8:]), "starts do not ascend"),
        (("mean", lambda data: data[:-4]), "mean has .* bytes where .* are expected"),
        (("components", lambda _: None), "no item named 'components'"),
    ],
)
def test_a_damaged_file_is_one_line(compact, tmp_path, change, message):
    path = tmp_path / "damaged.brdfc"
    path.write_bytes(compact.path.read_bytes())
    rewrite(path, change)
    with pytest.raises(LibraryError, match=message) as error:
        CompactLibrary(path).row(0)
    assert "\n" not in str(error.value)


def test_a_flipped_bit_is_found(compact, tmp_path):
    path = tmp_path / "flipped.brdfc"
    data = bytearray(compact.path.read_bytes())
    data[len(data) // 2] ^= 16
    path.write_bytes(data)
    with pytest.raises(LibraryError, match="is no sound compact library"):
        CompactLibrary(path).row(0)


@pytest.mark.parametrize("seed", range(40))
def test_whatever_is_damaged_is_one_line_or_the_same(compact, tmp_path, seed):
    """A bit of the directory may name a way to compress that nobody has."""
    generator = np.random.default_rng(seed)
    path = tmp_path / "damaged.brdfc"
    data = bytearray(compact.path.read_bytes())
    data[generator.integers(len(data) - 600, len(data))] ^= 1 << generator.integers(8)
    path.write_bytes(data[: generator.integers(len(data))] if seed % 4 == 0 else data)
    said, row = "", None
    try:
        row = open_library(path).row(0)
    except LibraryError as error:
        said = str(error)
    if row is None:
        assert said.startswith(f"{path} is no sound compact library")
        assert "\n" not in said
    else:
        np.testing.assert_array_equal(row, compact.row(0))


def test_a_file_that_changes_under_a_task_is_told(library, tmp_path):
    made = compact_library(library, tmp_path / "a.brdfc", n_components=3)
    travels = pickle.dumps(made)
    compact_library(library, tmp_path / "a.brdfc", n_components=4)
    with pytest.raises(LibraryError, match=r"has checksum \w{12} here and \w{12} where the work"):
        pickle.loads(travels)


def test_a_file_is_not_written_over_what_it_is_made_of(compact):
    with pytest.raises(LibraryError, match=r"is the library itself, .*: expected another file"):
        compact_library(compact, compact.path, n_components=2)


def test_a_name_that_would_not_be_opened_is_refused(library, tmp_path):
    with pytest.raises(LibraryError, match=r"expected NAME\.brdfc, by which it is opened"):
        compact_library(library, tmp_path / "a.xyz", n_components=2)
    assert list(tmp_path.iterdir()) == []
