"""A material as a file: what cannot be said in it stands beside it."""

import json

import numpy as np
from strategies import TINY, random_tables

from halfway.export import write_material
from halfway.formats import read_brdf, write_merl
from halfway.library import Origin, ProceduralLibrary, build_library
from halfway.recipes import NamedBrdf, Recipe, open_materials


def test_a_mix_keeps_its_recipe_source_and_licence(tmp_path):
    """And what stands beside it is a recipe, which gives the same file again."""
    for name, table in random_tables(3, TINY).items():
        write_merl(tmp_path / "files" / f"{name}.binary", table)
    origin = Origin("clay", "a lab", "share alike")
    built = build_library([tmp_path / "files"], tmp_path / "lab.brdflib", origin=origin)
    recipe = Recipe.of(built.library, {"material-0": 0.25, "material-2": 0.75})
    write_material(tmp_path / "new.binary", NamedBrdf.mixed(built.library, recipe))
    document = json.loads((tmp_path / "new.recipe.json").read_text())
    assert document["weights"] == {"material-0": 0.25, "material-2": 0.75}
    assert [document[key] for key in ("source", "licence")] == ["a lab", "share alike"]
    (again,) = open_materials([str(tmp_path / "new.recipe.json")])
    write_material(tmp_path / "again.binary", again)
    assert (tmp_path / "again.binary").read_bytes() == (tmp_path / "new.binary").read_bytes()


def test_what_is_no_mix_has_no_recipe(tmp_path):
    library = ProceduralLibrary("two", random_tables(2, TINY), grid=TINY)
    (tmp_path / "out").mkdir()
    write_merl(tmp_path / "one.binary", library.brdf("material-1"))
    (material,) = open_materials([str(tmp_path / "one.binary")])
    write_material(tmp_path / "out" / "copy.binary", material)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["copy.binary"]
    np.testing.assert_array_equal(
        read_brdf(tmp_path / "out" / "copy.binary").values, material.table().values
    )
