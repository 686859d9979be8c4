"""One file over HTTP from a server that does everything wrong: the faults that docs/interchange.md lists."""

import httpx
import pytest
from faulty_server import (
    BODY,
    MD5,
    N_BYTES,
    NAME,
    body,
    cut,
    cut_and_resume,
    good,
    hang_up,
    ignores_ranges,
    serving,
    stall,
    status,
    trickle,
    without_length,
    wrong_range,
)
from patience import PATIENCE

from halfway.errors import FetchError, OutputError
from halfway.fetch.catalogue import TENSOR_FILE, Download
from halfway.fetch.download import Line, download


def get(server, folder, *, n_bytes=N_BYTES, md5=MD5, url=None, n_tries=3, timeout=PATIENCE):
    item = Download(NAME, url or f"{server.url}/{NAME}", TENSOR_FILE, n_bytes, md5)
    with httpx.Client(follow_redirects=True, max_redirects=5, timeout=timeout) as client:
        line = Line(client, lambda *_: None, n_tries=n_tries, pause=0.001)
        return download(item, folder, line)


def timeout_of(answer):
    """Short for a server that says nothing."""
    return 0.3 if answer in (stall, trickle) else PATIENCE


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
        options = {} if known else {"n_bytes": None, "md5": ""}
        # A good server may be given up as too slow, on a busy machine: it is asked again.
        path = get(server, tmp_path, n_tries=10, timeout=timeout_of(answers[0]), **options)
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
        get(server, tmp_path, timeout=timeout_of(answer))
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


def test_a_proxy_named_in_the_environment_is_used(tmp_path, monkeypatch):
    """Asked for the whole address, as a proxy is."""
    with serving(good) as proxy:
        monkeypatch.setenv("HTTP_PROXY", proxy.url)
        path = get(None, tmp_path, url=f"http://nowhere.invalid/{NAME}")
    assert path.read_bytes() == BODY
    assert proxy.requests[0]["Host"] == "nowhere.invalid"


def test_a_proxy_that_is_away_is_said(tmp_path, monkeypatch):
    with serving(good) as proxy:
        monkeypatch.setenv("HTTP_PROXY", proxy.url)
    with pytest.raises(FetchError, match=r"nowhere.invalid cannot be reached .*Behind a proxy"):
        get(None, tmp_path, url=f"http://nowhere.invalid/{NAME}", n_tries=1)


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
