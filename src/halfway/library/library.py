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
from dataclasses import dataclass
from difflib import get_close_matches
from shlex import quote
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float32

from .._types import Table
from ..brdf import TabularBrdf
from ..errors import LibraryError
from ..halfdiff import Grid


@dataclass(frozen=True)
class Origin:
    """Where the materials come from, for people."""

    description: str = ""
    """One line; says "stand-in" where the materials are fits and not measurements."""
    source: str = ""
    licence: str = ""


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

    def brdf(self, name: str) -> TabularBrdf:
        """The table of the material called ``name``."""
        values = self.row(self.index(name)).reshape(3, *self.grid.shape)
        return TabularBrdf(values, self.grid, name=name)


def texts(fields: Mapping[str, Any]) -> Mapping[str, str]:
    """The fields of an object in a file, which are all text.

    Raises
    ------
    TypeError
        When one is not.
    """
    for key, value in fields.items():
        if not isinstance(value, str):
            raise TypeError(f"{key} is {value!r}, and no text")
    return fields


def material_checksum(name: str, grid: Grid, content: bytes) -> str:
    """The checksum of one material, whose samples ``content`` stands for."""
    return hashlib.sha256(repr((name, grid)).encode() + b"\0" + content).hexdigest()[:32]
