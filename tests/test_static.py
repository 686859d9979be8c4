"""The explorer as a folder of files."""

import gzip
import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from strategies import random_tables
from typer.testing import CliRunner

from halfway.cli import app
from halfway.errors import HalfwayError, LibraryError, OutputError
from halfway.halfdiff import Grid
from halfway.instruments import attributes
from halfway.library import Library, ProceduralLibrary, Subset
from halfway.look import Looks, most_different
from halfway.server.blocks import Block
from halfway.server.page import Asset, Page
from halfway.server.static import N_LARGEST, export
from halfway.space import make_space

HTML = Asset(b"<!doctype html><html><head><title>halfway</title></head></html>", "text/html", "")
PAGE = Page({"index.html": HTML, "assets/page.js": Asset(b"mount()", "text/javascript", "")})


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.fixture(scope="module")
def few(small_library: Library) -> Library:
    """As few as have several simplices in each channel of the paper's space."""
    return Subset(small_library, small_library.names[:6])


@pytest.fixture(scope="module")
def exported(few: Library, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("static") / "site"
    written = export(few, folder, PAGE)
    found = contents(folder)
    del found["manifest.json"]
    assert written == (len(found), sum(map(len, found.values())))
    return folder


def test_the_same_library_makes_the_same_bytes(small_library: Library, tmp_path: Path) -> None:
    library = Subset(small_library, small_library.names[:4])
    export(library, tmp_path / "site", PAGE)
    before = contents(tmp_path / "site")
    export(library, tmp_path / "site", PAGE)
    assert contents(tmp_path / "site") == before
    assert [path.name for path in tmp_path.iterdir()] == ["site"]


def test_the_page_knows_where_its_data_are_and_what_it_may_load(exported: Path) -> None:
    html = (exported / "index.html").read_text()
    assert '<meta name="halfway-data" content="./data/" />' in html
    assert "default-src 'none'; script-src 'self'" in html
    # A browser complains of this one where it stands in a page.
    assert "frame-ancestors" not in html
    assert (exported / "assets" / "page.js").read_bytes() == b"mount()"


def test_a_table_is_the_one_that_the_server_sends(small_library: Library, exported: Path) -> None:
    block = Block.of_table(small_library.brdf("material-3"))
    folder = json.loads((exported / "data" / "explorer.json").read_text())
    assert folder["library"]["blends"] == ["linear"]  # whose pictures mix in the page
    assert gzip.decompress((exported / "data/tables/3.bin").read_bytes()) == block.body
    assert folder["tables"][3] == {"shape": list(block.shape), "scale": list(block.scale)}
    # Files cannot mix.
    assert folder["library"]["exports"] == []


def test_the_attributes_are_those_of_the_materials(few: Library, exported: Path) -> None:
    document = json.loads((exported / "data/attributes.json").read_text())
    listed = {each["name"]: each["values"] for each in document["attributes"]}
    own = attributes(few.brdf(few.names[2]))["albedo"]
    assert_allclose(listed["albedo"][2], own, rtol=1e-6)


def test_every_pair_has_its_way_in_every_space(few: Library, exported: Path) -> None:
    n = len(few)
    for space in ("anchored", "paper", "linear"):
        legs = {path.name for path in (exported / "data" / "legs" / space).iterdir()}
        assert legs == {f"{i}-{j}.json" for i in range(n) for j in range(i + 1, n)}


@pytest.mark.parametrize("name", ["anchored", "paper"])
def test_at_any_point_a_simplex_has_the_weights(few: Library, exported: Path, name: str) -> None:
    """The law of the charts that the page multiplies with: they give what the space gives."""
    space = make_space(name, few, blend="linear")
    charts = json.loads((exported / "data" / "charts" / f"{name}.json").read_text())["charts"]
    rng = np.random.default_rng(1)
    for weights in rng.dirichlet(np.ones(len(few)), size=20):
        point = weights @ space.points
        recipe = space.at(point, clamp=True).recipe
        parts = np.split(point, len(charts))
        for c, (chart, part) in enumerate(zip(charts, parts, strict=True)):
            barycentric = np.array(chart["barycentric"]) @ np.append(part, 1.0)
            simplex = int(barycentric.min(axis=1).argmax())
            dense = np.zeros(len(few))
            dense[chart["simplices"][simplex]] = barycentric[simplex]
            own = dict(zip(recipe.names, recipe.weights[c], strict=True))
            assert_allclose(dense, [own.get(material, 0.0) for material in few.names], atol=1e-9)


def test_a_space_without_points_has_no_charts(exported: Path) -> None:
    assert {path.stem for path in (exported / "data" / "charts").iterdir()} == {"anchored", "paper"}


def test_a_folder_of_other_files_is_refused_and_left_alone(
    small_library: Library, tmp_path: Path
) -> None:
    (tmp_path / "thesis.tex").write_text("years")
    with pytest.raises(OutputError, match=r"holds files that `halfway view` did not write"):
        export(small_library, tmp_path, PAGE)
    assert contents(tmp_path) == {"thesis.tex": b"years"}


def test_an_export_that_fails_leaves_the_earlier_one(exported: Path) -> None:
    class Broken(ProceduralLibrary):
        def brdf(self, name: str) -> None:  # pyright: ignore
            raise LibraryError(f"{name} is gone.")

    before = contents(exported)
    grid = Grid.merl(6, 5, 8)
    with pytest.raises(LibraryError, match="is gone"):
        export(Broken("broken", random_tables(9, grid), grid=grid), exported, PAGE)
    assert contents(exported) == before
    assert [path.name for path in exported.parent.iterdir()] == ["site"]


def test_too_many_materials_are_refused(tmp_path: Path) -> None:
    grid = Grid.merl(2, 2, 2)
    library = ProceduralLibrary("large", random_tables(N_LARGEST + 1, grid), grid=grid)
    with pytest.raises(OutputError, match=r"large has 41 materials: a folder takes at most 40\."):
        export(library, tmp_path / "site", PAGE)


def test_a_subset_is_a_library_of_its_own_whose_recipes_are_the_wholes(
    small_library: Library,
) -> None:
    subset = Subset(small_library, ["material-7", "material-2", "material-2"])
    assert (subset.names, subset.name) == (("material-2", "material-7"), small_library.name)
    assert subset.checksum != small_library.checksum
    assert subset.origin.description.startswith("2 of 9 materials")
    assert_array_equal(subset.row(1), small_library.row(7))
    block = subset.blocks()[0]
    assert_array_equal(subset.columns(block)[:, 0], small_library.row(2)[:, block])


def test_a_subset_of_one_makes_no_space(small_library: Library) -> None:
    with pytest.raises(LibraryError, match="1 material of small makes no space: name at least two"):
        Subset(small_library, ["material-7"])


def test_the_most_different_materials_are_far_apart() -> None:
    grid = Grid.merl(6, 5, 8)
    tables = random_tables(1, grid)
    (table,) = tables.values()
    shades = {"black": 0.01, "grey": 0.4, "gray": 0.41, "white": 1.0}
    brdfs = {
        name: type(table)(np.full((3, *grid.shape), shade / np.pi, np.float32), grid)
        for name, shade in shades.items()
    }
    images = Looks.fit(ProceduralLibrary("shades", brdfs, grid=grid))
    assert most_different(images, 2) == ["black", "white"]
    assert most_different(images, 3) in (["black", "grey", "white"], ["black", "gray", "white"])
    with pytest.raises(LibraryError, match=r"5 materials cannot be chosen: expected 2 to 4"):
        most_different(images, 5)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-n", "3"], "-n says what is exported, and nothing is: add --export DIR"),
        (["--materials", "chrome"], "--materials says what is exported, and nothing is"),
        (
            ["--export", "x", "-n", "3", "--materials", "chrome"],
            "--materials and -n both say what is exported",
        ),
        (["--export", "x", "--materials", "chrom,teflon"], "did you mean chrome"),
    ],
)
def test_what_cannot_be_exported_is_said(words: list[str], message: str) -> None:
    result = CliRunner().invoke(app, ["view", *words])
    assert isinstance(result.exception, HalfwayError)
    assert message in str(result.exception)


def test_tables_that_depend_on_phi_h_are_written_whole(tmp_path: Path) -> None:
    grid = Grid.anisotropic(6, 4, 3, 4, period=np.pi)
    brushed = ProceduralLibrary("brushed", random_tables(4, grid), grid=grid)
    export(brushed, tmp_path / "site", PAGE)
    folder = json.loads((tmp_path / "site/data/explorer.json").read_text())
    assert [axis["size"] for axis in folder["library"]["grid"]] == [6, 4, 3, 4]
    assert folder["tables"][0]["shape"] == [6, 4, 3, 4, 4]
    assert folder["library"]["notice"] == ""
    packed = (tmp_path / "site/data/tables/0.bin").read_bytes()
    assert gzip.decompress(packed) == Block.of_table(brushed.brdf(brushed.names[0])).body
