"""Some materials of a library, as a library of their own: what a static explorer carries."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .._types import Rows, Table
from ..brdf.image_metrics import appearance, cielab_difference
from ..errors import LibraryError
from .basis import BasisImages
from .blocks import ranges
from .library import Library

BLOCK_BYTES = 1.5e8
"""How many bytes of float32 a block holds: eight materials on the MERL grid are one."""
THINNING = 4
"""Every so many pixels of the basis images are enough to choose by."""


class Subset(Library):
    """The materials called ``names`` of ``library``, in its order and under its name: their recipes are recipes of it.

    Raises
    ------
    LibraryError
        When the library has no material of a name.
    """

    def __new__(cls, *_: Any, **__: Any) -> "Subset":
        # Not one of the libraries in use: who looks for one by its name means the whole.
        return object.__new__(cls)

    def __init__(self, library: Library, names: Sequence[str]) -> None:
        self._library = library
        self._indices = sorted({library.index(name) for name in names})
        if len(self._indices) < 2:
            raise LibraryError(
                f"{len(self._indices)} material of {library.name} makes no space: name at least two."
            )
        self.name = library.name
        self.names = tuple(library.names[i] for i in self._indices)
        self.grid = library.grid
        self.origin = replace(
            library.origin,
            description=f"{len(self.names)} of {len(library)} materials; {library.origin.description}",
        )
        self.checksum = hashlib.sha256(repr((library.checksum, self.names)).encode()).hexdigest()
        self.material_checksums = tuple(library.material_checksums[i] for i in self._indices)

    def row(self, i: int) -> Table:
        return self._library.row(self._indices[i])

    def columns(self, columns: slice) -> Rows:
        # Of these materials alone: the library's own columns would be computed of all.
        return np.stack([self.row(i)[:, columns] for i in range(len(self))], axis=1)

    def blocks(self) -> list[slice]:
        # Few and wide, since every block takes whole rows.
        return ranges(self.grid.size, max(1, int(BLOCK_BYTES / (12 * len(self)))))


def most_different(images: BasisImages, n: int) -> list[str]:
    """The names of ``n`` materials that look as different as can be, in the library's order.

    First the one that looks least like the mean of all, then each time the one that is farthest from those chosen: mean
    CIELAB difference on the lit sphere of ``images``.

    Reference: T. F. Gonzalez, "Clustering to Minimize the Maximum Intercluster Distance", Theoretical Computer Science 38,
    1985.

    Raises
    ------
    LibraryError
        When the library has fewer than ``n``, or ``n`` is less than 2.
    """
    if not 2 <= n <= len(images.names):
        raise LibraryError(
            f"{n} materials cannot be chosen: expected 2 to {len(images.names)}, which is all there are."
        )
    looks = appearance(images.images[:, ::THINNING])
    distance = cielab_difference(looks, looks.mean(axis=0))
    chosen: list[int] = []
    for _ in range(n):
        chosen.append(int(np.argmax(distance)))
        to_chosen = cielab_difference(looks, looks[chosen[-1]])
        distance = to_chosen if len(chosen) == 1 else np.minimum(distance, to_chosen)
    return [images.names[i] for i in sorted(chosen)]
