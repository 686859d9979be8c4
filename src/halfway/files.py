"""Files that are whole or absent: written beside the final name, then renamed into place."""

import errno
import re
import secrets
import shutil
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import OutputError

_TOKEN_BYTES = 6
_TEMPORARY = re.compile(rf"\..+\.[0-9a-f]{{{2 * _TOKEN_BYTES}}}(\.\w+)?")


@contextmanager
def replacing(path: Path) -> Generator[Path]:
    """A temporary path beside ``path`` that takes its place when the block ends well, and is removed when not.

    The temporary name keeps the suffix, so that a writer that chooses its format by the suffix works.

    Raises
    ------
    OutputError
        When the folder cannot be written, or has no room left.
    """
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(_TOKEN_BYTES)}{path.suffix}")
    with explaining(path):
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            yield temporary
            temporary.replace(path)
        finally:
            with suppress(OSError):
                temporary.unlink()


@contextmanager
def replacing_folder(path: Path) -> Generator[Path]:
    """A temporary folder beside ``path`` that takes its place when the block ends well, and is removed when not.

    Raises
    ------
    OutputError
        When the folder cannot be written; what stood at ``path`` stays.
    """
    token = secrets.token_hex(_TOKEN_BYTES)
    temporary, old = (path.with_name(f".{path.name}.{token}.{role}") for role in ("new", "old"))
    with explaining(path):
        try:
            temporary.mkdir(parents=True)
            yield temporary
            if path.exists():
                path.rename(old)
            try:
                temporary.rename(path)
            except OSError:
                if old.exists():
                    old.rename(path)
                raise
        finally:
            for folder in (temporary, old):
                shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def explaining(path: Path) -> Generator[None]:
    """Turn what goes wrong while ``path`` is written into one line that says what to do.

    Raises
    ------
    OutputError
        For every `OSError` inside the block.
    """
    try:
        yield
    except OSError as error:
        raise OutputError(_explain(path, error)) from error


def sweep(folder: Path) -> None:
    """Remove the temporary files that killed writers of `replacing` left in ``folder``; nobody may be writing there."""
    for path in list(folder.rglob(".*")):
        if _TEMPORARY.fullmatch(path.name) and path.is_file():
            path.unlink(missing_ok=True)


def require_space(folder: Path, n_bytes: int, what: str) -> None:
    """Refuse to start what the disk cannot hold.

    Raises
    ------
    OutputError
        When the disk of ``folder`` has fewer than ``n_bytes`` free.
    """
    existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    free = shutil.disk_usage(existing).free
    if free < n_bytes:
        raise OutputError(
            f"{what} takes {n_bytes / 1e9:.2f} GB and {folder} has {free / 1e9:.2f} GB free: "
            "free some space or write elsewhere with -o."
        )


def _explain(path: Path, error: OSError) -> str:
    match error.errno:
        case errno.ENOSPC:
            return f"{path} cannot be written: the disk is full. Free some space; what was finished is kept."
        case errno.EACCES | errno.EROFS | errno.EPERM:
            return f"{path} cannot be written: no permission in {path.parent}. Choose another folder with -o."
        case errno.ENOTDIR | errno.EEXIST:
            return f"{path} cannot be written: part of its path is a file, not a folder. Choose another with -o."
        case _:
            return f"{path} cannot be written: {error.strerror or error}."
