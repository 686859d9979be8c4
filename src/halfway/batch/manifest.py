"""What a folder of results holds: every file, what it is made of, and its checksum.

    manifest.json       of a finished folder
        {"format": 1,
         "made": {"by": "route", ...},      what made the files, all that they have in common
         "files": {"000.binary": {"of": {...}, "bytes": 34992012, "sha256": "..."}, ...}}

    manifest.jsonl      of one that is being written: JSON Lines
        {"format": 1, "made": {...}, "files": ["000.binary", ...]}          all that will be there
        {"file": "000.binary", "of": {...}, "bytes": 34992012, "sha256": "..."}     one line for each finished file

The first line is there before any file is, so every file that a killed run leaves is known to be ours. A file's line comes
after the file is whole under its final name; one whose line is missing is written again. Names are relative, with ``/``.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from ..errors import FormatError
from ..files import write_text
from ..locations import Location, name_in
from ..tasks import HERE, Work

FORMAT = 1
MANIFEST = "manifest.json"
JOURNAL = "manifest.jsonl"
_NO_MANIFEST = (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError)
"""What parsing anything else may raise: numbers beyond all bounds, and lists in lists in lists, too."""


class Checksum(NamedTuple):
    """Of the bytes of a file."""

    n_bytes: int
    sha256: str

    @classmethod
    def of(cls, path: Location) -> "Checksum":
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
            return cls(file.tell(), digest)


@dataclass(frozen=True)
class Entry:
    """One finished file."""

    of: Any
    """What it is made of, as JSON: a recipe, or a material and the file that it came from."""
    checksum: Checksum

    def to_json(self) -> dict[str, Any]:
        return {"of": self.of, "bytes": self.checksum.n_bytes, "sha256": self.checksum.sha256}


@dataclass(frozen=True)
class Manifest:
    """The files of a folder."""

    made: Mapping[str, Any]
    """What all files have in common: the command that made them, the library, the picture's settings."""
    names: frozenset[str] = frozenset()
    """Every file that belongs to the folder, finished or not."""
    entries: Mapping[str, Entry] = field(default_factory=dict[str, Entry])
    """The finished ones."""

    @classmethod
    def read(cls, folder: Location) -> "Manifest | None":
        """The folder's manifest; its journal where there is one; None where there is neither.

        Raises
        ------
        FormatError
            When the file is no manifest, or one of a newer format.
        """
        for path, parse in ((folder / JOURNAL, _parse_journal), (folder / MANIFEST, _parse)):
            try:
                return parse(path.read_text(encoding="utf-8"))
            except (FileNotFoundError, NotADirectoryError):
                continue
            except _NO_MANIFEST as error:
                raise FormatError(
                    f"{path} is no manifest of halfway, or of a newer version ({error}): "
                    f"expected format {FORMAT}. Choose another folder, or move this file away."
                ) from None
        return None

    @property
    def finished(self) -> bool:
        return self.names <= self.entries.keys()

    def write(self, folder: Location) -> None:
        """Write manifest.json; the journal that it was has no more to say."""
        files = {name: self.entries[name].to_json() for name in sorted(self.entries)}
        document = {"format": FORMAT, "made": self.made, "files": files}
        write_text(folder / MANIFEST, json.dumps(document, indent=1))
        (folder / JOURNAL).unlink(missing_ok=True)

    def write_journal(self, folder: Location) -> None:
        """Write manifest.jsonl, for `journal_line` to go on with, in place of manifest.json."""
        head = {"format": FORMAT, "made": self.made, "files": sorted(self.names)}
        lines = [json.dumps(head) + "\n"]
        lines += [journal_line(name, entry) for name, entry in self.entries.items()]
        write_text(folder / JOURNAL, "".join(lines))
        (folder / MANIFEST).unlink(missing_ok=True)


def journal_line(name: str, entry: Entry) -> str:
    """The line that says that a file is finished."""
    return json.dumps({"file": name, **entry.to_json()}) + "\n"


class Verdict(NamedTuple):
    """What a folder holds beside what its manifest says."""

    n_right: int
    missing: list[str]
    """Named by the manifest, and not there or not finished."""
    changed: list[str]
    """There, with other bytes."""
    foreign: list[str]
    """There, and not named by the manifest."""

    @property
    def ok(self) -> bool:
        return not (self.missing or self.changed or self.foreign)


def verify(folder: Location, *, work: Work = HERE) -> Verdict:
    """Read every file of a folder and compare it with the manifest.

    Raises
    ------
    FormatError
        When there is no folder, or it has no manifest.
    """
    if not folder.exists():
        raise FormatError(
            f"there is no folder {folder}: expected one that `halfway route` or `halfway render` wrote. See where you are."
        )
    manifest = Manifest.read(folder)
    if manifest is None:
        raise FormatError(
            f"{folder} has no {MANIFEST}: expected a folder that `halfway route` or `halfway render` wrote."
        )
    there = {name_in(folder, path) for path in folder.rglob("*") if path.is_file()}
    right = right_files(folder, manifest.entries, work=work)
    ours = manifest.names | {MANIFEST, JOURNAL}
    changed = (manifest.entries.keys() & there) - right
    return Verdict(
        len(right), sorted(manifest.names - right - changed), sorted(changed), sorted(there - ours)
    )


def right_files(folder: Location, entries: Mapping[str, Entry], *, work: Work = HERE) -> set[str]:
    """The names of those entries whose files have the bytes that they had when they were finished."""
    names = list(entries)
    checks = work.run(partial(_is_right, folder, entries), names, label="Checking")
    return {name for name, right in zip(names, checks, strict=True) if right}


def _is_right(folder: Location, entries: Mapping[str, Entry], name: str) -> bool:
    path, checksum = folder / name, entries[name].checksum
    try:
        return path.stat().st_size == checksum.n_bytes and Checksum.of(path) == checksum
    except OSError:
        return False


def _parse(text: str) -> Manifest:
    document = json.loads(text)
    entries = {_name(name): _entry(entry) for name, entry in document["files"].items()}
    return Manifest(_made(document), frozenset(entries), entries)


def _parse_journal(text: str) -> Manifest:
    first, *lines = text.splitlines()
    head = json.loads(first)
    entries = {_name(entry["file"]): _entry(entry) for entry in _whole_lines(lines)}
    return Manifest(_made(head), frozenset(map(_name, head["files"])), entries)


def _whole_lines(lines: Iterable[str]) -> Iterable[Any]:
    """The lines up to one that is cut, as a full disk leaves it."""
    for line in lines:
        try:
            yield json.loads(line)
        except ValueError:
            return


def _made(document: Any) -> Mapping[str, Any]:
    if document["format"] != FORMAT:
        raise ValueError(f"format {document['format']}")
    made = document["made"]
    if not isinstance(made["by"], str):
        raise TypeError(f"made by {made['by']!r}")
    return made


def _entry(document: Mapping[str, Any]) -> Entry:
    return Entry(document["of"], Checksum(int(document["bytes"]), str(document["sha256"])))


def _name(name: str) -> str:
    """A name that cannot leave the folder: files that a manifest names may be replaced."""
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts or not path.parts:
        raise ValueError(f"the name {name!r}")
    return name
