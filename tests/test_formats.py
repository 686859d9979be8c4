"""Finding BRDFs: by content, in order, with a reason for everything that is left out."""

import hashlib
import os
import zipfile

import numpy as np
import pytest
from written_files import MERL_SHAPE, keras, merl, nbrdf_layers

from halfway import TabularBrdf
from halfway.errors import FormatError, LibraryError
from halfway.formats import NeuralBrdf, Skipped, find_brdfs, read_brdf
from halfway.halfdiff import Grid
from halfway.models import builtin

GRID = Grid.merl(*MERL_SHAPE)


@pytest.fixture
def folder(tmp_path):
    """A download as people have it: materials, licences, leftovers."""
    files = {
        "silver.h5": keras(nbrdf_layers()),
        "brdfs/gold.binary": merl(np.full(72, 1500.0)),
        "brdfs/bronze.dat": merl(np.full(72, 3000.0)),
        "brdfs/README.txt": ("R" + 600 * "é").encode(),
        "brdfs/.hidden.binary": merl(np.full(72, 1.0)),
        "brdfs/cut.binary": merl(np.full(72, 1.0))[:92],
        "empty.binary": b"",
        "table.npy": b"\x93NUMPY" + bytes(100),
        "noise.bin": bytes(range(128, 256)),
    }
    for name, data in files.items():
        path = tmp_path / "data" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return tmp_path / "data"


@pytest.fixture
def archive(folder):
    path = folder.parent / "all.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as opened:
        for file in folder.rglob("*"):
            opened.write(file, file.relative_to(folder))
    return path


REASONS = {
    "README.txt": "is text",
    ".hidden.binary": "is hidden",
    "cut.binary": "is 496 bytes shorter than its header says",
    "empty.binary": "is empty",
    "table.npy": "is a NumPy array",
    "noise.bin": "is of no known format",
}


def reasons(skipped: list[Skipped]) -> dict[str, str]:
    return {item.path.replace(":", "/").rpartition("/")[2]: item.reason for item in skipped}


@pytest.mark.parametrize("source", ["folder", "archive"])
class TestMany:
    def test_what_is_a_brdf_is_found_whatever_its_suffix(self, request, source):
        found, _ = find_brdfs([request.getfixturevalue(source)])
        assert [item.name for item in found] == ["bronze", "gold", "silver"]
        assert [item.grid for item in found] == [GRID, GRID, None]

    def test_what_is_none_is_skipped_with_its_reason(self, request, source):
        _, skipped = find_brdfs([request.getfixturevalue(source)])
        assert reasons(skipped) == REASONS

    def test_what_is_found_loads(self, request, source):
        bronze, _, silver = (
            item.load() for item in find_brdfs([request.getfixturevalue(source)])[0]
        )
        assert isinstance(bronze, TabularBrdf)
        assert bronze.name == "bronze"
        assert np.allclose(bronze.values[0], 2, rtol=1e-7)
        assert isinstance(silver, NeuralBrdf)

    def test_checksums_are_those_of_the_bytes(self, request, source):
        gold = find_brdfs([request.getfixturevalue(source)])[0][1]
        assert gold.sha256 == hashlib.sha256(merl(np.full(72, 1500.0))).hexdigest()


def test_sources_say_where_a_material_is(folder, archive):
    assert find_brdfs([folder])[0][1].source == str(folder / "brdfs" / "gold.binary")
    assert find_brdfs([archive])[0][1].source == f"{archive}:brdfs/gold.binary"


def test_sources_keep_their_order_and_may_be_single_files_and_built_in_sets(folder):
    found, skipped = find_brdfs(
        [folder / "silver.h5", str(folder / "brdfs/gold.binary"), "builtin:merl-abc"]
    )
    assert [item.name for item in found[:3]] == [
        "silver",
        "gold",
        *list(builtin("merl-abc").models)[:1],
    ]
    assert (len(found), skipped) == (102, [])
    assert "not measurements" in found[2].origin.description
    assert found[2].load() is builtin("merl-abc").models["alum-bronze"]
    assert found[2].sha256 != found[3].sha256


def test_materials_are_sorted_by_name_not_by_file_name(tmp_path):
    for name in ("red-paint-2", "red-paint", "red-paint2"):  # "-" sorts before the "." of a suffix
        (tmp_path / f"{name}.binary").write_bytes(merl())
    found, _ = find_brdfs([tmp_path])
    assert [item.name for item in found] == ["red-paint", "red-paint-2", "red-paint2"]


def test_two_materials_of_one_name_are_an_error(folder, archive):
    with pytest.raises(FormatError) as error:
        find_brdfs([folder, archive])
    assert str(error.value) == (
        f"bronze is there twice, as {folder / 'brdfs/bronze.dat'} and {archive}:brdfs/bronze.dat: "
        "each material needs a name of its own. Rename one, or leave one out."
    )


def test_a_single_file_that_is_no_brdf_is_an_error_not_skipped(folder):
    with pytest.raises(FormatError) as error:
        find_brdfs([folder / "brdfs/README.txt"])
    assert str(error.value) == (
        "README.txt is text: expected a MERL table, a neural BRDF (.h5), an RGL material (.bsdf), "
        "a UTIA (.bin) or MIT CSAIL table, or a Zarr store."
    )


def test_what_is_damaged_is_told_from_what_is_something_else(folder, archive):
    for source in (folder, archive):
        _, skipped = find_brdfs([source])
        assert [item.reason for item in skipped if item.damaged] == [REASONS["cut.binary"]]


def test_a_source_that_is_skipped_counts_as_damaged(folder, archive):
    archive.write_bytes(archive.read_bytes()[:2000])
    text = folder / "brdfs/README.txt"
    found, skipped = find_brdfs([text, archive, folder / "silver.h5"], skip_damaged=True)
    assert [item.name for item in found] == ["silver"]
    assert skipped[0] == Skipped(str(text), "is text", damaged=True)
    assert skipped[1].reason.startswith("is a damaged zip (")
    assert skipped[1].damaged


def test_a_source_that_is_not_there_is_an_error(tmp_path):
    with pytest.raises(FormatError, match="does not exist"):
        find_brdfs([tmp_path / "nowhere"])
    with pytest.raises(LibraryError, match="merl-abc, merl-sgd"):
        find_brdfs(["builtin:nothing"])


def test_one_file_is_read_by_its_content(folder):
    assert isinstance(read_brdf(folder / "brdfs/bronze.dat"), TabularBrdf)
    assert isinstance(read_brdf(str(folder / "silver.h5")), NeuralBrdf)
    with pytest.raises(FormatError, match=r"cut\.binary is 496 bytes shorter"):
        read_brdf(folder / "brdfs/cut.binary")


def test_a_zip_is_not_one_brdf(archive):
    with pytest.raises(FormatError, match=r"all\.zip is a zip"):
        read_brdf(archive)


def test_a_pipe_in_a_folder_is_not_waited_for(folder):
    os.mkfifo(folder / "pipe.binary")
    assert reasons(find_brdfs([folder])[1])["pipe.binary"] == "is no ordinary file"


def test_a_folder_is_looked_through_without_reading_the_samples(folder):
    with (folder / "large.binary").open("wb") as file:
        file.write(merl(sizes=(3000, 3000, 3000))[:12])
        file.truncate(12 + 24 * 3000**3)  # 648 GB, on paper
    found, _ = find_brdfs([folder])
    assert found[-2].name == "large"


def test_a_bomb_in_a_zip_is_not_unpacked(tmp_path):
    path = tmp_path / "bomb.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("gold.h5", keras(nbrdf_layers()))
        archive.writestr("large.h5", keras(nbrdf_layers()) + bytes(2_000_000))
        archive.writestr("nested.zip", path.read_bytes())
    found, skipped = find_brdfs([path])
    assert [item.name for item in found] == ["gold"]
    large = len(keras(nbrdf_layers())) + 2_000_000
    assert reasons(skipped) == {
        "large.h5": f"is an HDF5 file of {large:,} bytes",
        "nested.zip": "is a zip",
    }


def test_a_damaged_zip_is_one_line(archive):
    whole = archive.read_bytes()
    archive.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FormatError, match=r"^all\.zip is a damaged zip \(.*\): compare"):
        find_brdfs([archive])


def test_a_damaged_member_is_one_line_when_it_is_found_or_loaded(tmp_path):
    path = tmp_path / "all.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("gold.binary", merl(np.ones(3000), (10, 10, 10)))
        archive.writestr("silver.h5", keras(nbrdf_layers()))
    data = bytearray(path.read_bytes())
    # A sample of each: the headers are right, the checksums of the members are not.
    data[20_000] ^= 255
    data[30_000] ^= 255
    path.write_bytes(data)
    (silver,), (gold,) = find_brdfs([path])
    assert gold.reason.startswith("cannot be read (Bad CRC-32")
    with pytest.raises(
        FormatError, match=r"^silver\.h5 cannot be read \(Bad CRC-32.*\): see .*all\.zip:silver"
    ):
        silver.load()


def test_names_are_one_line_of_text_whatever_the_files_are_called(tmp_path):
    for name in ("two\nlines", "\x1b[31mred", "scan 12:30", "b\u202ea"):
        (tmp_path / f"{name}.binary").write_bytes(merl())
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        archive.writestr("a\rb.binary", merl())
    found, _ = find_brdfs([tmp_path, tmp_path / "all.zip"])
    names = [r"\x1b[31mred", r"b\u202ea", "scan 12:30", r"two\nlines", r"a\rb"]
    assert [item.name for item in found] == names
    (tmp_path / "two\nlines.h5").write_text("no network")
    with pytest.raises(FormatError, match=r"^two\\nlines\.h5 is text"):
        read_brdf(tmp_path / "two\nlines.h5")
