"""Sets of new materials: drawn evenly, apart, split by parents, written whole."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway import open_library
from halfway.batch import verify
from halfway.errors import FormatError, LibraryError, SpaceError
from halfway.formats import read_merl
from halfway.halfdiff import Grid
from halfway.library import Permuted, ProceduralLibrary, build_library
from halfway.look import cielab_difference
from halfway.models import synthetic
from halfway.recipes import mix, open_materials, open_recipe
from halfway.sets import listed, sample, write_set
from halfway.sets.apart import Apart
from halfway.sets.drawing import Simplices, squared_distances, visible_volumes
from halfway.tasks import Work


@pytest.fixture(scope="module")
def library():
    """Sixteen synthetic materials on a coarse grid."""
    return ProceduralLibrary("sixteen", synthetic(16, 0), grid=Grid.merl(12, 6, 6))


@pytest.fixture(scope="module")
def work(tmp_path_factory):
    return Work(cache=tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="module")
def drawn(library, work):
    return sample(library, 20, work=work, permute_channels=True, splits={"train": 70, "test": 30})


# Volumes and chances


def test_the_visible_volume_of_a_triangle_is_its_area():
    """Pictures of one pixel are points of CIELAB: a right triangle with legs 3 and 4."""
    pictures = np.array([[[0, 0, 0]], [[3, 0, 0]], [[0, 4, 0]]], float)
    volumes = visible_volumes(np.array([[0, 1, 2]]), squared_distances(pictures))
    assert_allclose(volumes, [6.0])


def test_a_simplex_twice_as_large_is_drawn_twice_as_often():
    simplices = Simplices(np.array([[0, 1], [1, 2]]), np.array([2.0, 1.0]))
    weights = simplices.draw(np.random.default_rng(0), 3000, 3)
    share = (weights[:, 0] > 0).mean()
    assert abs(share - 2 / 3) < 4 * np.sqrt(2 / 9 / 3000)
    assert_allclose(weights.sum(axis=1), 1)


def test_between_two_corners_a_point_is_drawn_evenly():
    weights = Simplices(np.array([[0, 1]]), np.array([1.0])).draw(np.random.default_rng(0), 4000, 2)
    quartiles = np.quantile(weights[:, 0], [0.25, 0.5, 0.75])
    assert_allclose(quartiles, [0.25, 0.5, 0.75], atol=4 * 0.5 / np.sqrt(4000))


# Distances


def test_the_nearest_picture_is_that_of_all_distances():
    rng = np.random.default_rng(0)
    pictures = rng.normal(size=(60, 40, 3)).astype(np.float32)
    apart = Apart(pictures[1:])
    expected = float(cielab_difference(pictures[1:], pictures[0]).min())
    assert apart.nearest(pictures[0]) == pytest.approx(expected, rel=1e-6)
    assert apart.nearest(pictures[0], within=expected / 2) == expected / 2
    assert apart.nearest(pictures[1], but=0) > apart.nearest(pictures[1]) == 0


def test_no_two_look_nearer_than_was_asked_for(drawn):
    assert drawn.diversity.nearest.min() >= 1.0
    assert min(each.nearest for each in drawn.samples) == drawn.diversity.nearest.min()


def test_what_does_not_fit_is_refused(library, work):
    with pytest.raises(SpaceError, match=r"only \d of 4 materials look at least 60 different"):
        sample(library, 4, work=work, least=60.0, splits={"all": 1})


# Splits and seeds


def test_no_material_has_a_part_in_two_splits(drawn, library):
    parents = {split: set() for split in drawn.splits}
    for each in drawn.samples:
        parents[each.split] |= {name.split(".")[0] for name in each.recipe.names}
    assert not parents["train"] & parents["test"]
    assert parents["train"] <= set(drawn.splits["train"])
    assert len(drawn.splits["train"]) == 11
    assert sum(map(len, drawn.splits.values())) == len(library)
    assert [each.split for each in drawn.samples].count("train") == 14


def test_the_same_seed_gives_the_same_set(library, work):
    sets = [
        sample(library, 3, work=work, seed=seed, splits={"all": 1}, space="paper").to_json()[
            "recipes"
        ]
        for seed in (1, 1, 2)
    ]
    assert sets[0] == sets[1] != sets[2]


def test_a_split_of_one_material_is_refused(small_library):
    with pytest.raises(SpaceError, match="'test' gets 1 of 9 materials"):
        sample(small_library, 4, splits={"train": 90, "test": 10})
    with pytest.raises(SpaceError, match="positive shares"):
        sample(small_library, 4, splits={"train": 0})


def test_a_space_without_points_is_refused(library, work):
    with pytest.raises(SpaceError, match="nothing can be drawn"):
        sample(library, 4, work=work, space="linear", splits={"all": 1})


# Channels


def test_permuted_materials_are_the_material_with_its_channels_in_another_order(small_library):
    permuted = Permuted(small_library)
    assert permuted.names[:3] == ("material-0", "material-0.rbg", "material-0.grb")
    whole = small_library.row(0)
    np.testing.assert_array_equal(
        permuted.brdf("material-0.gbr").values.reshape(3, -1), whole[[1, 2, 0]]
    )
    (columns,) = permuted.blocks()
    rows = np.stack([permuted.row(i) for i in range(len(permuted))], axis=1)
    np.testing.assert_array_equal(permuted.columns(columns), rows)


def test_a_permuted_library_opens_by_its_address():
    library = open_library("permuted:builtin:merl-abc")
    assert open_library(library.address).checksum == library.checksum
    opened, recipe = open_recipe(["permuted:builtin:merl-abc:teflon.bgr"])
    assert (opened.name, recipe.names) == ("permuted:builtin:merl-abc", ("teflon.bgr",))


def test_a_permuted_sample_is_the_mix_with_its_channels_in_that_order(drawn, library):
    each = next(each for each in drawn.samples if each.name.endswith(".gbr"))
    assert all(name.endswith(".gbr") for name in each.recipe.names)
    weights = {name.removesuffix(".gbr"): w for name, w in each.recipe.to_json()["weights"].items()}
    plain = mix(library, weights, blend=each.recipe.blend)
    permuted = mix(drawn.library, each.recipe)
    assert_allclose(permuted.values, plain.values[[1, 2, 0]], rtol=1e-6)


# Folders


def test_a_folder_holds_recipes_tables_a_card_and_what_machines_read(drawn, tmp_path):
    assert write_set(tmp_path / "set", drawn, format="merl").n_written == 20
    assert verify(tmp_path / "set").ok
    document = json.loads((tmp_path / "set" / "recipes.json").read_text())
    first = document["recipes"][0]
    table = read_merl(tmp_path / "set" / first["split"] / f"{first['name']}.binary")
    assert_allclose(table.values, mix(drawn.library, drawn.samples[0].recipe).values, rtol=1e-6)
    assert "| train | 14 | 11 |" in (tmp_path / "set" / "README.md").read_text()
    about = json.loads((tmp_path / "set" / "croissant.json").read_text())
    assert about["conformsTo"] == "http://mlcommons.org/croissant/1.0"
    kinds = [each["@type"] for each in about["distribution"]]
    assert kinds == ["cr:FileObject", "cr:FileSet"]


def test_what_was_written_is_kept(drawn, tmp_path):
    write_set(tmp_path / "set", drawn, format="merl")
    lost = tmp_path / "set" / "train" / f"{drawn.samples[3].name}.binary"
    lost.unlink()
    assert write_set(tmp_path / "set", drawn, format="merl") == (1, 19)
    assert lost.is_file()


def test_the_recipes_of_a_folder_are_materials(tmp_path):
    built = build_library(["builtin:merl-abc"], tmp_path / "abc.brdflib", grid=Grid.merl(6, 5, 8))
    few = sample(built.library, 3, splits={"all": 1}, space="paper")
    write_set(tmp_path / "set", few)
    materials = open_materials([str(tmp_path / "set")])
    assert [each.label for each in materials] == [each.name for each in few.samples]
    assert materials[1].recipe.to_json() == few.samples[1].recipe.to_json()


# Lists


def test_a_list_is_mixed_with_the_weights_of_the_first(small_library, tmp_path):
    path = tmp_path / "list.txt"
    path.write_text("material-1 material-2 0.25\n\nmaterial-0 material-1 0.5\n")
    pairs = listed(small_library, path)
    assert pairs.samples[0].recipe.to_json()["weights"] == {"material-1": 0.25, "material-2": 0.75}
    assert pairs.splits == {"all": ["material-0", "material-1", "material-2"]}
    assert len(listed(small_library, path, permute_channels=True)) == 12


@pytest.mark.parametrize("line", ["material-1 material-2", "material-1 material-2 1.5", "a b c d"])
def test_a_line_that_is_no_pair_is_told(small_library, tmp_path, line):
    path = tmp_path / "list.txt"
    path.write_text(f"material-1 material-2 0.25\n{line}\n")
    with pytest.raises(FormatError, match="line 2 of"):
        listed(small_library, path)


def test_a_list_of_other_materials_and_no_list_are_refused(small_library, tmp_path):
    path = tmp_path / "list.txt"
    path.write_text("material-1 gold 0.25\n")
    with pytest.raises(LibraryError, match="'gold' is not one of the 9 materials"):
        listed(small_library, path)
    path.write_text("\n")
    with pytest.raises(FormatError, match="is no list"):
        listed(small_library, path)
