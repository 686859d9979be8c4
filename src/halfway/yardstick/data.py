"""Libraries for measuring: every material as a table on one grid, in memory."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float32

from ..brdf import tabulate
from ..halfdiff import Grid
from ..library import Library, ProceduralLibrary
from ..tasks import HERE, Work

Values = Float32[np.ndarray, "3 N p"]
"""Of N materials on all cells of a grid, 1/sr; NaN where unmeasured."""


def gridded(library: Library, grid: Grid, *, work: Work = HERE) -> Library:
    """The materials of a library as tables on ``grid``."""
    tables = work.run(
        lambda name: tabulate(library.material(name), grid, name=name),
        library.names,
        label="Tables",
    )
    brdfs = dict(zip(library.names, tables, strict=True))
    return ProceduralLibrary(library.name, brdfs, grid=grid, origin=library.origin)


def part(library: Library, names: Sequence[str]) -> Library:
    """Some materials of a library, as a library of their own."""
    brdfs = {name: library.material(name) for name in names}
    return ProceduralLibrary(library.name, brdfs, grid=library.grid, origin=library.origin)


def values_of(library: Library) -> Values:
    """All samples."""
    return np.stack([library.row(i) for i in range(len(library))], axis=1)
