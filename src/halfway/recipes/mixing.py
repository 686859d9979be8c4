"""Mixing: the weighted sum of full tables that a recipe stands for.

    s = sum_i a_i s_i       per channel, over all cells (eq. 7)

A cell is unmeasured in the mix where it is unmeasured in any ingredient. The weights are those of a recipe, none
negative: a mix of sound materials is sound. The truncated PCA is something else: `Pca.reconstruct`.
"""

from collections.abc import Mapping
from functools import lru_cache, partial
from threading import Lock
from typing import Any

import numpy as np

from .._types import Table
from ..brdf import TabularBrdf, require_isotropic
from ..errors import LibraryError, RecipeError
from ..library import Library, open_library
from .blend import Blend
from .recipe import Recipe

N_AT_ONCE = 8
"""Mixes that numpy sums: compiled code is twice as fast, and takes a second to load."""
_CHUNK = 1 << 15  # samples summed at once: the float64 sums stay in a core's cache


class Mixer:
    """Mixes recipes of one library, keeping the rows it used last (`n_rows` of 17.5 MB each on the MERL grid)."""

    def __init__(self, library: Library, *, n_rows: int = 24) -> None:
        require_isotropic(library.grid, "a mix", name=library.name)
        self._library = library
        self._n_rows = n_rows
        # Not of a method: a mixer that is done with shall go at once, with its rows.
        self._row = lru_cache(n_rows)(partial(_row, library))
        self._lock = Lock()  # threads that want the same row compute it once
        self._n_mixed = 0

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
        with self._lock:
            rows = [self._row(name) for name in recipe.names]
        values = np.empty((3, grid.size), np.float32)
        self._n_mixed += 1
        sum_of = _weighted_sum if self._n_mixed > N_AT_ONCE else _plain_sum
        match recipe.blend:
            case Blend.LINEAR:
                for out, channel, weights in zip(values, range(3), recipe.weights, strict=True):
                    used = np.flatnonzero(weights)
                    sum_of(out, [rows[i][channel] for i in used], weights[used])
        return TabularBrdf(values.reshape(3, *grid.shape), grid, name=_title(recipe))


def mix(library: Library | str, recipe: Recipe | Mapping[str, Any] | str) -> TabularBrdf:
    """The table of a recipe, mixed from full tables of the library.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    recipe : Recipe, mapping or str
        Or its weights: ``{"gold-paint": 0.7, "teflon": 0.3}``, ``"gold-paint=0.7, teflon=0.3"``.

    Examples
    --------
    >>> import halfway
    >>> table = halfway.mix("builtin:merl-abc", "gold-paint=0.7, teflon=0.3")
    >>> table.name
    'mix of 2'

    Raises
    ------
    RecipeError
        When the weights are no recipe, or of a material that the library does not have.
    """
    opened = open_library(library) if isinstance(library, str) else library
    return Mixer(opened).mix(_to_recipe(opened, recipe))


def _to_recipe(library: Library, recipe: Recipe | Mapping[str, Any] | str) -> Recipe:
    match recipe:
        case Recipe():
            return recipe
        case str():
            return Recipe.from_text(library, recipe)
        case _:
            return Recipe.of(library, recipe)


def _row(library: Library, name: str) -> Table:
    try:
        return library.row(library.index(name))
    except LibraryError as error:
        raise RecipeError(str(error)) from None


def _title(recipe: Recipe) -> str:
    return recipe.names[0] if len(recipe.names) == 1 else f"mix of {len(recipe.names)}"


def _plain_sum(out: np.ndarray, rows: list[np.ndarray], weights: np.ndarray) -> None:
    """`_weighted_sum` in numpy: the same sums in the same order."""
    for start in range(0, len(out), _CHUNK):
        part = slice(start, start + _CHUNK)
        out[part] = _sum_of_parts([row[part] for row in rows], weights)


def _sum_of_parts(rows: list[np.ndarray], weights: np.ndarray) -> np.ndarray:
    n = len(rows)
    if n > 4:
        half = n // 2 if n > 8 else 4
        return _sum_of_parts(rows[:half], weights[:half]) + _sum_of_parts(
            rows[half:], weights[half:]
        )
    total = np.multiply(rows[0], weights[0], dtype=np.float64)
    for row, weight in zip(rows[1:], weights[1:], strict=True):
        total += np.multiply(row, weight, dtype=np.float64)
    return total


def _weighted_sum(out: np.ndarray, rows: list[np.ndarray], weights: np.ndarray) -> None:
    from .kernel import sum_eight, sum_four  # numba takes a second to load

    if len(rows) > 8:
        half = len(rows) // 2
        low, high = np.empty((2, len(out)))
        _weighted_sum(low, rows[:half], weights[:half])
        _weighted_sum(high, rows[half:], weights[half:])
        np.add(low, high, out=out, casting="same_kind")
        return
    n = 4 if len(rows) <= 4 else 8
    # The last row again, at weight 0: NaN stays NaN and everything else stays itself.
    padded = rows + rows[-1:] * (n - len(rows))
    arguments = [out, *padded, np.append(weights, np.zeros(n - len(rows)))]
    if n == 4:
        sum_four(*arguments)
    else:
        sum_eight(*arguments)
