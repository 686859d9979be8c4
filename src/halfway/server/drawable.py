"""On which grid the page draws the tables of a library."""

from dataclasses import replace

from ..brdf import TabularBrdf, tabulate
from ..halfdiff import MERL, Grid
from ..library import Library

MAX_BYTES = 64e6
"""Of one table on a graphics card; the usual grid with phi_h takes 44 MB in a whole turn."""
BYTES_A_CELL = 8
"""Of RGBA in half floats."""


def drawn_grid(grid: Grid) -> Grid:
    """The grid itself; where a table on it takes more than `MAX_BYTES`, no more cells along each axis than the usual grid has."""
    if bytes_on_card(grid) <= MAX_BYTES:
        return grid
    usual = MERL if grid.is_isotropic else Grid.anisotropic(period=grid.axis("phi_h").stop)
    sizes = {axis.angle: axis.size for axis in usual.axes}
    return Grid(tuple(replace(axis, size=min(axis.size, sizes[axis.angle])) for axis in grid.axes))


def bytes_on_card(grid: Grid) -> int:
    """What one table takes on a graphics card."""
    return BYTES_A_CELL * grid.size


def drawn(table: TabularBrdf) -> TabularBrdf:
    """The table on the grid on which it is drawn."""
    grid = drawn_grid(table.grid)
    return table if grid == table.grid else tabulate(table, grid, name=table.name)


def coarsened(library: Library) -> str:
    """One line where the page draws coarser tables than the library has, else nothing."""
    grid = drawn_grid(library.grid)
    if grid == library.grid:
        return ""
    return (
        f"{library.name} has tables of {library.grid} cells, {bytes_on_card(library.grid) / 1e6:.0f} MB each on a graphics card: "
        f"the picture and the plots are made of {grid}. What you take home, and `halfway render`, have all."
    )
