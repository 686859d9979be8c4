"""Fetching from a real server on loopback that does everything wrong, one thing at a time."""

import hashlib
import io
import stat
import threading
import time
import zipfile
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import httpx
import pytest

from halfway.errors import FetchError, OutputError
from halfway.fetch import catalogue, dataset, fetch, rgl_names
from halfway.fetch.catalogue import TENSOR_FILE, Dataset, Download
from halfway.fetch.download import download
from halfway.fetch.unpack import unpack

BODY = TENSOR_FILE + bytes(range(256)) * 400
N_BYTES = len(BODY)
NAME = "clay.bsdf"
MD5 = hashlib.md5(BODY).hexdigest()


class Server(ThreadingHTTPServer):
    """Answers each request with the next of ``answers``, the last one for ever."""

    daemon_threads = True

    def __init__(self, answers):
        super().__init__(("127.0.0.1", 0), Handler)
        self.answers = list(answers)
        self.requests = []

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_port}"


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_GET(self):
        server = self.server
        server.requests.append(dict(self.headers))
        answer = server.answers.pop(0) if len(server.answers) > 1 else server.answers[0]
        self.close_connection = True
        answer(self)

    def log_message(self, *_):
        pass

    def begin(self, code, headers=()):
        self.send_response(code)
        for name, value in dict(headers).items():
            self.send_header(name, str(value))
        self.send_header("Connection", "close")
        self.end_headers()


# What the server does


def good(handler, *, body=BODY, etag='"v1"'):
    """Byte ranges, as a server should."""
    asked = handler.headers.get("Range")
    if asked and handler.headers.get("If-Range", etag) == etag:
        start = int(asked.removeprefix("bytes=").removesuffix("-"))
        if start >= len(body):
            return handler.begin(416, {"Content-Length": 0})
        handler.begin(206, {
            "Content-Length": len(body) - start,
            "Content-Range": f"bytes {start}-{len(body) - 1}/{len(body)}",
            "ETag": etag,
        })  # fmt: skip
        return handler.wfile.write(body[start:])
    handler.begin(200, {"Content-Length": len(body), "ETag": etag})
    return handler.wfile.write(body)


def cut(n, etag='"v1"'):
    def answer(handler):
        handler.begin(200, {"Content-Length": len(BODY), "ETag": etag})
        handler.wfile.write(BODY[:n])

    return answer


def cut_and_resume(handler):
    """Sends some more each time, and then hangs up."""
    start = int(handler.headers.get("Range", "bytes=0-").removeprefix("bytes=").removesuffix("-"))
    if not start:
        return cut(30_000)(handler)
    handler.begin(206, {"Content-Length": len(BODY) - start, "Content-Range": f"bytes {start}-{len(BODY) - 1}/{len(BODY)}"})  # fmt: skip
    return handler.wfile.write(BODY[start : start + 30_000])


def status(code, headers=()):
    return lambda handler: handler.begin(code, {"Content-Length": 0, **dict(headers)})


def body(content, headers=()):
    def answer(handler):
        handler.begin(200, {"Content-Length": len(content), **dict(headers)})
        handler.wfile.write(content)

    return answer


def without_length(content):
    def answer(handler):
        handler.begin(200)
        handler.wfile.write(content)

    return answer


def stall(handler):
    handler.begin(200, {"Content-Length": len(BODY)})
    handler.wfile.write(BODY[:100])
    handler.wfile.flush()
    time.sleep(0.6)


def trickle(handler):
    handler.begin(200, {"Content-Length": len(BODY)})
    for i in range(12):
        handler.wfile.write(BODY[i : i + 1])
        handler.wfile.flush()
        time.sleep(0.05)


def hang_up(handler):
    handler.connection.close()


def ignores_ranges(handler):
    handler.begin(200, {"Content-Length": len(BODY)})
    handler.wfile.write(BODY)


def wrong_range(handler):
    handler.begin(206, {"Content-Length": 10, "Content-Range": f"bytes 5-14/{len(BODY)}"})
    handler.wfile.write(BODY[5:15])


@contextmanager
def serving(*answers):
    server = Server(answers)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        server.server_close()


def get(server, folder, *, n_bytes=N_BYTES, md5=MD5, url=None, n_tries=3, timeout=0.3):
    item = Download(NAME, url or f"{server.url}/{NAME}", TENSOR_FILE, n_bytes, md5)
    with httpx.Client(follow_redirects=True, max_redirects=5, timeout=timeout) as client:
        return download(
            item, folder, client, progress=lambda *_: None, timeout=timeout, n_tries=n_tries, pause=0.001
        )  # fmt: skip


# What still works


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize(
    "answers",
    [
        pytest.param([good], id="a good server"),
        pytest.param([cut(40_000), good], id="cut once"),
        pytest.param([cut(0), good], id="cut before the first byte"),
        pytest.param([cut(70_000), ignores_ranges], id="does not resume"),
        pytest.param([cut(70_000), wrong_range, good], id="resumes elsewhere"),
        pytest.param([cut(70_000, '"v0"'), good], id="another version after the cut"),
        pytest.param([hang_up, good], id="hangs up"),
        pytest.param([stall, good], id="stalls"),
        pytest.param([trickle, good], id="trickles"),
        pytest.param([status(503), status(429), good], id="is busy"),
        pytest.param([status(302, {"Location": "/elsewhere"}), good], id="redirects"),
        pytest.param([without_length(BODY)], id="does not say how long"),
    ],
)
def test_what_can_be_mended_is_mended(tmp_path, answers, known):
    with serving(*answers) as server:
        path = get(server, tmp_path, **({} if known else {"n_bytes": None, "md5": ""}))
    assert path.read_bytes() == BODY
    assert [p.name for p in tmp_path.iterdir()] == [NAME]


def test_a_cut_file_goes_on_where_it_stopped(tmp_path):
    with serving(cut(40_000), good) as server:
        get(server, tmp_path)
        assert server.requests[1]["Range"] == "bytes=40000-"
        assert server.requests[1]["If-Range"] == '"v1"'


def test_a_later_run_goes_on_where_the_last_one_stopped(tmp_path):
    with serving(cut_and_resume) as server:
        with pytest.raises(FetchError, match=r"The 30,000 bytes that came are kept"):
            get(server, tmp_path, n_tries=1)
        with pytest.raises(FetchError, match=r"The 60,000 bytes that came are kept"):
            get(server, tmp_path, n_tries=1)
        assert not (tmp_path / NAME).exists()
        assert get(server, tmp_path, n_tries=3).read_bytes() == BODY


def test_what_is_there_and_right_is_not_fetched_again(tmp_path):
    (tmp_path / NAME).write_bytes(BODY)
    with serving(status(500)) as server:
        get(server, tmp_path)
        assert server.requests == []


def test_what_is_there_and_wrong_is_replaced(tmp_path):
    (tmp_path / NAME).write_bytes(b"old")
    with serving(good) as server:
        assert get(server, tmp_path).read_bytes() == BODY


# What fails, in one line, with nothing wrong on disk


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        pytest.param(
            status(404), r"it answers 404 Not Found\. See whether http://127", id="not there"
        ),
        pytest.param(status(403), "it answers 403", id="forbidden"),
        pytest.param(status(500), "answers 500 Internal Server Error", id="broken"),
        pytest.param(status(302, {"Location": "/x"}), "redirects in a circle", id="a circle"),
        pytest.param(
            status(302, {"Location": "ftp://x/y"}), "leads to an address that is none", id="to ftp"
        ),
        pytest.param(body(BODY[:-1] + b"x"), "has the MD5 checksum", id="one wrong byte"),
        pytest.param(body(b"<html>" + BODY[6:]), "perhaps a web page", id="a web page"),
        pytest.param(body(BODY[:500]), "sent 500 of 102,412 bytes", id="too short, and says so"),
        pytest.param(
            body(BODY + b"more"), "is longer than the 102,412 bytes", id="too long, and says so"
        ),
        pytest.param(without_length(BODY * 2), "is longer than the 102,412 bytes", id="endless"),
        pytest.param(cut(50), "sent|was cut", id="always cut"),
        pytest.param(stall, "did not answer for 0.3 s", id="always stalls"),
        pytest.param(trickle, "bytes a second|sent|did not answer|was cut", id="always trickles"),
        pytest.param(hang_up, "the connection to 127.0.0.1 was cut", id="always hangs up"),
        pytest.param(
            body(BODY, {"Content-Encoding": "gzip"}), "sends it compressed", id="compressed"
        ),
    ],
)
def test_what_cannot_be_mended_is_said(tmp_path, answer, message):
    with serving(answer) as server, pytest.raises(FetchError, match=message) as caught:
        get(server, tmp_path)
    assert "\n" not in str(caught.value)
    assert NAME in str(caught.value)
    assert not (tmp_path / NAME).exists()


def test_without_a_network_one_line_says_so(tmp_path):
    with serving(good) as server:
        url = server.url
    with pytest.raises(
        FetchError, match=r"127\.0\.0\.1 cannot be reached .*Is this machine online"
    ):
        get(None, tmp_path, url=f"{url}/{NAME}", n_tries=2)


def test_a_wrong_file_does_not_take_the_place_of_another(tmp_path):
    (tmp_path / NAME).write_bytes(b"what I had")
    with serving(body(BODY[:-1] + b"x")) as server, pytest.raises(FetchError):
        get(server, tmp_path)
    assert (tmp_path / NAME).read_bytes() == b"what I had"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_file_in_the_way_is_said(tmp_path):
    (tmp_path / "folder").write_text("a file")
    with serving(good) as server, pytest.raises(OutputError, match="part of its path is a file"):
        get(server, tmp_path / "folder")


# Data sets


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


# Zips


def zipped(members):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return content.getvalue()


@pytest.mark.parametrize(
    "name", ["../out", "/etc/out", "a/../../out", "C:\\out", "..\\out", "C:out"]
)
def test_no_member_leaves_the_folder(tmp_path, name):
    (tmp_path / "x.zip").write_bytes(zipped({"fine": b"1", name: b"2"}))
    with pytest.raises(FetchError, match="leads out of the folder"):
        unpack(tmp_path / "x.zip", tmp_path / "in" / "side")
    assert [p.name for p in tmp_path.rglob("*")] == ["x.zip"]


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
