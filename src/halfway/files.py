"""Files that are whole or absent: written beside the final name, then renamed into place; remote ones are put whole."""

import errno
import glob
import os
import re
import secrets
import shutil
import tempfile
import time
from collections.abc import Collection, Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from .errors import HalfwayError, OutputError
from .locations import Location, RemotePath

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

_TOKEN_BYTES = 6
_JUST_MADE_SECONDS = 10.0
_TEMPORARY = re.compile(rf"\..+\.[0-9a-f]{{{2 * _TOKEN_BYTES}}}(\.\w+)?")


def suffix_of(path: Path, known: Collection[str], *, what: str = "format") -> str:
    """The suffix of a file to write, in small letters: one of ``known``, or an `OutputError`."""
    if path.suffix.lower() in known:
        return path.suffix.lower()
    wrong = f"the suffix {path.suffix!r}, which names no {what}" if path.suffix else "no suffix"
    raise OutputError(f"{path} has {wrong}: expected {', '.join(known)}.")


@contextmanager
def replacing(path: Location) -> Generator[Path]:
    """A temporary path beside ``path`` that takes its place when the block ends well, and is removed when not.

    The temporary name keeps the suffix, so that a writer that chooses its format by the suffix works. What goes to a
    remote place is written to this machine's folder of temporary files first.

    Raises
    ------
    OutputError
        When the folder cannot be written, or has no room left.
    RemoteError
        When a remote place cannot be reached.
    """
    if isinstance(path, RemotePath):
        with explaining(path), tempfile.TemporaryDirectory(prefix="halfway-") as folder:
            temporary = Path(folder, path.name)
            with _named(path, temporary):
                yield temporary
            path.put(temporary)
        return
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(_TOKEN_BYTES)}{path.suffix}")
    with explaining(path):
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with _named(path, temporary):
                yield temporary
            temporary.replace(path)
        finally:
            with suppress(OSError):
                temporary.unlink()


def write_text(path: Location, text: str) -> None:
    """Write a text file whole, or not at all; raises as `replacing` does."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextmanager
def _named(path: Location, temporary: Path) -> Generator[None]:
    """Let a mistake speak of the file that a person asked for."""
    try:
        yield
    except HalfwayError as error:
        said = str(error).replace(str(temporary), str(path)).replace(temporary.name, path.name)
        error.args = (said,)
        raise


@contextmanager
def explaining(path: Location) -> Generator[None]:
    """Turn every `OSError` while ``path`` is written into an `OutputError` of one line that says what to do."""
    try:
        yield
    except OSError as error:
        raise OutputError(_explain(path, error)) from error


@contextmanager
def scratch_folder(path: Location) -> Generator[Path]:
    """A folder to make ``path`` in, beside it, or among this machine's temporary files where ``path`` is remote.

    It is removed at the end, if it is still there; so are those that killed writers of ``path`` left.

    Raises
    ------
    OutputError
        When the folder cannot be written, or has no room left.
    """
    parent = Path(tempfile.gettempdir()) if isinstance(path, RemotePath) else path.parent
    folder = parent / f".{path.name}.{secrets.token_hex(_TOKEN_BYTES)}.new"
    with explaining(path):
        parent.mkdir(parents=True, exist_ok=True)
        for left in parent.glob(f".{glob.escape(path.name)}.*.new"):
            _remove_dead(left)
        folder.mkdir()
        try:
            with lock(folder):
                yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def lock(folder: Path, *, wait: bool = False) -> Generator[bool | None]:
    """Whether a folder's lock could be had, at once or by waiting for it; None where the system or the disk has no locks.

    It ends with the block, and with the process however that ends. It is the folder's own: a lock file, as lock libraries
    keep one, would stay behind among a person's files.
    """
    if fcntl is None:
        yield None
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        yield _flock(fcntl, handle, wait)
    finally:
        os.close(handle)


def _flock(fcntl: Any, handle: int, wait: bool) -> bool | None:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def sweep(folder: Location) -> None:
    """Remove the temporary files that killed writers of `replacing` left in ``folder``; nobody may be writing there."""
    if isinstance(folder, RemotePath):
        return
    for path in list(folder.rglob(".*")):
        if _TEMPORARY.fullmatch(path.name) and path.is_file():
            path.unlink(missing_ok=True)


def require_space(folder: Location, n_bytes: int, what: str) -> None:
    """Refuse to start what the disk of ``folder`` cannot hold; nobody knows what remote storage does."""
    if isinstance(folder, RemotePath):
        return
    existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    free = shutil.disk_usage(existing).free
    if free < n_bytes:
        raise OutputError(
            f"{what} takes {n_bytes / 1e6:,.1f} MB and {folder} has {free / 1e6:,.1f} MB free: "
            "free some space or write elsewhere with -o."
        )


def _remove_dead(folder: Path) -> None:
    """Remove a scratch folder whose maker died: one that nobody holds the lock of, nor has just made."""
    with suppress(OSError), lock(folder) as held:
        if held and time.time() - folder.stat().st_mtime > _JUST_MADE_SECONDS:
            shutil.rmtree(folder)


def _explain(path: Location, error: OSError) -> str:
    match error.errno:
        case errno.ENOSPC:
            return f"{path} cannot be written: the disk is full. Free some space; what was finished is kept."
        case errno.EACCES | errno.EROFS | errno.EPERM:
            return f"{path} cannot be written: no permission in {path.parent}. Choose another folder with -o."
        case errno.ENOENT:
            return (
                f"{path} cannot be written: no folder can be made for it. Choose another with -o."
            )
        case errno.ENOTDIR | errno.EEXIST:
            return f"{path} cannot be written: part of its path is a file, not a folder. Choose another with -o."
        case _:
            return f"{path} cannot be written: {error.strerror or error}. Choose another folder with -o."
