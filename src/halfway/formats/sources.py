"""Where the bytes of a material come from: a file, or a member of a zip, which is read without unpacking the rest."""

import hashlib
import lzma
import struct
import zipfile
import zlib
from abc import ABC, abstractmethod
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from io import BufferedIOBase, BufferedReader
from pathlib import Path, PurePath, PurePosixPath
from typing import Any, cast

from ..errors import FormatError, shown

UNREADABLE = (
    OSError,
    EOFError,
    RuntimeError,  # a member with a password
    NotImplementedError,  # a compression that Python does not know
    ValueError,  # a member's name in no alphabet, or a place before the file's start
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
)
"""The exceptions of a file that cannot be read, or of a zip that is damaged or none."""


class Source(ABC):
    """Bytes that may be a material, not yet read."""

    @property
    @abstractmethod
    def location(self) -> str:
        """The path, as a person would look for it."""

    @property
    @abstractmethod
    def label(self) -> str:
        """The file's name, as messages call it."""

    @property
    def name(self) -> str:
        """What the material is called: the file's name without its suffix."""
        return PurePosixPath(self.label).stem

    @property
    @abstractmethod
    def n_bytes(self) -> int:
        """How many bytes there are."""

    @abstractmethod
    def _open(self) -> BufferedIOBase: ...

    @contextmanager
    def open(self) -> Generator[BufferedIOBase]:
        """The bytes as a stream; a `FormatError` where they cannot be read, now or inside the block."""
        try:
            with self._open() as stream:
                yield stream
        except UNREADABLE as error:
            reason = (error.strerror if isinstance(error, OSError) else None) or error
            raise FormatError(
                f"{self.label} cannot be read ({reason}): see {self.location}."
            ) from error

    def head(self, n_bytes: int) -> bytes:
        """The first bytes; fewer where there are no more."""
        with self.open() as stream:
            return stream.read(n_bytes)

    def sha256(self) -> str:
        """Hex digits of the checksum of all bytes."""
        with self.open() as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()


@dataclass(frozen=True)
class FileSource(Source):
    """A file on disk.

    Raises
    ------
    FormatError
        When it does not exist, or is a folder or a device.
    """

    path: Path

    def __post_init__(self) -> None:
        if self.path.is_dir():
            raise FormatError(f"{self.label} is a folder: expected one file. Name a file in it.")
        if not self.path.exists():
            raise FormatError(f"{self.path} does not exist: expected a file of a BRDF.")
        if not self.path.is_file():
            # Reading a pipe could wait forever.
            raise FormatError(f"{self.label} is no ordinary file: expected a file of a BRDF.")

    @property
    def location(self) -> str:
        return str(self.path)

    @property
    def label(self) -> str:
        return shown(self.path.name)

    @property
    def n_bytes(self) -> int:
        return self.path.stat().st_size

    def __reduce__(self) -> tuple[Any, ...]:
        """A source travels by a path that means the same in every folder."""
        return FileSource, (self.path.absolute(),)

    def _open(self) -> BufferedReader:
        return self.path.open("rb")


@dataclass(frozen=True)
class MemberSource(Source):
    """A member of a zip, which stays open as long as one of its members is around; threads may read side by side.

    It never yields more bytes than the zip's directory states.
    """

    archive: zipfile.ZipFile
    member: zipfile.ZipInfo

    @property
    def location(self) -> str:
        return f"{self.archive.filename}:{shown(self.member.filename)}"

    @property
    def label(self) -> str:
        return shown(PurePosixPath(self.member.filename).name)

    @property
    def n_bytes(self) -> int:
        return self.member.file_size

    def __reduce__(self) -> tuple[Any, ...]:
        """A member travels as its zip's path and its place in it."""
        return _member_at, (Path(str(self.archive.filename)).absolute(), self.member.header_offset)

    def _open(self) -> BufferedIOBase:
        # `zipfile` takes memory for what a member claims to take in the zip.
        if self.member.compress_size > Path(cast("str", self.archive.filename)).stat().st_size:
            raise zipfile.BadZipFile("it claims to be longer than the zip")
        return cast("BufferedIOBase", self.archive.open(self.member))


def members(archive: Path) -> list[MemberSource]:
    """The files in a zip, sorted by path; a `FormatError` where the zip is damaged."""
    try:
        opened = zipfile.ZipFile(archive)
    except UNREADABLE as error:
        raise FormatError(
            f"{archive.name} is a damaged zip ({str(error)[:100]}): compare it with the original download."
        ) from error
    # `is_dir` fails on a member without a name.
    infos = [info for info in opened.infolist() if not info.filename.endswith("/")]
    infos.sort(key=lambda info: by_name(PurePosixPath(info.filename)))
    return [MemberSource(opened, info) for info in infos]


def _member_at(archive: Path, offset: int) -> MemberSource:
    return _members_by_offset(archive)[offset]


@lru_cache(maxsize=4)
def _members_by_offset(archive: Path) -> dict[int, MemberSource]:
    return {source.member.header_offset: source for source in members(archive)}


def by_name(path: PurePath) -> tuple[tuple[str, ...], str]:
    """Sorts files as the materials in them are called, by path without the suffix."""
    return (*path.parent.parts, path.stem), path.suffix
