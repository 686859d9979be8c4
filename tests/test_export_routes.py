"""Route folders: what is written, what is kept, what is refused."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway import LinearSpace, Route, TabularBrdf, build_library, mix, open_library
from halfway.errors import OutputError
from halfway.export import write_route
from halfway.formats import read_brdf, read_merl, write_merl
from halfway.formats.rgl_writer import Resolution
from halfway.library import ProceduralLibrary


@pytest.fixture
def route(small_library):
    return Route.through(LinearSpace.of(small_library), ["material-0", "material-1"])


def test_the_folder_holds_the_recipes_and_the_tables(route, small_library, tmp_path):
    written = write_route(tmp_path / "route", route, route.steps(3), small_library, format="merl")
    assert written == (3, 0)
    assert sorted(p.name for p in (tmp_path / "route").iterdir()) == [
        "000.binary",
        "001.binary",
        "002.binary",
        "manifest.json",
        "recipes.json",
    ]
    document = json.loads((tmp_path / "route" / "recipes.json").read_text())
    assert {key: document[key] for key in ("format", "library", "space", "pace", "blend", "stops")} == {
        "format": 2, "library": "small", "space": "linear", "pace": "uniform", "blend": "linear", "stops": ["material-0", "material-1"]
    }  # fmt: skip
    assert document["recipes"][1] == {"t": 0.5, "weights": {"material-0": 0.5, "material-1": 0.5}}


def test_first_and_last_table_are_the_stops(route, small_library, tmp_path):
    write_route(tmp_path, route, route.steps(3), small_library, format="merl")
    for file, name in (("000", "material-0"), ("002", "material-1")):
        assert_allclose(
            read_merl(tmp_path / f"{file}.binary").values,
            small_library.brdf(name).values,
            rtol=1e-6,
        )
    middle = read_merl(tmp_path / "001.binary").values
    np.testing.assert_array_equal(np.isnan(middle[0]), ~small_library.grid.mask())
    assert np.nanmin(middle) >= 0


def test_what_is_finished_is_kept_and_what_is_cut_is_written_again(route, small_library, tmp_path):
    write_route(tmp_path, route, route.steps(4), small_library, format="merl")
    untouched = (tmp_path / "000.binary").stat().st_mtime_ns
    whole = (tmp_path / "002.binary").read_bytes()
    (tmp_path / "001.binary").unlink()
    (tmp_path / "002.binary").write_bytes(whole[:100])
    assert write_route(tmp_path, route, route.steps(4), small_library, format="merl") == (2, 2)
    assert (tmp_path / "002.binary").read_bytes() == whole
    assert (tmp_path / "000.binary").stat().st_mtime_ns == untouched


def test_another_route_in_the_same_folder_keeps_no_stale_table(route, small_library, tmp_path):
    write_route(tmp_path, route, route.steps(5), small_library, format="merl")
    other = Route.through(LinearSpace.of(small_library), ["material-2", "material-3"])
    assert write_route(tmp_path, other, other.steps(3), small_library, format="merl") == (3, 0)
    assert not (tmp_path / "004.binary").exists()
    assert_allclose(
        read_merl(tmp_path / "000.binary").values,
        small_library.brdf("material-2").values,
        rtol=1e-6,
    )


def test_a_library_that_moved_keeps_the_tables(small_library, tmp_path):
    for name in small_library.names[:2]:
        write_merl(tmp_path / "measured" / f"{name}.binary", small_library.brdf(name))
    library = build_library([tmp_path / "measured"], tmp_path / "here" / "some.brdflib").library
    route = Route.through(LinearSpace.of(library), library.names)
    write_route(tmp_path / "route", route, route.steps(4), library, format="merl")
    (tmp_path / "here").rename(tmp_path / "there")
    moved = open_library(tmp_path / "there" / "some.brdflib")
    again = write_route(tmp_path / "route", route, route.steps(4), moved, format="merl")
    assert again == (0, 4)
    document = json.loads((tmp_path / "route" / "recipes.json").read_text())
    assert document["library_address"] == moved.address


def test_the_same_route_without_tables_keeps_those_that_are_there(route, small_library, tmp_path):
    write_route(tmp_path, route, route.steps(4), small_library, format="merl")
    assert write_route(tmp_path, route, route.steps(4), small_library) == (0, 0)
    assert write_route(tmp_path, route, route.steps(4), small_library, format="merl") == (0, 4)


@pytest.mark.parametrize("factor", [1, 1e6])
def test_a_zarr_store_holds_the_tables_in_half_precision(small_library, tmp_path, factor):
    import zarr

    bright = {
        name: TabularBrdf(factor * small_library.brdf(name).values, small_library.grid)
        for name in small_library.names[:2]
    }
    library = ProceduralLibrary("bright", bright, grid=small_library.grid)
    route = Route.through(LinearSpace.of(library), library.names)
    write_route(tmp_path, route, route.steps(3), library, format="zarr")
    tables = zarr.open_array(str(tmp_path / "tables.zarr"), mode="r")
    scale = tables.attrs["scale"]
    largest = max(np.nanmax(table.values) for table in bright.values())
    assert tables.shape == (3, 3, *library.grid.shape)
    assert scale == 1 if factor == 1 else 30_000 < largest / scale <= 60_000
    for i, recipe in enumerate(route.recipes(route.steps(3))):
        expected = mix(library, recipe).values
        found = np.asarray(tables[i], np.float32) * scale
        assert_allclose(found, expected, rtol=2**-11, atol=scale * 2**-25)


def test_rgl_files_are_read_by_their_reader(route, small_library, tmp_path, monkeypatch):
    monkeypatch.setattr("halfway.formats.rgl_writer.RESOLUTIONS", [Resolution(8, 8)])
    assert write_route(tmp_path, route, route.steps(2), small_library, format="bsdf") == (2, 0)
    assert read_brdf(tmp_path / "001.bsdf").is_isotropic


def test_a_foreign_recipes_json_is_not_touched(route, small_library, tmp_path):
    (tmp_path / "recipes.json").write_text('["lasagne"]')
    with pytest.raises(OutputError, match="is in the way: no manifest of halfway names it"):
        write_route(tmp_path, route, route.steps(3), small_library)
    assert (tmp_path / "recipes.json").read_text() == '["lasagne"]'


def test_a_library_s_folder_stays_its_own(route, small_library, tmp_path):
    write_merl(tmp_path / "one.binary", small_library.brdf("material-0"))
    library = build_library([tmp_path / "one.binary"], tmp_path / "one.brdflib").library
    before = sorted(library.path.iterdir())
    with pytest.raises(OutputError, match=r"one\.brdflib holds a library: expected a folder"):
        write_route(library.path, route, route.steps(3), small_library)
    assert sorted(library.path.iterdir()) == before


def test_a_folder_that_is_a_file_gets_one_line(route, small_library, tmp_path):
    (tmp_path / "route").write_text("")
    with pytest.raises(OutputError, match="part of its path is a file, not a folder"):
        write_route(tmp_path / "route", route, route.steps(3), small_library)


def test_too_little_space_is_said_before_anything_is_written(
    route, small_library, tmp_path, monkeypatch
):
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("usage", (), {"free": 1000})())
    with pytest.raises(
        OutputError, match=r"a batch of 4 files takes \d\.\d MB and .* has 0\.0 MB free"
    ):
        write_route(tmp_path / "route", route, route.steps(3), small_library, format="merl")
    assert not (tmp_path / "route").exists()
