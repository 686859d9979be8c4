"""Libraries: what is stored comes back, what is damaged is refused, both kinds agree."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from strategies import TINY, random_tables

from halfway import Recipe, build_library, mix, open_library
from halfway.cache import cached
from halfway.components import Pca
from halfway.errors import FormatError, LibraryError, OutputError
from halfway.formats import write_merl
from halfway.halfdiff import Grid
from halfway.library import Joined, ProceduralLibrary, StoredLibrary
from halfway.tasks import Work


@pytest.fixture
def folder(tmp_path):
    """A folder of four tiny MERL files and a stray text."""
    source = tmp_path / "measured"
    source.mkdir()
    for name, table in random_tables(4, TINY).items():
        write_merl(source / f"{name}.binary", table)
    (source / "LICENSE.txt").write_text("Do what you like.\n")
    return source


@pytest.fixture
def stored(folder, tmp_path):
    return build_library([folder], tmp_path / "tiny.brdflib").library


def test_a_folder_of_files_becomes_a_library(folder, tmp_path):
    built = build_library([folder], tmp_path / "tiny.brdflib")
    assert built.library.names == ("material-0", "material-1", "material-2", "material-3")
    assert built.library.grid == TINY
    assert [(item.path.rsplit("/", 1)[-1], item.reason) for item in built.skipped] == [
        ("LICENSE.txt", "is text")
    ]
    for name, table in random_tables(4, TINY).items():
        assert_allclose(built.library.brdf(name).values, table.values, rtol=1e-6)


def test_the_files_of_a_library_are_what_the_format_says(stored):
    description = json.loads((stored.path / "library.json").read_text())
    assert description["format"] == 1
    assert [material["name"] for material in description["materials"]] == list(stored.names)
    tables = np.load(stored.tables)
    assert (tables.shape, tables.dtype) == ((3, 4, TINY.size), np.dtype("<f4"))


def test_rows_and_columns_are_the_same_samples(stored):
    columns = np.concatenate([stored.columns(block) for block in stored.blocks()], axis=2)
    for i in range(len(stored)):
        np.testing.assert_array_equal(stored.row(i), columns[:, i])


def test_blocks_cover_the_grid_once():
    library = ProceduralLibrary(
        "merl-sized", random_tables(2, Grid.merl(90, 6, 8)), grid=Grid.merl(90, 6, 8)
    )
    covered = np.concatenate([np.arange(block.start, block.stop) for block in library.blocks()])
    np.testing.assert_array_equal(covered, np.arange(library.grid.size))


def test_stored_and_procedural_give_the_same(small_library, tmp_path):
    """The law of the two kinds: the same PCA, the same mix."""
    source = tmp_path / "files"
    for name in small_library.names:
        write_merl(source / f"{name}.binary", small_library.brdf(name))
    stored = build_library([source], tmp_path / "small.brdflib").library
    a, b = Pca.fit(small_library), Pca.fit(stored)
    assert_allclose(a.eigenvalues, b.eigenvalues, rtol=1e-9, atol=1e-9 * a.eigenvalues.max())
    assert_allclose(a.scores(3), b.scores(3), rtol=1e-6, atol=1e-9 * abs(a.scores(3)).max())
    recipe = {"material-1": 0.25, "material-4": 0.75}
    mixes = [
        mix(library, Recipe.of(library.name, recipe)).values for library in (small_library, stored)
    ]
    assert_allclose(*mixes, rtol=1e-6)


def test_the_checksum_follows_the_samples(folder, tmp_path):
    first = build_library([folder], tmp_path / "a.brdflib").library
    again = build_library([folder], tmp_path / "b.brdflib").library
    assert first.checksum == again.checksum
    write_merl(folder / "material-2.binary", random_tables(1, TINY, seed=9)["material-0"])
    assert build_library([folder], tmp_path / "c.brdflib").library.checksum != first.checksum


def test_tables_of_two_grids_are_refused(folder, tmp_path):
    write_merl(folder / "other.binary", random_tables(1, Grid.merl(2, 3, 4))["material-0"])
    with pytest.raises(
        LibraryError, match=r"2 different grids .*3 x 4 x 5.*2 x 3 x 4|2 x 3 x 4.*3 x 4 x 5"
    ):
        build_library([folder], tmp_path / "mixed.brdflib")
    assert not (tmp_path / "mixed.brdflib").exists()


def test_a_folder_without_a_brdf_is_refused(tmp_path):
    (tmp_path / "README").write_text("nothing here")
    with pytest.raises(LibraryError, match=r"there is no BRDF in .*README: is text"):
        build_library([tmp_path], tmp_path / "empty.brdflib")


def test_a_library_is_never_written_over_something_else(folder, tmp_path):
    thesis = tmp_path / "thesis"
    thesis.mkdir()
    (thesis / "chapter-1.tex").write_text("precious")
    with pytest.raises(OutputError, match="exists and is no library: it is not replaced"):
        build_library([folder], thesis)
    assert (thesis / "chapter-1.tex").read_text() == "precious"


def damage(path):
    """A sample that is no number; header and size are right."""
    with path.open("r+b") as file:
        file.seek(12)
        file.write(np.array([np.nan]).tobytes())


def test_damaged_sources_are_left_out_and_said(folder, tmp_path):
    """Wherever they stand among the others: what is built is the library of the others."""
    for name in ("material-0", "material-2"):
        damage(folder / f"{name}.binary")
    (tmp_path / "text.binary").write_text("no table")
    sources = [folder, tmp_path / "text.binary"]
    library, skipped = build_library(sources, tmp_path / "rest.brdflib")
    assert {Path(item.path).name: item.reason.partition(" (")[0] for item in skipped} == {
        "LICENSE.txt": "is text",
        "text.binary": "is text",
        "material-0.binary": "has a NaN sample",
        "material-2.binary": "has a NaN sample",
    }
    assert library.names == ("material-1", "material-3")
    for name, table in random_tables(4, TINY).items():
        if name in library.names:
            assert_allclose(library.brdf(name).values, table.values, rtol=1e-6)
    assert library.verify() == (2, (), ())


def test_sources_that_are_all_damaged_leave_the_old_library(folder, stored):
    for path in folder.glob("*.binary"):
        damage(path)
    with pytest.raises(LibraryError, match=r"there is no BRDF in .*0\.binary: has a NaN sample"):
        build_library([folder], stored.path)
    assert StoredLibrary(stored.path).checksum == stored.checksum
    assert sorted(p.name for p in stored.path.parent.iterdir()) == ["measured", "tiny.brdflib"]


def test_a_source_that_is_not_there_is_a_mistake(folder, tmp_path):
    with pytest.raises(FormatError, match=r"nowhere\.binary"):
        build_library([folder, tmp_path / "nowhere.binary"], tmp_path / "tiny.brdflib")


def test_building_again_replaces_the_library(folder, stored):
    (folder / "material-0.binary").unlink()
    assert build_library([folder], stored.path).library.names == (
        "material-1",
        "material-2",
        "material-3",
    )
    assert sorted(p.name for p in stored.path.parent.iterdir()) == ["measured", "tiny.brdflib"]


def describe(library, **changes):
    path = library / "library.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def tables(library):
    (path,) = library.glob("tables-*.npy")
    return path


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda p: (p / "library.json").unlink(), "is no library: there is no library.json in it"),
        (lambda p: (p / "library.json").write_text("{"), "library.json cannot be read"),
        (lambda p: (p / "library.json").write_text('{"format": 1}'), "lacks what a library needs"),
        (
            lambda p: describe(p, tables="../tables-0.npy"),
            r"lacks what a library needs \(tables '\.\./tables-0\.npy'\)",
        ),
        (lambda p: describe(p, origin={"licence": 5}), r"needs \(licence is 5, and no text\)"),
        (
            lambda p: describe(
                p, materials=[{"name": "a", "source": "", "source_sha256": "", "sha256": None}]
            ),
            r"needs \(sha256 is None, and no text\)",
        ),
        (lambda p: (p / "library.json").write_text("[" * 100_000), "library.json cannot be read"),
        (lambda p: tables(p).unlink(), r"tables-.*\.npy cannot be read \(No such file"),
        (lambda p: tables(p).write_bytes(b"\x93NUMPY"), r"tables-.*\.npy does not hold"),
        (
            lambda p: np.save(tables(p), np.zeros(3)),
            r"tables-.*\.npy does not hold what library.json describes, float32 \(3, 4, 60\) in 3,008 bytes",
        ),
    ],
)
def test_a_damaged_library_is_refused(stored, damage, message):
    damage(stored.path)
    with pytest.raises(LibraryError, match=message):
        StoredLibrary(stored.path)


def test_a_newer_library_asks_for_an_upgrade(stored):
    path = stored.path / "library.json"
    path.write_text(path.read_text().replace('"format": 1', '"format": 2'))
    with pytest.raises(
        LibraryError,
        match="has library format 2, and this version of halfway reads format 1: upgrade",
    ):
        StoredLibrary(stored.path)


def test_a_misspelt_material_gets_the_nearest_names(small_library):
    with pytest.raises(
        LibraryError,
        match=r"'materail-3' is not one of the 9 materials of small: did you mean material-3",
    ):
        small_library.index("materail-3")


def test_the_builtin_library_is_the_hundred_materials():
    library = open_library("builtin:merl-abc")
    assert len(library) == 100
    assert "stand-in" in library.origin.description
    np.testing.assert_array_equal(
        np.isnan(library.row(5)).any(axis=0), ~library.grid.mask().ravel()
    )


def test_a_builtin_library_can_be_stored_beside_files(tmp_path):
    """What can be sampled anywhere takes the grid of the tables it stands with."""
    write_merl(tmp_path / "mine.binary", random_tables(1, TINY)["material-0"])
    library = build_library(
        [tmp_path / "mine.binary", "builtin:merl-abc"], tmp_path / "both.brdflib"
    ).library
    assert (len(library), library.grid) == (101, TINY)


@pytest.mark.parametrize(
    ("where", "message"),
    [
        ("builtin:merl", "merl-abc"),
        ("nowhere.brdflib", r"there is no library 'nowhere.brdflib': expected a .brdflib folder"),
        (__file__, "is one file, not a library: `halfway library build"),
    ],
)
def test_what_is_no_library_says_what_is(where, message):
    with pytest.raises(LibraryError, match=message):
        open_library(where)


def never():
    raise AssertionError


def test_the_cache_gives_back_what_was_computed(tmp_path):
    cached(tmp_path, "key", lambda: {"a": np.arange(3.0)})
    np.testing.assert_array_equal(cached(tmp_path, "key", never)["a"], np.arange(3.0))


def test_a_full_cache_forgets_what_was_used_longest_ago(tmp_path, monkeypatch):
    n_bytes = 3 * 1000 * 8 + 2000
    monkeypatch.setattr("halfway.cache.MOST_BYTES", n_bytes)
    for second, key in enumerate("abc"):
        cached(tmp_path, key, lambda: {"x": np.ones(1000)})
        os.utime(tmp_path / f"{key}.npz", (second, second))
    cached(tmp_path, "a", never)  # used again
    cached(tmp_path, "d", lambda: {"x": np.ones(1000)})
    assert {path.stem for path in tmp_path.iterdir()} == {"a", "c", "d"}


def test_a_damaged_cache_is_replaced(tmp_path):
    (tmp_path / "key.npz").write_bytes(b"PK\x03\x04 half a file")
    np.testing.assert_array_equal(
        cached(tmp_path, "key", lambda: {"a": np.ones(2)})["a"], np.ones(2)
    )
    np.testing.assert_array_equal(np.load(tmp_path / "key.npz")["a"], np.ones(2))


def test_a_cache_that_cannot_be_written_costs_only_time(tmp_path):
    (tmp_path / "file").write_text("")
    found = cached(tmp_path / "file" / "cache", "key", lambda: {"a": np.ones(2)})
    np.testing.assert_array_equal(found["a"], np.ones(2))


def test_a_library_is_added_to(stored, folder, tmp_path):
    """The materials that were there stay as they are, and components are completed from the cache."""
    Pca.fit(stored, work=Work(cache=tmp_path / "cache"))
    more = tmp_path / "more"
    more.mkdir()
    write_merl(more / "new.binary", random_tables(1, TINY, seed=5)["material-0"])
    grown = build_library([stored.path, more], stored.path).library
    assert grown.names == (*stored.names, "new")
    assert grown.entries[:4] == stored.entries
    assert grown.material_checksums[:4] == stored.material_checksums
    completed, anew = Pca.fit(grown, work=Work(cache=tmp_path / "cache")), Pca.fit(grown)
    assert_allclose(completed.eigenvalues, anew.eigenvalues, atol=1e-10 * anew.eigenvalues.max())
    with pytest.raises(LibraryError, match=r"material-0 is there twice, as .* Rename one"):
        build_library([stored.path, folder], stored.path)
    assert StoredLibrary(stored.path).names == grown.names


def test_what_is_no_table_is_sampled_on_the_grid_asked_for(folder, tmp_path):
    grid = Grid.merl(4, 3, 2)
    built = build_library(["builtin:synthetic-3"], tmp_path / "s.brdflib", grid=grid).library
    assert (built.grid, built.names[0]) == (grid, "matte-0000")
    with pytest.raises(LibraryError, match=r"2 different grids .*4 x 3 x 2"):
        build_library([folder], tmp_path / "t.brdflib", grid=grid)


def test_a_material_is_joined_to_a_library_for_a_while(stored):
    (own,) = random_tables(1, stored.grid, seed=5).values()
    joined = Joined(stored, "own", own)
    assert joined.names == (*stored.names, "own")
    assert joined.material_checksums[:-1] == stored.material_checksums
    assert joined.checksum != stored.checksum
    rows = np.stack([joined.row(i) for i in range(len(joined))], axis=1)
    np.testing.assert_array_equal(rows[:, -1], own.values.reshape(3, -1))
    for block in joined.blocks():
        np.testing.assert_array_equal(joined.columns(block), rows[:, :, block])
