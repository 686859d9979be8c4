"""Unpack a zip that came over the network, and trust nothing in it."""

import shutil
import stat
import zipfile
from pathlib import Path, PurePosixPath, PureWindowsPath

from ..errors import FetchError
from ..files import replacing, require_space
from ..formats import UNREADABLE

MAX_RATIO = 100
"""Bytes of a member for each byte in the zip, at most; tables compress to a half or so."""
MAX_MEMBERS = 10_000
LONGEST_NAME = 200
_CHUNK = 1 << 20


def unpack(archive: Path, folder: Path) -> list[Path]:
    """The files of a zip, unpacked below ``folder``, each whole or absent.

    Everything is checked before the first byte is written, and while a member is written it is held to the size that
    the zip states for it.

    Raises
    ------
    FetchError
        When the zip is damaged, has a member outside the folder, a link, or one that unpacks to far more than it holds.
    OutputError
        When the disk has no room.
    """
    try:
        with zipfile.ZipFile(archive) as opened:
            # `is_dir` fails on a member without a name.
            members = [info for info in opened.infolist() if not info.filename.endswith("/")]
            _require_modest(archive, members)
            paths = [folder / _inner(archive, info) for info in members]
            require_space(folder, sum(info.file_size for info in members), archive.name)
            for info, path in zip(members, paths, strict=True):
                _write(opened, info, path)
    except UNREADABLE as error:
        raise FetchError(
            f"{archive.name} is a damaged zip ({str(error)[:100]}): delete it and fetch it again."
        ) from error
    return paths


def _require_modest(archive: Path, members: list[zipfile.ZipInfo]) -> None:
    if len(members) > MAX_MEMBERS:
        raise FetchError(
            f"{archive.name} has {len(members):,} members: no more than {MAX_MEMBERS:,} are unpacked."
        )
    n_bytes = sum(info.file_size for info in members)
    n_packed = archive.stat().st_size
    if max((info.compress_size for info in members), default=0) > n_packed:
        raise zipfile.BadZipFile("a member claims to be longer than the zip")
    if n_bytes > MAX_RATIO * n_packed:
        raise FetchError(
            f"{archive.name} would unpack to {n_bytes:,} bytes from {n_packed:,}: no more than {MAX_RATIO} times its "
            "size is unpacked. It is no archive of BRDFs."
        )


def _inner(archive: Path, info: zipfile.ZipInfo) -> Path:
    """The member's path relative to the folder."""
    name = info.filename
    path = PurePosixPath(name)
    outside = (
        path.is_absolute() or ".." in path.parts or PureWindowsPath(name).drive or "\\" in name
    )
    if outside or not path.parts:
        raise FetchError(
            f"{archive.name} has a member {name[:100]!r}, which leads out of the folder: it was not unpacked."
        )
    if not name.isprintable() or len(name) > LONGEST_NAME:
        raise FetchError(
            f"{archive.name} has a member named {name[:50]!r} ({len(name)} characters): expected a path of at most "
            f"{LONGEST_NAME} printable ones. It was not unpacked."
        )
    if stat.S_ISLNK(info.external_attr >> 16):
        raise FetchError(f"{archive.name} has a link in it, {name[:100]!r}: it was not unpacked.")
    return Path(*path.parts)


def _write(opened: zipfile.ZipFile, info: zipfile.ZipInfo, path: Path) -> None:
    # `zipfile` stops at the stated size and compares the checksum, so a member cannot be longer than was checked.
    with replacing(path) as temporary, opened.open(info) as source, temporary.open("wb") as file:
        shutil.copyfileobj(source, file, _CHUNK)
