"""Whether a library on disk still holds what it was built of."""

import hashlib
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

from ..errors import HalfwayError, LibraryError
from ..tasks import HERE, Work
from .building import find_materials
from .compact import CompactLibrary
from .library import Library
from .stored import Entry, StoredLibrary


class Verdict(NamedTuple):
    """What reading a library again found; names in its order."""

    n_right: int
    """Materials whose samples have the checksum that they were written with."""
    damaged: list[str]
    """Materials whose samples have another."""
    changed: list[str]
    """Materials whose source is there and has changed since; the library holds what it was."""

    @property
    def ok(self) -> bool:
        return not self.damaged


def verify_library(library: Library, *, work: Work = HERE) -> Verdict:
    """Read all samples of ``library`` again, and those of its sources that are still there.

    A compact library has one checksum, and is right as a whole.

    Raises
    ------
    LibraryError
        When a compact library is damaged, or the library is computed and has nothing that could be.
    """
    if isinstance(library, CompactLibrary):
        library.row(0)
        return Verdict(len(library), [], [])
    if not isinstance(library, StoredLibrary):
        raise LibraryError(
            f"{library.name} is computed when asked for: expected a .brdflib folder or a .brdfc file, which may be damaged."
        )
    check = partial(_is_right, library)
    right = list(work.run(check, range(len(library)), label="Samples"))
    sources = list(dict.fromkeys(filter(None, map(_file, library.entries))))
    found = list(work.run(_checksums, sources, label="Sources"))
    now = dict(zip(sources, found, strict=True))
    return Verdict(
        sum(right),
        [name for name, is_right in zip(library.names, right, strict=True) if not is_right],
        [entry.name for entry in library.entries if _has_changed(entry, now)],
    )


def _is_right(library: StoredLibrary, i: int) -> bool:
    return hashlib.sha256(library.row(i).data).hexdigest() == library.entries[i].sha256


def _file(entry: Entry) -> str | None:
    """The file that a material came from, if it is there; a member of a zip is called ``archive.zip:member``."""
    files = map(Path, (entry.source, entry.source.rpartition(":")[0]))
    # Workers may be in another folder.
    return next((str(file.absolute()) for file in files if file.is_file()), None)


def _checksums(source: str) -> dict[str, str]:
    """Of the materials in a file, by name; none where it is no BRDF any more."""
    try:
        return {item.name: item.sha256 for item in find_materials([source])[0]}
    except HalfwayError:
        return {}


def _has_changed(entry: Entry, now: Mapping[str, Mapping[str, str]]) -> bool:
    source = _file(entry)
    return (
        source is not None and source in now and now[source].get(entry.name) != entry.source_sha256
    )
