"""A folder that one command fills with whatever it writes there; afterwards a manifest names it all.

What is there is ours where an earlier run of the same command wrote it and nobody has changed it since; it goes when it is
not written again. Anything else is somebody else's, and such a folder is refused unless it is to be written to all the same.
"""

from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ..errors import FormatError, OutputError
from ..locations import Location, name_in
from .manifest import JOURNAL, MANIFEST, Checksum, Entry, Manifest, verify


@contextmanager
def filling(folder: Location, by: str, *, force: bool = False) -> Generator[None]:
    """The block writes files into ``folder``; ``by`` is the command that does.

    Raises
    ------
    OutputError
        When the folder holds anything that this command did not write, or that was changed since, without ``force``.
    """
    if not force:
        require_own(folder, by)
    before = _files(folder)
    ours = frozenset[str]() if force else frozenset(before)
    folder.mkdir(parents=True, exist_ok=True)
    # From here on a run that is stopped leaves a folder of ours.
    Manifest({"by": by}, ours).write_journal(folder)
    try:
        yield
    except BaseException:
        _leave_no_empty(folder)
        raise
    after = _files(folder)
    written = {name for name, state in after.items() if before.get(name) != state}
    for name in ours - written:
        (folder / name).unlink(missing_ok=True)
    entries = {name: Entry({}, Checksum.of(folder / name)) for name in written}
    Manifest({"by": by}, frozenset(written), entries).write(folder)


def require_own(folder: Location, by: str) -> None:
    """Refuse a folder with files that the command ``by`` did not write, or that were changed since.

    Raises
    ------
    OutputError
        When there are any.
    """
    others = sorted(_files(folder))
    manifest = _manifest(folder)
    if manifest is not None and manifest.made["by"] == by:
        verdict = verify(folder)
        stopped = (folder / JOURNAL).exists()
        others = verdict.changed + ([] if stopped else verdict.foreign)
    if others:
        raise OutputError(
            f"{folder} holds {len(others)} files that `halfway {by}` did not write, or that were changed since, such as "
            f"{others[0]}: expected an empty folder, or one of an earlier run. Choose another with -o, or add --force."
        )


def _leave_no_empty(folder: Location) -> None:
    """Remove a folder that nothing was written to."""
    if not _files(folder):
        (folder / JOURNAL).unlink(missing_ok=True)
        if isinstance(folder, Path):
            with suppress(OSError):
                folder.rmdir()


def _manifest(folder: Location) -> Manifest | None:
    try:
        return Manifest.read(folder)
    except FormatError:
        return None


def _files(folder: Location) -> dict[str, Any]:
    """Each file in the folder but its manifest, with what changes when it is written."""
    found: dict[str, Any] = {}
    for path in folder.rglob("*"):
        if path.name not in (MANIFEST, JOURNAL) and path.is_file():
            status = path.stat()
            # What is not known of a remote file may have changed.
            moment = getattr(status, "st_mtime_ns", object()), getattr(status, "st_ino", 0)
            found[name_in(folder, path)] = (status.st_size, *moment)
    return found
