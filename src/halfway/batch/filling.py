"""A folder that one command fills with whatever it writes; a manifest names it all, and nothing changes if it fails.

What is there is ours where an earlier run of the same command wrote it and nobody has changed it since; it goes when it is
not written again. Anything else is somebody else's, and such a folder is refused unless it is to be written to all the same.
"""

from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import FormatError, OutputError
from ..files import explaining, scratch_folder
from ..locations import Location, RemotePath, name_in
from .manifest import JOURNAL, MANIFEST, Checksum, Entry, Manifest, verify


@contextmanager
def filling(folder: Location, by: str, *, force: bool = False) -> Generator[Path]:
    """A scratch folder for the block to write to; what is in it goes into ``folder`` when the block ends well.

    Parameters
    ----------
    by : str
        The command that writes.
    force : bool
        Write over what this command did not write, or what was changed since.

    Raises
    ------
    OutputError
        When there is any such thing and ``force`` is not given, or the folder cannot be written.
    """
    if not force:
        require_own(folder, by)
    with scratch_folder(folder) as scratch:
        yield scratch
        with explaining(folder):
            _move(scratch, folder, by)


@contextmanager
def keeping(folder: Path, name: str, by: str, *, force: bool = False) -> Generator[Path]:
    """A file in ``folder`` for the block, which takes long, to note in what it has; it goes when `filling` has filled the folder.

    What an earlier block that was stopped noted is still there, unless ``force`` is given. Parameters and errors are those of `filling`.
    """
    if not force:
        require_own(folder, by)
    own, path = _own(folder, by), folder / name
    with explaining(folder):
        folder.mkdir(parents=True, exist_ok=True)
        if force:
            path.unlink(missing_ok=True)
        names = {name} if own is None else own.names | {name}
        Manifest({"by": by}, frozenset(names)).write_journal(folder)
    try:
        yield path
    except BaseException:
        if own is None and not path.exists():  # nothing came of it
            (folder / JOURNAL).unlink(missing_ok=True)
            with suppress(OSError):
                folder.rmdir()
        raise


def require_own(folder: Location, by: str) -> None:
    """Refuse a folder with files that the command ``by`` did not write, or that were changed since.

    Raises
    ------
    OutputError
        When there are any.
    """
    others = sorted(_files(folder))
    if _own(folder, by) is not None:
        verdict = verify(folder)
        stopped = (folder / JOURNAL).exists()
        others = [] if stopped else verdict.changed + verdict.foreign
    if others:
        raise OutputError(
            f"{folder} holds files that `halfway {by}` did not write, or that were changed since, {others[0]} among them: "
            "expected an empty folder, or one of an earlier run. Choose another with -o, or add --force."
        )


def _move(scratch: Path, folder: Location, by: str) -> None:
    names, own = _files(scratch), _own(folder, by)
    old = frozenset[str]() if own is None else own.names
    folder.mkdir(parents=True, exist_ok=True)
    Manifest({"by": by}, old | names).write_journal(folder)  # should this be stopped, it is ours
    entries = {name: Entry({}, Checksum.of(scratch / name)) for name in names}
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(path, RemotePath):
            path.put(scratch / name)
        else:
            (scratch / name).replace(path)
    for name in old - names:
        (folder / name).unlink(missing_ok=True)
    Manifest({"by": by}, names, entries).write(folder)


def _own(folder: Location, by: str) -> Manifest | None:
    """The folder's manifest, if the command ``by`` wrote it."""
    try:
        manifest = Manifest.read(folder)
    except FormatError:
        return None
    return manifest if manifest is not None and manifest.made["by"] == by else None


def _files(folder: Location) -> frozenset[str]:
    """The files in the folder but its manifest."""
    there = (path for path in folder.rglob("*") if path.is_file())
    return frozenset(name_in(folder, path) for path in there) - {MANIFEST, JOURNAL}
