"""The file for Blender: what is in it, and what is refused."""

import io
import json
import zipfile

import numpy as np
import pytest
from glossy import library
from numpy.testing import assert_allclose

from halfway.brdf import tabulate
from halfway.errors import OutputError
from halfway.export.blender import GRID, write_blender
from halfway.recipes import NamedBrdf, Recipe
from halfway.tasks import HERE

GLOSSY = library(6)


def named(*names: str) -> list[NamedBrdf]:
    return [NamedBrdf.mixed(GLOSSY, Recipe.of(GLOSSY, {name: 1.0})) for name in names]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path = write_blender(tmp_path_factory.mktemp("space"), named("m0", "m3", "m5"), HERE)
    return zipfile.ZipFile(path)


def test_a_way_for_each_pair_begins_and_ends_at_its_stops(written):
    document = json.loads(written.read("space.json"))
    assert document["stops"] == ["m0", "m3", "m5"]
    names = [material["name"] for material in document["materials"]]
    assert [(way["from"], way["to"]) for way in document["ways"]] == [("m0", "m3"), ("m0", "m5"), ("m3", "m5")]  # fmt: skip
    for way in document["ways"]:
        assert (way["knots"][0], way["knots"][-1]) == (0, 1)
        assert (way["weights"][0], way["weights"][-1]) == ({way["from"]: 1}, {way["to"]: 1})
        for weights in way["weights"]:
            assert set(weights) <= set(names)
            assert sum(weights.values()) == pytest.approx(1)


def test_tables_pictures_and_fits_are_the_materials(written):
    document = json.loads(written.read("space.json"))
    for i, material in enumerate(document["materials"]):
        values = np.load(io.BytesIO(written.read(f"tables/{i:03}.npy")))
        expected = tabulate(GLOSSY.brdf(material["name"]), GRID).values
        # Half floats: eleven significant bits, and steps of 2^-24 below their normal range.
        assert_allclose(values * material["scale"], expected, rtol=2**-11, atol=2**-24 * material["scale"])  # fmt: skip
        assert written.read(f"pictures/{i:03}.png").startswith(b"\x89PNG")
        assert material["fit"]["model"] == document["model"] == "cycles"


def test_the_command_writes_the_space_of_a_library_into_a_folder(run, lib):
    stops = ["material-0", "material-1"]
    words = [f"{lib}:{name}" for name in stops]
    code, _, talk = run("export", *words, "--for", "blender", "-o", "space")
    assert code == 0, talk
    assert talk.startswith("space: tiny.brdfspace\n")
    document = json.loads(zipfile.ZipFile("space/tiny.brdfspace").read("space.json"))
    assert document["stops"] == stops


def test_what_lies_in_no_space_is_refused(tmp_path):
    mixed = NamedBrdf.mixed(GLOSSY, Recipe.of(GLOSSY, {"m0": 0.5, "m1": 0.5}))
    with pytest.raises(OutputError, match="mix is no material of a library: expected materials"):
        write_blender(tmp_path, [mixed], HERE)
    other = library(4, seed=1)
    strangers = [*named("m0"), NamedBrdf.mixed(other, Recipe.of(other, {"m1": 1.0}))]
    with pytest.raises(OutputError, match="are of 2 libraries: expected one"):
        write_blender(tmp_path, strangers, HERE)
