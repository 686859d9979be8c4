"""How the cells of a table lie in memory, told by which of them are unmeasured.

No direction below the horizon can be measured, so the unmeasured cells of a table draw its horizon,

    cos theta_h cos theta_d = sin theta_h sin theta_d |cos phi_d|

which looks different on every grid. Where they draw that of another grid than the one a file states, the table is on the
other: its sizes in another order, its axes in another order, an axis written twice, phi_d over a whole turn (half a turn is
enough, by reciprocity), theta_h evenly spaced.

A cell that the horizon cuts may be measured or not, and tells nothing.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from itertools import permutations
from typing import NamedTuple

import numpy as np

from .._types import Mask, Table
from ..halfdiff import Axis, Grid

MASK_TOLERANCE = 0.01
"""Share of a table's cells that may be unmeasured above the horizon or measured below it."""

_LEAST_VALUES = 8  # fewer may come again by chance
_LEAST_CELLS = 8


class Horizon(NamedTuple):
    """The cells of a grid by where their directions are; the horizon cuts those in neither."""

    above: Mask
    """Both directions are above the horizon, wherever in the cell."""
    below: Mask
    """One of them is below it, wherever in the cell."""


class Layout(NamedTuple):
    """One way in which an array of cells is a table."""

    shape: tuple[int, ...]
    """Of the array, slowest axis first."""
    periods: tuple[int, ...]
    """How many cells of each axis differ; after that they are written again."""
    order: tuple[int, ...]
    """Which axes of the array the grid's are."""
    grid: Grid

    @property
    def is_plain(self) -> bool:
        """Whether the cells lie as those of `grid` do."""
        plain = tuple(range(len(self.order)))
        return self.shape == self.periods == self.grid.shape and self.order == plain

    def of(self, cells: np.ndarray) -> np.ndarray:
        """The cells on `grid`: of a table, shape (3, *grid.shape), or of a mask, shape (1, *grid.shape); no copy if plain."""
        kept = cells.reshape(-1, *self.shape)[:, *(slice(period) for period in self.periods)]
        return np.ascontiguousarray(kept.transpose(0, *(1 + i for i in self.order)))

    def __str__(self) -> str:
        names = [axis.angle for axis in self.grid.axes]
        words = [f"{self.grid} cells"]
        if self.order != (0, 1, 2):
            words.append(
                f"stored in the order {', '.join(names[self.order.index(i)] for i in range(3))}"
            )
        for name, i in zip(names, self.order, strict=True):
            if self.periods[i] < self.shape[i]:
                words.append(f"{name} written {self.shape[i] // self.periods[i]} times")
        if self.grid != Grid.merl(*self.grid.shape):
            evenly = self.grid.axes[0].power == 1
            words.append("theta_h evenly spaced" if evenly else "phi_d over a whole turn")
        return ", ".join(words)


@lru_cache(maxsize=8)
def horizon(grid: Grid) -> Horizon:
    """What is above and below the horizon: read-only masks of shape `grid.shape`."""
    low, high = (_lower_cosine(grid, end) for end in (0, 1))
    masks = Horizon(np.array(high > 0), np.array(low <= 0))
    for mask in masks:
        mask.flags.writeable = False
    return masks


def layout_of(values: Table, grid: Grid) -> Layout:
    """The order of the axes of an array, and their sizes: those of ``grid``, unless its unmeasured cells fit one other alone.

    On a grid of another kind than a MERL file's, those of ``grid`` in any case.
    """
    if len(grid.axes) != 3 or grid != Grid.merl(*grid.shape):
        return Layout(grid.shape, grid.shape, tuple(range(len(grid.axes))), grid)
    stated = _stated(values, grid)
    unmeasured = _unmeasured(values)
    error = _error(stated, unmeasured)
    if error <= MASK_TOLERANCE or not unmeasured.any() or unmeasured.all():
        return stated
    errors = {other: _error(other, unmeasured) for other in _others(values, grid)}
    least = min(errors.values())
    best, *as_good = (other for other, its_error in errors.items() if its_error == least)
    # On few cells several grids look alike, or one by chance.
    alone = not as_good and unmeasured.size * (error - least) >= _LEAST_CELLS
    return best if alone and least <= min(2 * MASK_TOLERANCE, error / 2) else stated


def _stated(values: Table, grid: Grid) -> Layout:
    """The array's own grid; an axis that is written twice counts once."""
    periods = tuple(_period(values, 1 + i) for i in range(3))
    axes = (replace(axis, size=n) for axis, n in zip(grid.axes, periods, strict=True))
    return Layout(grid.shape, periods, (0, 1, 2), Grid(tuple(axes)))


def _others(values: Table, grid: Grid) -> Iterator[Layout]:
    for shape in _shapes(grid.shape):
        cells = values.reshape(3, *shape)
        periods = tuple(_period(cells, 1 + i) for i in range(3))
        for order in permutations(range(3)):
            theta_h, theta_d, phi_d = Grid.merl(*(periods[i] for i in order)).axes
            whole_turn = replace(phi_d, stop=2 * np.pi)
            yield Layout(shape, periods, order, Grid((theta_h, theta_d, phi_d)))
            yield Layout(shape, periods, order, Grid((theta_h, theta_d, whole_turn)))
            if order == (
                0,
                1,
                2,
            ):  # theta_h and theta_d cannot be told apart where both are evenly spaced
                evenly = replace(theta_h, power=1)
                yield Layout(shape, periods, order, Grid((evenly, theta_d, phi_d)))


def _shapes(shape: tuple[int, ...]) -> list[tuple[int, ...]]:
    """The shape itself, its sizes in other orders, and those that are in proportion as the database's."""
    shapes = dict.fromkeys([shape, *permutations(shape)])
    size = int(np.prod(shape))
    for turns in (1, 2):
        n = round((size / (2 * turns)) ** (1 / 3))
        if 2 * turns * n**3 == size:
            shapes[n, n, 2 * turns * n] = None
    return list(shapes)


def _unmeasured(values: Table) -> Mask:
    """What is unmeasured in all channels; what is 0 in all of them where nothing is."""
    unmeasured = np.asarray(np.isnan(values).all(axis=0))
    return unmeasured if unmeasured.any() else np.asarray((values == 0).all(axis=0))


def _error(layout: Layout, unmeasured: Mask) -> float:
    """Share of the cells that are unmeasured with their centre above the horizon, or measured with it below."""
    return float((layout.of(unmeasured)[0] == layout.grid.mask()).mean())


def _period(cells: np.ndarray, axis: int) -> int:
    """The cells along an axis after which all come again; its size where they do not, or where all are the same."""
    n = cells.shape[axis]
    cells = np.moveaxis(cells, axis, 0).view(np.uint32)  # by their bits, NaN as well
    periods = (period for period in range(1, n // 2 + 1) if n % period == 0)
    least = next((period for period in periods if _repeats(cells, period)), n)
    few = least < n and len(np.unique(cells[:least])) < _LEAST_VALUES
    return n if few or least == 1 else least


def _repeats(cells: np.ndarray, period: int) -> bool:
    few = cells[:, :, ::8, ::8]  # most often they differ already
    return np.array_equal(few[0], few[period]) and np.array_equal(cells[:-period], cells[period:])


def _lower_cosine(grid: Grid, end: int) -> np.ndarray:
    """Cosine of the lower direction in each cell, where it is highest (``end`` 0) or lowest (1)."""
    at: dict[str, np.ndarray | float] = {"theta_h": 0.0, "theta_d": 0.0, "phi_d": 1.0}
    for i, axis in enumerate(grid.axes):
        along = [1] * len(grid.axes)
        along[i] = axis.size
        at[axis.angle] = _ends(axis)[end].reshape(along)
    theta_h, theta_d, turned = at["theta_h"], at["theta_d"], at["phi_d"]
    cosine = np.cos(theta_h) * np.cos(theta_d) - np.sin(theta_h) * np.sin(theta_d) * turned
    return np.broadcast_to(cosine, grid.shape)


def _ends(axis: Axis) -> tuple[np.ndarray, np.ndarray]:
    """What decides of a cell, from its highest to its lowest direction: theta, or |cos phi_d|."""
    if axis.angle != "phi_d":
        return axis.edges()[:-1], axis.edges()[1:]
    # Quarters of a cell: the ends of |cos| lie there, whatever the axis's size.
    quarters = np.arange(axis.size)[:, None] + np.arange(5) / 4
    turned = np.abs(np.cos(axis.to_angle(quarters)))
    return turned.min(axis=1), turned.max(axis=1)
