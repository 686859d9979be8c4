"""Zips that came over the network: nothing in them is trusted."""

import stat
import zipfile

import pytest
from written_files import zipped

from halfway.errors import FetchError
from halfway.fetch.unpack import unpack
from halfway.formats import find_brdfs


@pytest.mark.parametrize(
    "name", ["../out", "/etc/out", "a/../../out", "C:\\out", "..\\out", "C:out"]
)
def test_no_member_leaves_the_folder(tmp_path, name):
    (tmp_path / "x.zip").write_bytes(zipped({"fine": b"1", name: b"2"}))
    with pytest.raises(FetchError, match="leads out of the folder"):
        unpack(tmp_path / "x.zip", tmp_path / "in" / "side")
    assert [p.name for p in tmp_path.rglob("*")] == ["x.zip"]


@pytest.mark.parametrize("name", ["a\x1b[2J", "a\nb", "a" * 201])
def test_a_name_that_is_none_is_refused(tmp_path, name):
    (tmp_path / "x.zip").write_bytes(zipped({name: b"1"}))
    with pytest.raises(FetchError, match="expected a path of at most 200 printable ones") as said:
        unpack(tmp_path / "x.zip", tmp_path / "in")
    assert str(said.value).isprintable()


def test_no_link_is_made(tmp_path):
    link = zipfile.ZipInfo("link")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        archive.writestr(link, "/etc/passwd")
    with pytest.raises(FetchError, match="has a link in it, 'link'"):
        unpack(tmp_path / "x.zip", tmp_path)


def test_a_bomb_is_refused_before_a_byte_is_written(tmp_path):
    (tmp_path / "x.zip").write_bytes(zipped({"bomb": bytes(3_000_000)}))
    with pytest.raises(FetchError, match=r"would unpack to 3,000,000 bytes from"):
        unpack(tmp_path / "x.zip", tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["x.zip"]


def test_a_member_that_lies_about_its_size_is_refused(tmp_path):
    packed = zipped({"liar": bytes(range(256)) * 40})
    # The size before packing, in the local header and in the directory.
    packed = packed.replace((10_240).to_bytes(4, "little"), (100).to_bytes(4, "little"))
    (tmp_path / "x.zip").write_bytes(packed)
    with pytest.raises(FetchError, match="is a damaged zip"):
        unpack(tmp_path / "x.zip", tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["x.zip"]


def longer_than_the_zip(packed):
    """The first member claims 4 GB in the zip, in the directory, which is what `zipfile` believes."""
    directory = packed.index(b"PK\1\2")
    return packed[: directory + 20] + (2**32 - 2).to_bytes(4, "little") + packed[directory + 24 :]


def test_a_member_that_claims_more_than_the_zip_has_takes_no_memory(tmp_path):
    (tmp_path / "x.zip").write_bytes(longer_than_the_zip(zipped({"a.h5": bytes(range(256))})))
    with pytest.raises(FetchError, match="claims to be longer than the zip"):
        unpack(tmp_path / "x.zip", tmp_path / "in")
    found, skipped = find_brdfs([tmp_path / "x.zip"])
    assert not found
    assert "claims to be longer than the zip" in skipped[0].reason


def test_a_bomb_is_not_read(tmp_path, monkeypatch):
    monkeypatch.setattr("halfway.formats.find.LARGEST_MEMBER", 100_000)
    (tmp_path / "x.zip").write_bytes(zipped({"bomb.bsdf": bytes(3_000_000)}))
    _, skipped = find_brdfs([tmp_path / "x.zip"])
    assert skipped[0].reason == "unpacks to 3,000,000 bytes"


def test_a_members_name_cannot_steer_a_terminal(tmp_path):
    (tmp_path / "x.zip").write_bytes(zipped({"\x1b[2J\nclay.binary": b"no"}))
    _, skipped = find_brdfs([tmp_path / "x.zip"])
    assert skipped[0].path.endswith("x.zip:\\x1b[2J\\nclay.binary")


@pytest.mark.parametrize("keep", [10, 60, -30])
def test_a_damaged_zip_is_refused(tmp_path, keep):
    (tmp_path / "x.zip").write_bytes(zipped({"a": bytes(range(256))})[:keep])
    with pytest.raises(FetchError, match="is a damaged zip"):
        unpack(tmp_path / "x.zip", tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["x.zip"]


def test_a_member_without_a_name_is_refused(tmp_path):
    packed = bytearray(zipped({"a": b"1"}))
    directory = packed.index(b"PK\1\2")
    # The name's length, in the directory; the name becomes the first byte of the extra field.
    packed[directory + 28 : directory + 30] = b"\0\0"
    packed[directory + 32 : directory + 34] = b"\1\0"
    (tmp_path / "x.zip").write_bytes(bytes(packed))
    with pytest.raises(FetchError, match=r"leads out of the folder|is a damaged zip"):
        unpack(tmp_path / "x.zip", tmp_path / "in")
