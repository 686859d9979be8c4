"""Many files in one folder, written so that a run may be killed at any moment and the next one goes on.

    with Batch.open(folder, outputs, made=made, n_bytes=n_bytes) as batch:
        for name, checksum in run(write_one, batch.missing):
            batch.add(name, checksum)

One run at a time works in a folder. A file of an earlier run is kept where it is made of the same and still has the bytes
that it had; any other that the folder's manifest names is removed before the rest is written. So a file under its final
name is whole and right at any time. What no manifest names is somebody else's: it stays, and is never written over.
"""

from collections.abc import Container, Generator, Iterable, Mapping
from contextlib import contextmanager, suppress
from typing import Any, NamedTuple

from ..errors import OutputError
from ..files import explaining, lock, require_space, sweep
from ..locations import Location, RemotePath, append_text
from ..tasks import HERE, Work
from .manifest import JOURNAL, Checksum, Entry, Manifest, journal_line, right_files


class Written(NamedTuple):
    """What a run did in a folder."""

    n_written: int
    n_kept: int
    """Files that an earlier run had finished."""


class Batch:
    """The files of a folder, finished or still to be made; open one with `Batch.open`."""

    def __init__(
        self, folder: Location, outputs: Mapping[str, Any], finished: Container[str]
    ) -> None:
        self._folder = folder
        self._outputs = outputs
        self.missing = [name for name in outputs if name not in finished]
        """Names of the files that are still to be made."""
        self.n_kept = len(outputs) - len(self.missing)
        """Files that an earlier run finished."""

    @classmethod
    @contextmanager
    def open(
        cls,
        folder: Location,
        outputs: Mapping[str, Any],
        *,
        made: Mapping[str, Any],
        n_bytes: int,
        work: Work = HERE,
    ) -> Generator["Batch"]:
        """The batch of ``outputs`` in ``folder``; when the block ends and all of them are there, so is manifest.json.

        Parameters
        ----------
        folder : path
            Made where there is none.
        outputs : mapping
            What each file is made of, as JSON, by its name in the folder.
        made : mapping
            What they have in common, as JSON; ``made["by"]`` is the command that makes them.
        n_bytes : int
            How many bytes one of them takes at most.

        Raises
        ------
        OutputError
            When the folder cannot be written or has no room, another run works in it, it holds another command's files,
            or a file that no manifest names is in the way.
        FormatError
            When the folder's manifest cannot be read.
        """
        with _folder(folder), _alone(folder):
            manifest = _prepare(folder, outputs, made, n_bytes, work)
            yield cls(folder, outputs, manifest.entries)
            manifest = Manifest.read(folder)
            if manifest is not None and manifest.finished:
                sweep(folder)  # of workers that were killed, whose tasks others did
                manifest.write(folder)

    def add(self, name: str, checksum: Checksum) -> None:
        """Note that a file is finished."""
        line = journal_line(name, Entry(self._outputs[name], checksum))
        path = self._folder / JOURNAL
        with explaining(path):
            append_text(path, line)


@contextmanager
def _folder(folder: Location) -> Generator[None]:
    """Make the folder; remove it again when nothing came of it."""
    with explaining(folder):
        folder.mkdir(parents=True, exist_ok=True)
    try:
        yield
    except BaseException:
        if not isinstance(folder, RemotePath):
            with suppress(OSError):
                folder.rmdir()  # only an empty one goes
        raise


@contextmanager
def _alone(folder: Location) -> Generator[None]:
    """Hold the folder's lock; without one where there is none to be had."""
    if isinstance(folder, RemotePath):
        yield
        return
    with lock(folder) as held:
        if held is False:
            raise OutputError(
                f"{folder} is being written by another halfway: wait for it, or choose another folder with -o."
            )
        yield


def _prepare(
    folder: Location, outputs: Mapping[str, Any], made: Mapping[str, Any], n_bytes: int, work: Work
) -> Manifest:
    """Leave what is right, remove what is not, and write the journal's first lines."""
    old = Manifest.read(folder) or Manifest(made)
    _refuse_others(folder, old, outputs, made)
    sweep(folder)
    same = old.entries if old.made == made else {}
    others = {name: entry for name, entry in same.items() if name not in outputs}
    ours = {name: e for name, e in same.items() if name in outputs and e.of == outputs[name]}
    right = right_files(folder, ours, work=work)
    entries = others | {name: ours[name] for name in outputs if name in right}
    names = frozenset(outputs) | (old.names if old.made == made else frozenset())
    gone = [path for name in old.names if name not in entries and (path := folder / name).is_file()]
    n_missing = len(outputs.keys() - right)
    room = n_missing * n_bytes - sum(path.stat().st_size for path in gone)
    require_space(folder, room, f"a batch of {n_missing:,} files")
    for path in gone:
        with explaining(path):
            path.unlink()
    manifest = Manifest(made, names, entries)
    manifest.write_journal(folder)
    return manifest


def _refuse_others(
    folder: Location, old: Manifest, outputs: Iterable[str], made: Mapping[str, Any]
) -> None:
    if old.made["by"] != made["by"]:
        raise OutputError(
            f"{folder} holds what `halfway {old.made['by']}` wrote: choose another folder with -o."
        )
    for name in outputs:
        if name not in old.names and (folder / name).exists():
            raise OutputError(
                f"{folder / name} is in the way: no manifest of halfway names it. "
                "Move it away, or choose another folder with -o."
            )
