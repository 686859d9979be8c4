"""What every library can do.

A library is a set of N materials on one grid of p cells (the paper's "basis of materials"):

    names           N names, in the library's order
    row(i)          all samples of one material, (3, p)
    blocks()        column ranges that are cheap to read, together all p
    columns(range)  the samples of all materials on one range, (3, N, n)

There are three kinds behind this interface: *stored* on disk, *procedural*, computed when asked for, and *compact*,
reconstructed from principal components.
"""

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import asdict
from difflib import get_close_matches
from functools import lru_cache, partial
from shlex import quote
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float32

from .._types import Table
from ..brdf import Brdf, TabularBrdf
from ..errors import LibraryError
from ..formats import SourceBrdf
from ..halfdiff import Grid
from ..locations import Location, absolute
from ..origin import Origin
from ..tasks import HERE, Work


class LibraryRef(NamedTuple):
    """Which library: what a recipe, a space or a route knows of the one that it is of."""

    name: str
    address: str = ""
    """What `open_library` finds it by; the name where it is not known."""
    checksum: str = ""
    """Of the library as it was; empty where it is not known."""

    @classmethod
    def of(cls, library: "str | LibraryRef | Library") -> "LibraryRef":
        """The reference to a library, which may be given by its name alone."""
        if isinstance(library, Library):
            return cls(library.name, library.address, library.checksum)
        return cls(library) if isinstance(library, str) else library


class Streamed(ABC):
    """N rows of samples on one grid, in one or more channels, read a block of columns at a time.

    What principal components are made of: a library, or something computed from one.
    """

    n_channels = 3
    """Colour channels, each analysed by itself."""
    name: str
    names: tuple[str, ...]
    grid: Grid
    checksum: str
    """Hex digits that change when any sample, name or the grid changes."""
    material_checksums: tuple[str, ...]
    """Of each row alone: hex digits that change when its name, a sample of it, or the grid changes."""

    @abstractmethod
    def columns(self, columns: slice) -> Float32[np.ndarray, "n_channels N n"]:
        """Samples of all rows on one of the ranges of `blocks`."""

    @abstractmethod
    def blocks(self) -> list[slice]:
        """Ranges of columns that together cover the grid once."""

    def __len__(self) -> int:
        return len(self.names)


class Verdict(NamedTuple):
    """What reading a library again found; names in its order."""

    n_right: int
    """Materials whose samples have the checksum that they were written with."""
    damaged: tuple[str, ...] = ()
    """Materials whose samples have another."""
    changed: tuple[str, ...] = ()
    """Materials whose source is there and has changed since; the library holds what it was."""

    @property
    def ok(self) -> bool:
        return not self.damaged


class Library(Streamed):
    """A set of materials on one grid."""

    origin: Origin

    @property
    def address(self) -> str:
        """What `open_library` finds it by, from any folder of this machine."""
        return self.name

    @abstractmethod
    def row(self, i: int) -> Table:
        """All samples of material ``i``, shape (3, p), float32, 1/sr; NaN where unmeasured. The caller owns it."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r}: {len(self)} materials on {self.grid}>"

    def facts(self) -> dict[str, Any]:
        """What it is, in JSON for programs."""
        return {
            "library": self.name,
            "grid": list(self.grid.shape),
            **asdict(self.origin),
            "checksum": self.checksum,
            "materials": list(self.names),
        }

    def storage(self) -> list[str]:
        """How it is stored and what that loses, for people; nothing where samples are what they were."""
        return []

    def verify(self, *, work: Work = HERE) -> Verdict:  # noqa: ARG002
        """Read all samples again and compare them with their checksums, and the sources that are still there.

        Raises
        ------
        LibraryError
            When the library is computed and has nothing that could be damaged, or is damaged as a whole.
        """
        raise LibraryError(
            f"{self.name} is computed when asked for: expected a .brdflib folder or a .brdfc file, which may be damaged."
        )

    def materials(self) -> list[SourceBrdf]:
        """Its materials, to build another library of."""
        return [
            SourceBrdf(
                name, source, self.grid, self.origin, partial(self.brdf, name), partial(str, sha256)
            )
            for name, (source, sha256) in zip(self.names, self._sources(), strict=True)
        ]

    def _sources(self) -> list[tuple[str, str]]:
        """Where each material is from, and the checksum that it has there."""
        return [(self.name, checksum) for checksum in self.material_checksums]

    def index(self, name: str) -> int:
        """Position of the material called ``name``.

        Raises
        ------
        LibraryError
            When there is none; the message names the nearest spellings.
        """
        try:
            return self.names.index(name)
        except ValueError:
            near = get_close_matches(name, self.names, n=3, cutoff=0.5)
            hint = f"did you mean {', '.join(near)}?" if near else f"such as {self.names[0]}."
            raise LibraryError(
                f"{name!r} is not one of the {len(self)} materials of {self.name}: {hint} "
                f"`halfway library info {quote(self.address)}` lists them."
            ) from None

    def material(self, name: str) -> Brdf:
        """The material called ``name`` as the library keeps it: its table, or the formula that a table is computed by."""
        return self.brdf(name)

    def brdf(self, name: str) -> TabularBrdf:
        """The table of the material called ``name``."""
        values = self.row(self.index(name)).reshape(3, *self.grid.shape)
        return TabularBrdf(values, self.grid, name=name)


class FileLibrary(Library):
    """A library that travels between processes as its path."""

    path: Location

    @property
    def address(self) -> str:
        return str(absolute(self.path))

    def __reduce__(self) -> tuple[Any, ...]:
        return _opened, (type(self), absolute(self.path), self.checksum)


@lru_cache(maxsize=2)
def _opened(kind: Any, path: Location, checksum: str) -> Library:
    """The library that another process means; the last two stay open, a compact one with its numbers."""
    library = kind(path)
    if library.checksum != checksum:
        raise LibraryError(
            f"{path} has checksum {library.checksum[:12]} here and {checksum[:12]} where the work began: it was made "
            "again, or is another on this machine. Run the same command again."
        )
    return library


def texts(fields: Mapping[str, Any]) -> Mapping[str, str]:
    """The fields of an object in a file, which are all text; a TypeError says which is not."""
    for key, value in fields.items():
        if not isinstance(value, str):
            raise TypeError(f"{key} is {value!r}, and no text")
    return fields


def material_checksum(name: str, grid: Grid, content: bytes) -> str:
    """The checksum of one material, whose samples ``content`` stands for."""
    return hashlib.sha256(repr((name, grid)).encode() + b"\0" + content).hexdigest()[:32]
