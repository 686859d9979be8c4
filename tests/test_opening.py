"""What a person writes, and the materials that it stands for."""

import json
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from strategies import random_tables

from halfway.brdf import TabularBrdf
from halfway.errors import RecipeError
from halfway.formats import write_merl
from halfway.halfdiff import Grid
from halfway.library import build_library
from halfway.recipes import (
    ChangedLibraryWarning,
    file_names,
    open_materials,
    open_recipe,
    split_address,
)

GRID = Grid.merl(4, 3, 5)
TABLES = random_tables(3, GRID)
A, B, C = TABLES


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with files and a library of them, in which we are."""
    for name, table in TABLES.items():
        write_merl(tmp_path / "measured" / f"{name}.binary", table)
    monkeypatch.chdir(tmp_path)
    build_library(["measured"], tmp_path / "x.brdflib")
    return tmp_path


def values(*words, **options):
    return [material.table().values for material in open_materials(words, **options)]


@pytest.mark.usefixtures("folder")
def test_a_file_a_folder_a_library_and_a_name_are_the_same_tables():
    alone = values(f"measured/{A}.binary", f"x.brdflib:{B}")
    assert_allclose(alone, [TABLES[A].values, TABLES[B].values])
    for many in (["measured"], ["x.brdflib"], [f"measured/{name}.binary" for name in TABLES]):
        assert_allclose(values(*many), [table.values for table in TABLES.values()])


@pytest.mark.usefixtures("folder")
def test_weights_of_files_need_no_library_and_mix_with_one():
    mean = (TABLES[A].values + TABLES[B].values) / 2
    (files,) = values(f"measured/{A}.binary=.5, measured/{B}.binary=.5")
    (both,) = values(f"x.brdflib:measured/{A}.binary=.5, {B}=.5")
    assert_allclose([files, both], [mean, mean], rtol=1e-6)
    assert open_recipe([f"measured/{A}.binary=1"])[0].name == f"measured/{A}.binary"


@pytest.mark.usefixtures("folder")
def test_a_name_may_hold_a_colon():
    assert split_address("x.brdflib:scan 12:30") == ["x.brdflib", "scan 12:30"]
    assert split_address("builtin:merl-abc:teflon") == ["builtin:merl-abc", "teflon"]
    assert split_address("scan 12:30") == ["scan 12:30"]
    assert split_address("builtin:merl-abc:scan 12:30") == ["builtin:merl-abc", "scan 12:30"]
    assert split_address("x.brdflib:a.zip:b") == ["x.brdflib", "a.zip:b"]
    assert split_address("x.brdflib") == ["x.brdflib"]


def document(folder, library, **more):
    recipes = [{"t": t, "weights": {A: 1 - t, B: t}} for t in (0.0, 0.25)]
    (folder / "recipes.json").write_text(
        json.dumps({"library": library, "recipes": recipes} | more)
    )


def test_a_route_and_one_of_it(folder):
    document(folder, "x.brdflib")
    quarter = 0.75 * TABLES[A].values + 0.25 * TABLES[B].values
    assert_allclose(values("recipes.json"), [TABLES[A].values, quarter], rtol=1e-6)
    assert_allclose(values("recipes.json:1"), [quarter], rtol=1e-6)
    with pytest.raises(RecipeError, match=r"holds 2 recipes: name one, recipes.json:0 to"):
        open_materials(["recipes.json:2"])


@pytest.mark.parametrize("word", ["recipes.json", "recipes.json:1", "."])
def test_a_library_that_has_changed_is_said_and_another_can_be_named(folder, word):
    document(folder, "x.brdflib", library_checksum="0" * 64)
    with pytest.warns(ChangedLibraryWarning, match="is not, or no longer, the library that"):
        assert values(word)
    document(folder, "gone.brdflib")
    assert values(word, library="x.brdflib")


@pytest.mark.parametrize("text", ["[" * 100_000, "{", "[]", '{"weights": 3}', '{"recipes": 3}'])
def test_what_is_no_recipe_is_one_line(folder, text):
    (folder / "r.json").write_text(text)
    with pytest.raises(RecipeError) as caught:
        open_materials(["r.json"])
    assert "\n" not in str(caught.value)


@pytest.mark.usefixtures("folder")
def test_a_table_on_another_grid_keeps_its_values_where_it_is_even():
    write_merl(
        "even.binary",
        TabularBrdf(np.full((3, *GRID.shape), 1 / math.pi, np.float32), GRID),
    )
    (material,) = open_materials(["even.binary"])
    finer = material.table(Grid.merl(5, 6, 4))
    assert finer.values.shape == (3, 5, 6, 4)
    assert_allclose(finer.values[np.isfinite(finer.values)], 1 / math.pi, rtol=1e-6)


@pytest.mark.usefixtures("folder")
def test_files_of_one_name_are_counted():
    materials = open_materials([f"measured/{A}.binary", f"x.brdflib:{A}"])
    assert file_names(materials, ".png") == [f"{A}.png", f"{A}-2.png"]
