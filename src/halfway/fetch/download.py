"""One file over HTTP: resumed after a cut, verified, and whole under its name or not there at all.

What has come is kept in ``.FILE.part`` beside the file, so that a later run goes on where this one stopped. Going on is safe
where the checksum is known, or the server still has the same version (its ETag is kept in ``.FILE.part.etag`` and asked
for with ``If-Range``); otherwise the file is begun again.
"""

import hashlib
import math
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

import httpx

from ..errors import FetchError
from ..files import replacing, require_space
from .catalogue import Download

Progress = Callable[[str, int, int | None], None]
"""Called with the file's name, the bytes that are there, and how many it will have."""

MAX_UNKNOWN_BYTES = 2_000_000_000
"""No file whose size is not known beforehand may be larger."""

_WORTH_IT = 1 << 20  # bytes that make a try count as a success
_LEAST_RATE = 200  # bytes a second over a whole timeout; less is a stall
_WHOLE, _PARTIAL, _NO_SUCH_RANGE = 200, 206, 416
_PASSING = frozenset({408, 425, 429, 500, 502, 503, 504})


class _Cut(Exception):  # noqa: N818 (it never leaves this module)
    """The connection failed in a way that another try may mend."""


class Line(NamedTuple):
    """How files are asked for."""

    client: httpx.Client
    progress: Progress
    n_tries: int = 5
    """Of one file, in a row; one that brings much of the file does not count."""
    pause: float = 0.5
    """Seconds before the second try; doubled with each."""

    @property
    def timeout(self) -> float:
        """Seconds without an answer, or nearly none, after which a connection counts as cut."""
        return self.client.timeout.read or math.inf


def download(item: Download, folder: Path, line: Line) -> Path:
    """The path of ``item`` in ``folder``, downloaded if it is not there already, and verified; or a `FetchError`."""
    path = folder / item.file
    if path.is_file() and _fault(path, item) is None:
        return path
    require_space(folder, item.n_bytes or 0, item.file)
    with replacing(path) as temporary:
        part = path.with_name(f".{path.name}.part")
        if not (part.is_file() and item.md5 and _fault(part, item) is None):
            _get_all(item, part, line)
        fault = _fault(part, item)
        if fault is not None:
            _discard(part)
            raise FetchError(
                f"{item.file} from {_host(item.url)} {fault}. Nothing was kept; try again later."
            )
        part.replace(temporary)
    _discard(part)
    return path


def _get_all(item: Download, part: Path, line: Line) -> None:
    n_failed = 0
    while True:
        before = _size(part)
        try:
            _get(item, part, line)
        except _Cut as cut:
            n_failed = 0 if _size(part) - before > _WORTH_IT else n_failed + 1
            if n_failed >= line.n_tries:
                raise FetchError(
                    f"{item.file} could not be fetched: {cut}. {_later(part)}"
                ) from cut
            time.sleep(line.pause * 2**n_failed)
        else:
            return


def _get(item: Download, part: Path, line: Line) -> None:
    """One request: the rest of the file, or all of it."""
    headers = {"Accept-Encoding": "identity", **_resume(item, part)}
    try:
        with line.client.stream("GET", item.url, headers=headers) as response:
            _require(response, item, part)
            resumed = response.status_code == _PARTIAL
            _note_version(part, response)
            with part.open("ab" if resumed else "wb") as file:
                _copy(response, file, item, line)
    except httpx.TooManyRedirects as error:
        raise FetchError(
            f"{item.file}: {_host(item.url)} redirects in a circle. Try again later."
        ) from error
    except (httpx.UnsupportedProtocol, httpx.InvalidURL) as error:
        raise FetchError(
            f"{item.file}: {_host(item.url)} leads to an address that is none ({error})."
        ) from error
    except httpx.ConnectError as error:
        raise _Cut(
            f"{_host(item.url)} cannot be reached ({error}). Is this machine online? Behind a proxy, HTTPS_PROXY names it"
        ) from error
    except httpx.TimeoutException as error:
        raise _Cut(f"{_host(item.url)} did not answer for {line.timeout:g} s") from error
    except httpx.TransportError as error:
        raise _Cut(f"the connection to {_host(item.url)} was cut ({error})") from error


def _copy(response: httpx.Response, file: BinaryIO, item: Download, line: Line) -> None:
    """Append the body; never more than the file may have."""
    n_done = file.tell()
    announced = response.headers.get("Content-Length", "")
    expected = item.n_bytes or (n_done + int(announced) if announced.isdigit() else None)
    limit = item.n_bytes or MAX_UNKNOWN_BYTES
    started, n_since = time.monotonic(), 0
    for chunk in response.iter_raw():
        n_done += len(chunk)
        n_since += len(chunk)
        if n_done > limit:
            file.truncate(0)
            raise FetchError(
                f"{item.file} from {_host(item.url)} is longer than the {limit:,} bytes it may have. Nothing was kept."
            )
        file.write(chunk)
        line.progress(item.file, n_done, expected)
        elapsed = time.monotonic() - started
        if elapsed > line.timeout:
            if n_since < _LEAST_RATE * elapsed:
                raise _Cut(f"{_host(item.url)} sends only {n_since / elapsed:.0f} bytes a second")
            started, n_since = time.monotonic(), 0
    if expected is not None and n_done < expected:
        raise _Cut(f"{_host(item.url)} sent {n_done:,} of {expected:,} bytes")


def _require(response: httpx.Response, item: Download, part: Path) -> None:
    """Refuse an answer that is not the file, or not the part of it that was asked for."""
    code, host = response.status_code, _host(item.url)
    if code in _PASSING:
        raise _Cut(f"{host} answers {code} {response.reason_phrase}")
    if code == _NO_SUCH_RANGE:
        _discard(part)
        raise _Cut(f"{host} has no more than what was there already")
    if code not in (_WHOLE, _PARTIAL):
        raise FetchError(
            f"{item.file} cannot be had from {host}: it answers {code} {response.reason_phrase}. "
            f"See whether {item.url} opens in a browser."
        )
    if response.headers.get("Content-Encoding", "identity") != "identity":
        raise FetchError(
            f"{item.file}: {host} sends it compressed, though asked not to. Try again later."
        )
    wanted = f"bytes {_size(part)}-"
    if code == _PARTIAL and not response.headers.get("Content-Range", "").startswith(wanted):
        _discard(part)
        raise _Cut(f"{host} sent another part of the file than was asked for")


def _resume(item: Download, part: Path) -> dict[str, str]:
    """The headers that ask for the rest, where going on is safe; what is there is dropped where it is not."""
    n_there = _size(part)
    if not n_there:
        return {}
    version = _version_file(part)
    tag = version.read_text("ascii", errors="ignore") if version.is_file() else ""
    if tag and not tag.startswith("W/"):
        return {"Range": f"bytes={n_there}-", "If-Range": tag}
    if item.md5 and n_there < (item.n_bytes or 0):
        return {"Range": f"bytes={n_there}-"}
    _discard(part)
    return {}


def _note_version(part: Path, response: httpx.Response) -> None:
    tag = response.headers.get("ETag", "")
    if tag.isascii() and tag.isprintable():
        _version_file(part).write_text(tag, "ascii")


def _version_file(part: Path) -> Path:
    return part.with_name(f"{part.name}.etag")


def _discard(part: Path) -> None:
    for path in (part, _version_file(part)):
        with suppress(FileNotFoundError):
            path.unlink()


def _fault(path: Path, item: Download) -> str | None:
    """What is wrong with a file, as the end of a sentence; None where all that is known of it fits."""
    size = path.stat().st_size
    if item.n_bytes is not None and size != item.n_bytes:
        return f"has {size:,} bytes and should have {item.n_bytes:,}"
    with path.open("rb") as file:
        start = file.read(len(item.magic))
        if start != item.magic:
            return f"begins with {start[:12]!r} and should with {item.magic!r}: it is something else, perhaps a web page"
        file.seek(0)
        if item.md5 and (md5 := hashlib.file_digest(file, "md5").hexdigest()) != item.md5:
            return f"has the MD5 checksum {md5} and should have {item.md5}: it is damaged, or another version"
    return None


def _size(path: Path) -> int:
    return path.stat().st_size if path.is_file() else 0


def _host(url: str) -> str:
    return httpx.URL(url).host


def _later(part: Path) -> str:
    n_there = _size(part)
    kept = (
        f"The {n_there:,} bytes that came are kept, and the next run goes on from there"
        if n_there
        else "Try again later"
    )
    return f"{kept}."
