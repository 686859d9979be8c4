"""Where files are: a path of this machine, or a URL such as ``s3://bucket/x.brdflib`` of storage that many share.

Local paths are `pathlib.Path`. A `RemotePath` has the same names for the few things that we do with paths, by fsspec,
so that code over a `Location` says it once. What differs is said here: an object is put whole, cannot be renamed, and is
read in ranges, many at a time.
"""

import os
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fnmatch import fnmatch
from io import BufferedReader
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from .errors import MissingExtraError, RemoteError

SCHEME = "://"
BUILTIN_PREFIX = "builtin:"
"""How the address of a library that comes with the package begins."""
PERMUTED_PREFIX = "permuted:"
"""How the address of a library begins whose materials are taken in all orders of their colour channels."""
DEFAULT_LIBRARY = f"{BUILTIN_PREFIX}merl-abc"
"""The library that is meant where none is named."""
_PACKAGES = {"s3": "s3fs", "gs": "gcsfs"}
"""Of the extra ``cloud``, by the beginning of a URL."""


class RemoteStat(NamedTuple):
    """What is known of a remote file without reading it."""

    st_size: int


@dataclass(frozen=True)
class RemotePath:
    """A URL, with the part of `pathlib.Path` that we use.

    Raises
    ------
    RemoteError
        From every method, when the storage cannot be reached or refuses; `FileNotFoundError` where there is no file.
    """

    url: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "url", self.url.rstrip("/"))

    def __str__(self) -> str:
        return self.url

    def __truediv__(self, name: str) -> "RemotePath":
        return RemotePath(f"{self.url}/{name}")

    @property
    def name(self) -> str:
        return self.url.rpartition("/")[2]

    @property
    def stem(self) -> str:
        return PurePosixPath(self.name).stem

    @property
    def suffix(self) -> str:
        return PurePosixPath(self.name).suffix

    @property
    def parent(self) -> "RemotePath":
        return RemotePath(self.url.rpartition("/")[0])

    def with_suffix(self, suffix: str) -> "RemotePath":
        return self.parent / PurePosixPath(self.name).with_suffix(suffix).name

    def exists(self) -> bool:
        with self._asking() as (fs, path):
            return bool(fs.exists(path))

    def is_file(self) -> bool:
        with self._asking() as (fs, path):
            return bool(fs.isfile(path))

    def stat(self) -> RemoteStat:
        with self._asking() as (fs, path):
            return RemoteStat(int(fs.info(path)["size"]))

    def rglob(self, pattern: str) -> Iterator["RemotePath"]:
        with self._asking() as (fs, path):
            urls = [fs.unstrip_protocol(name) for name in fs.find(path)]
        return (there for there in map(RemotePath, urls) if fnmatch(there.name, pattern))

    def mkdir(self, **_: bool) -> None:
        """Nothing: folders are a part of the names of what is in them."""

    def unlink(self, *, missing_ok: bool = False) -> None:
        with self._asking() as (fs, path):
            try:
                fs.rm_file(path)
            except FileNotFoundError:
                if not missing_ok:
                    raise

    def read_bytes(self) -> bytes:
        with self._asking() as (fs, path):
            return fs.cat_file(path)

    def read_text(self, encoding: str = "utf-8") -> str:
        return self.read_bytes().decode(encoding)

    @contextmanager
    def open(self, mode: str = "rb") -> Generator[BufferedReader]:
        """The file as a stream, to read."""
        with self._asking() as (fs, path), fs.open(path, mode) as stream:
            yield stream

    def put(self, file: Path) -> None:
        """Put a whole local file here; it is there when it is whole, and not before."""
        with self._asking() as (fs, path):
            fs.put_file(str(file), path)

    def put_text(self, text: str) -> None:
        """Put a small file here, whole."""
        with self._asking() as (fs, path):
            fs.pipe_file(path, text.encode())

    def read_ranges(self, ranges: Sequence[tuple[int, int]]) -> list[bytes]:
        """The bytes of ranges (start, stop), asked for side by side."""
        with self._asking() as (fs, path):
            starts, stops = zip(*ranges, strict=True)
            return fs.cat_ranges([path] * len(ranges), list(starts), list(stops), on_error="raise")

    @contextmanager
    def _asking(self) -> Generator[tuple[Any, str]]:
        try:
            yield _file_system(self.url)
        except (FileNotFoundError, RemoteError, MissingExtraError):
            raise
        except Exception as error:  # each storage has its own
            reason = " ".join(str(error).split()) or type(error).__name__
            raise RemoteError(
                f"{self.url} cannot be reached ({reason[:200]}): expected storage that answers and lets us in. "
                "Check the address, and the credentials that its command-line tools use."
            ) from error


Location = Path | RemotePath
"""Where a file or a folder is."""


def to_location(where: "str | Location") -> Location:
    """The place that a person writes: a URL is remote, except ``file://``; anything else is a path."""
    if not isinstance(where, str):
        return where
    if where.startswith("file://"):
        return Path(where.removeprefix("file://"))
    return RemotePath(where) if SCHEME in where else Path(where)


def absolute(location: Location) -> Location:
    """The location by a name that means the same in every folder."""
    return location.absolute() if isinstance(location, Path) else location


def name_in(folder: Location, location: Location) -> str:
    """What a file is called in a folder that holds it, with ``/`` between."""
    if isinstance(folder, Path) and isinstance(location, Path):
        return location.relative_to(folder).as_posix()
    return str(location).removeprefix(f"{folder}/")


def read_into(location: Location, starts: Sequence[int], buffers: Sequence[memoryview]) -> None:
    """Fill each buffer with the bytes of a file from its start on; an `OSError` where it ends before they are full."""
    if isinstance(location, RemotePath):
        ranges = [(start, start + len(b)) for start, b in zip(starts, buffers, strict=True)]
        for buffer, content in zip(buffers, location.read_ranges(ranges), strict=True):
            _require_full(location, len(content), len(buffer))
            buffer[:] = content
        return
    with location.open("rb", buffering=0) as file:
        for start, buffer in zip(starts, buffers, strict=True):
            _require_full(location, _read_at(file, start, buffer), len(buffer))


def append_text(location: Location, text: str) -> None:
    """Add to the end of a file; a remote one, which should be small, is put again as a whole."""
    if isinstance(location, RemotePath):
        location.put_text(location.read_text(encoding="utf-8") + text)
        return
    with location.open("a") as file:
        file.write(text)


if hasattr(os, "preadv"):

    def _read_at(file: Any, start: int, buffer: memoryview) -> int:
        return os.preadv(file.fileno(), [buffer], start)

else:

    def _read_at(file: Any, start: int, buffer: memoryview) -> int:
        file.seek(start)
        return file.readinto(buffer)


def _require_full(location: Location, n_bytes: int, expected: int) -> None:
    if n_bytes < expected:
        raise OSError(f"{location} ended {expected - n_bytes:,} bytes early")


def _file_system(url: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        raise MissingExtraError(url, "fsspec", "cloud") from None
    try:
        # Others write there too: listings are not remembered.
        return url_to_fs(url, use_listings_cache=False)
    except ImportError as error:
        package = _PACKAGES.get(url.partition(SCHEME)[0])
        if package:
            raise MissingExtraError(url, package, "cloud") from None
        raise RemoteError(f"{url} needs a package of its own: {error}.") from None
    except ValueError:
        raise RemoteError(
            f"{url} begins with no storage that is known: expected such as s3://, gs:// or a path."
        ) from None
