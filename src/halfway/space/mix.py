"""Mixing: the weighted sum of full tables that a recipe stands for.

    s = sum_i a_i s_i       per channel, over all cells (eq. 7)

A cell is unmeasured in the mix where it is unmeasured in any ingredient. The weights are those of a recipe, none
negative: a mix of sound materials is sound. The truncated PCA is something else: `Pca.reconstruct`.
"""

from collections import OrderedDict
from functools import partial
from threading import Lock
from typing import Any

import numpy as np

from .._types import Table
from ..brdf import TabularBrdf
from ..errors import LibraryError, RecipeError
from ..library import Library
from .recipe import Recipe

ROWS_AT_ONCE = 4
"""Rows that one pass of the kernel reads: the vertices of a simplex of the paper's three scores."""


class Mixer:
    """Mixes recipes of one library, keeping the rows it used last (`n_rows` of 17.5 MB each on the MERL grid)."""

    def __init__(self, library: Library, *, n_rows: int = 24) -> None:
        self._library = library
        self._rows: OrderedDict[str, Table] = OrderedDict()
        self._n_rows = n_rows
        self._lock = Lock()

    def __reduce__(self) -> tuple[Any, ...]:
        """A mixer travels without its rows."""
        return partial(Mixer, self._library, n_rows=self._n_rows), ()

    def mix(self, recipe: Recipe) -> TabularBrdf:
        """The table of a recipe.

        Raises
        ------
        RecipeError
            When the recipe names a material that the library does not have.
        """
        grid = self._library.grid
        rows = self._rows_of(recipe)
        values = np.empty((3, grid.size), np.float32)
        for out, channel, weights in zip(values, range(3), recipe.weights, strict=True):
            used = np.flatnonzero(weights)
            _weighted_sum(out, [rows[i][channel] for i in used], weights[used])
        return TabularBrdf(values.reshape(3, *grid.shape), grid, name=_title(recipe))

    def _rows_of(self, recipe: Recipe) -> list[Table]:
        with self._lock:
            rows = [self._row(name) for name in recipe.names]
            while len(self._rows) > max(self._n_rows, len(rows)):
                self._rows.popitem(last=False)
        return rows

    def _row(self, name: str) -> Table:
        if name not in self._rows:
            try:
                self._rows[name] = self._library.row(self._library.index(name))
            except LibraryError as error:
                raise RecipeError(str(error)) from None
        self._rows.move_to_end(name)
        return self._rows[name]


def mix(library: Library, recipe: Recipe) -> TabularBrdf:
    """The table of a recipe: the weighted sum of the library's full tables."""
    return Mixer(library).mix(recipe)


def _title(recipe: Recipe) -> str:
    return recipe.names[0] if len(recipe.names) == 1 else f"mix of {len(recipe.names)}"


def _weighted_sum(out: np.ndarray, rows: list[np.ndarray], weights: np.ndarray) -> None:
    from .kernel import add_four  # numba takes a second to load

    total = np.empty(len(out))
    for first in range(0, len(rows), ROWS_AT_ONCE):
        some = rows[first : first + ROWS_AT_ONCE]
        n_spare = ROWS_AT_ONCE - len(some)
        # The last row again, at weight 0: NaN stays NaN and everything else stays itself.
        a, b, c, d = some + some[-1:] * n_spare
        w = np.append(weights[first : first + ROWS_AT_ONCE], [0.0] * n_spare)
        add_four(total, a, b, c, d, w, first > 0)
    out[:] = total
