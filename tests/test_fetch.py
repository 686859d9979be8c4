"""Data sets: what is known of them, and fetching them whole."""

import hashlib

import pytest
from faulty_server import BODY, MD5, NAME, good, serving
from written_files import zipped

from halfway.errors import FetchError
from halfway.fetch import catalogue, dataset, fetch, rgl_names
from halfway.fetch.catalogue import TENSOR_FILE, Dataset, Download


def test_the_known_data_sets_say_what_they_are():
    for name in ("nbrdf-merl", "merl", "rgl:acrylic_felt_green", "rgl:all"):
        found = dataset(name)
        assert found.licence
        assert found.source
        assert all(item.url.startswith("https://") for item in found.downloads)
    assert len(rgl_names()) == 62
    assert len(dataset("rgl:all").downloads) == 62


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("mrl", "mrl is no data set: expected nbrdf-merl, merl, rgl:NAME or rgl:all."),
        ("rgl:felt_green", "none of the 62 materials .* perhaps acrylic_felt_green"),
        ("rgl:", "''? is none of|none of the 62"),
    ],
)
def test_an_unknown_name_is_said(name, message):
    with pytest.raises(FetchError, match=message):
        dataset(name)


def test_the_licence_is_recorded_beside_the_files(tmp_path, monkeypatch):
    item = Download(NAME, "https://nowhere.invalid/clay", TENSOR_FILE, len(BODY), MD5)
    clay = Dataset("clay", "Clay", "CC0 1.0", "A. Potter, 2020", (item,))
    monkeypatch.setitem(catalogue._DATASETS, "clay", clay)
    seen = []
    with serving(good) as server:
        fetched = fetch("clay", tmp_path, base_url=server.url, progress=lambda *a: seen.append(a))
    assert fetched.files == (tmp_path / NAME,)
    assert "CC0 1.0" in fetched.licence.read_text()
    assert "A. Potter, 2020" in fetched.licence.read_text()
    assert seen[-1] == (NAME, len(BODY), len(BODY))


def test_a_zip_is_unpacked(tmp_path, monkeypatch):
    packed = zipped({"brdfs/a.binary": b"a" * 50, "brdfs/b.binary": b"b"})
    item = Download("all.zip", "", catalogue.ZIP, len(packed), hashlib.md5(packed).hexdigest())
    monkeypatch.setitem(
        catalogue._DATASETS, "all", Dataset("all", "", "", "", (item,), unpack=True)
    )
    with serving(lambda handler: good(handler, body=packed)) as server:
        fetched = fetch("all", tmp_path, base_url=server.url)
    assert [p.relative_to(tmp_path).as_posix() for p in fetched.unpacked] == [
        "brdfs/a.binary",
        "brdfs/b.binary",
    ]
    assert (tmp_path / "brdfs" / "a.binary").read_bytes() == b"a" * 50
