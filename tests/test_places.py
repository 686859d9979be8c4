"""Places: what a path does, a URL does; against a real S3 server on this machine, over HTTP."""

import json
import pickle
import sys

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from strategies import TINY, random_tables

from halfway import Pca, Recipe, Route, build_library, mix, open_library
from halfway.batch import verify
from halfway.cli import main as halfway
from halfway.components import compact_library
from halfway.errors import LibraryError, MissingExtraError, OutputError, RemoteError
from halfway.export import write_route
from halfway.files import replacing
from halfway.formats import write_merl
from halfway.locations import RemotePath, append_text, name_in, read_into, to_location
from halfway.space import LinearSpace

# botocore 1.43 and moto 5.2 call what Python 3.12 and newer deprecate.
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")


@pytest.fixture(scope="module")
def bucket():
    """A bucket of an S3 server of its own, as a place."""
    import s3fs
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AWS_ENDPOINT_URL", f"http://{host}:{port}")
        patch.setenv("AWS_ACCESS_KEY_ID", "somebody")
        patch.setenv("AWS_SECRET_ACCESS_KEY", "secret")
        patch.setenv("AWS_DEFAULT_REGION", "us-east-1")
        s3fs.S3FileSystem().mkdir("bucket")
        yield RemotePath("s3://bucket")
    server.stop()


@pytest.fixture
def folder(tmp_path):
    for name, table in random_tables(5, TINY).items():
        write_merl(tmp_path / "measured" / f"{name}.binary", table)
    return tmp_path / "measured"


def names(place):
    return sorted(name_in(place, there) for there in place.rglob("*"))


def test_a_url_is_remote_and_anything_else_a_path(tmp_path):
    assert to_location("s3://bucket/x.brdflib/") == RemotePath("s3://bucket/x.brdflib")
    assert to_location(f"file://{tmp_path}") == to_location(str(tmp_path)) == tmp_path


def test_the_parts_of_a_url_are_those_of_a_path():
    place = RemotePath("s3://bucket/folder") / "x.tar.gz"
    assert (place.name, place.stem, place.suffix) == ("x.tar.gz", "x.tar", ".gz")
    assert (str(place.parent), str(place.with_suffix(".json"))) == (
        "s3://bucket/folder",
        "s3://bucket/folder/x.tar.json",
    )
    assert name_in(place.parent, place) == "x.tar.gz"


@pytest.mark.parametrize("kind", ["local", "remote"])
def test_a_file_is_written_whole_read_in_ranges_appended_to_and_removed(kind, bucket, tmp_path):
    place = (bucket / "plain" if kind == "remote" else tmp_path) / "digits.txt"
    assert not place.exists()
    with pytest.raises(ZeroDivisionError), replacing(place) as temporary:  # noqa: PT012
        temporary.write_text("half")
        raise ZeroDivisionError
    assert not place.exists()
    with replacing(place) as temporary:
        temporary.write_text("0123456789")
    assert (place.is_file(), place.stat().st_size, place.read_text()) == (True, 10, "0123456789")
    first, second = bytearray(3), bytearray(2)
    read_into(place, [2, 8], [memoryview(first), memoryview(second)])
    assert (first, second) == (b"234", b"89")
    with pytest.raises(OSError, match=r"digits\.txt ended 1 bytes early"):
        read_into(place, [8], [memoryview(bytearray(3))])
    append_text(place, "!")
    with place.open("rb") as stream:
        assert stream.read() == b"0123456789!"
    assert names(place.parent) == ["digits.txt"]
    place.unlink()
    place.unlink(missing_ok=True)
    with pytest.raises(FileNotFoundError):
        place.read_text()


def test_a_remote_library_is_the_local_one(bucket, folder, tmp_path):
    here = build_library([folder], tmp_path / "x.brdflib").library
    there = build_library([folder], bucket / "x.brdflib").library
    again = open_library("s3://bucket/x.brdflib")
    assert here.checksum == there.checksum == again.checksum
    assert again.name == "s3://bucket/x.brdflib"
    assert_array_equal(Pca.fit(here).eigenvectors, Pca.fit(again).eigenvectors)
    weights = {"material-1": 0.25, "material-4": 0.75}
    mixes = [mix(lib, Recipe.of(lib.name, weights)).values for lib in (here, again)]
    assert_array_equal(*mixes)
    assert there.verify().ok
    assert [p.name for p in tmp_path.glob(".*")] == []


def test_a_remote_compact_library_is_the_local_one(bucket, folder, tmp_path):
    library = build_library([folder], tmp_path / "x.brdflib").library
    here = compact_library(library, tmp_path / "x.brdfc", n_components=3)
    there = compact_library(library, bucket / "x.brdfc", n_components=3)
    again = pickle.loads(pickle.dumps(open_library("s3://bucket/x.brdfc")))
    assert (again.name, again.n_bytes) == ("s3://bucket/x.brdfc", here.n_bytes)
    assert again.facts()["compact"] == there.facts()["compact"] == here.facts()["compact"]
    assert_array_equal(again.row(2), here.row(2))
    with pytest.raises(
        LibraryError, match=r"s3://bucket/none\.brdfc .*compact\.json cannot be read"
    ):
        open_library("s3://bucket/none.brdfc")


def test_a_remote_library_is_replaced_and_its_old_tables_go(bucket, folder):
    place = bucket / "again.brdflib"
    first = build_library([folder], place).library
    (folder / "material-0.binary").unlink()
    second = build_library([folder], place).library
    assert names(place) == sorted(["library.json", second.tables.name])
    with pytest.raises(LibraryError, match="is gone: it was there when the library was opened"):
        first.row(0)
    assert len(open_library(str(place))) == 4


def test_a_remote_build_that_stops_leaves_the_old_library(bucket, folder, monkeypatch):
    place = bucket / "stopped.brdflib"
    first = build_library([folder], place).library
    (folder / "material-0.binary").unlink()
    put = RemotePath.put

    def put_tables_only(self, file):
        if self.name == "library.json":
            raise KeyboardInterrupt
        put(self, file)

    with monkeypatch.context() as patch:
        patch.setattr(RemotePath, "put", put_tables_only)
        with pytest.raises(KeyboardInterrupt):
            build_library([folder], place)
    assert_array_equal(open_library(str(place)).row(0), first.row(0))


def test_a_remote_route_is_resumed_and_verified(bucket, folder, tmp_path):
    library = build_library([folder], tmp_path / "x.brdflib").library
    route = Route.through(LinearSpace.of(library), library.names[:2])
    place, ts = bucket / "route", np.linspace(0, 1, 4).tolist()
    assert write_route(place, route, ts, library, format="merl") == (4, 0)
    (place / "001.binary").unlink()
    assert write_route(place, route, ts, library, format="merl") == (1, 3)
    assert verify(place).n_right == 5
    write_route(tmp_path / "route", route, ts, library, format="merl")
    for name in names(tmp_path / "route"):
        assert (place / name).read_bytes() == (tmp_path / "route" / name).read_bytes()


def test_the_command_line_takes_urls(bucket, folder, monkeypatch, capsys):  # noqa: ARG001
    def run(*words):
        monkeypatch.setattr(sys, "argv", ["halfway", *words])
        with pytest.raises(SystemExit) as stop:
            halfway()
        assert not stop.value.code
        return capsys.readouterr().out

    monkeypatch.chdir(folder.parent)
    run("library", "build", "measured", "-o", "s3://bucket/cli.brdflib")
    facts = json.loads(run("library", "info", "s3://bucket/cli.brdflib", "--json"))
    assert (facts["library"], len(facts["materials"])) == ("s3://bucket/cli.brdflib", 5)
    words = ("material-0", "material-1", "-n", "3", "--space", "linear", "--pace", "uniform")
    run("route", "s3://bucket/cli.brdflib", *words, "-o", "s3://bucket/cli-route")
    assert json.loads(run("verify", "s3://bucket/cli-route", "--json"))["ok"]
    document = json.loads((RemotePath("s3://bucket/cli-route") / "recipes.json").read_text())
    assert len(document["recipes"]) == 3
    run("mix", "s3://bucket/cli.brdflib", "material-0=0.5, material-1=0.5", "-o", "a.binary")
    run("convert", "s3://bucket/cli.brdflib:material-3", "b.binary")
    assert (folder.parent / "b.binary").read_bytes() == (folder / "material-3.binary").read_bytes()


def test_what_is_not_there_is_one_line(bucket):
    with pytest.raises(LibraryError, match=r"s3://bucket/nothing is no library: there is no"):
        open_library(str(bucket / "nothing"))
    with (
        pytest.raises(OutputError, match=r"s3://nobody/x cannot be written: The specified bucket"),
        replacing(RemotePath("s3://nobody/x")) as temporary,
    ):
        temporary.write_text("")


def test_storage_that_does_not_answer_is_one_line(bucket, monkeypatch):  # noqa: ARG001
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://127.0.0.1:1")
    monkeypatch.setenv("AWS_MAX_ATTEMPTS", "1")
    import s3fs

    s3fs.S3FileSystem.clear_instance_cache()
    with pytest.raises(RemoteError, match=r"cannot be reached \(Could not connect to the endpoint"):
        RemotePath("s3://bucket/x").exists()
    s3fs.S3FileSystem.clear_instance_cache()


@pytest.mark.parametrize(
    ("url", "error", "message"),
    [
        ("s4://bucket/x", RemoteError, r"begins with no storage that is known"),
        ("gs://bucket/x", MissingExtraError, "needs the package gcsfs.*`pip install gcsfs`"),
        ("abfs://bucket/x", RemoteError, r"abfs://bucket/x needs a package of its own: "),
    ],
)
def test_other_storage_is_one_line(monkeypatch, url, error, message):
    for package in ("gcsfs", "adlfs"):
        monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(error, match=message):
        RemotePath(url).exists()


def test_without_the_package_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    with pytest.raises(MissingExtraError, match="pip install fsspec"):
        RemotePath("s3://bucket/x").exists()
