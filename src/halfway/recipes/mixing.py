"""Mixing: the weighted mean of full tables that a recipe stands for.

    s = m^-1( sum_i a_i m(s_i) )       per channel, over all cells (eq. 7, where m is the identity)

A cell is unmeasured in the mix where it is unmeasured in any ingredient. The weights are those of a recipe, none
negative: a mix of sound materials is sound. The truncated PCA is something else: `Pca.reconstruct`.

Where a blend aligns, each ingredient's gloss is first stretched to one width (`halfway.brdf.gloss`), the weighted geometric
mean of their widths, so that a highlight narrows by equal factors for equal weights. A stretched gloss can reflect more than it did from some direction. So where the mix would reflect more
than 1, and more than any of its ingredients does from there, the channel is scaled down to that.

Last, the body of the mix is multiplied by what the recipe says (`halfway.recipes.body`).
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache, partial
from threading import Lock
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Table
from ..brdf import TabularBrdf, albedos, gloss
from ..errors import LibraryError, RecipeError
from ..halfdiff import MERL
from ..library import Library, open_library
from .aligned import aligned_mean
from .blend import Blend
from .blend import Mapping as BlendMapping
from .body import LIMITED_AT, with_body
from .recipe import Recipe

N_AT_ONCE = 8
"""Mixes that numpy sums: compiled code is twice as fast, and takes a second to load."""
KEPT_BYTES = 24 * 12 * MERL.size
"""Of the rows that a mixer keeps, or `LEAST_ROWS` where they are larger: as many as a recipe has."""
LEAST_ROWS = 8
_CHUNK = 1 << 15  # samples summed at once: the sums stay in a core's cache


class Mixer:
    """Mixes recipes of one library, keeping the rows it used last (24 of 17.5 MB each on the MERL grid).

    ``compiles``: whether loops may be compiled once that pays; where there is no numba they may not.
    """

    def __init__(
        self, library: Library, *, n_rows: int | None = None, compiles: bool = True
    ) -> None:
        n_rows = n_rows or max(LEAST_ROWS, int(KEPT_BYTES / (12 * library.grid.size)))
        self._library = library
        self._n_rows, self._compiles = n_rows, compiles
        # Not of a method: a mixer that is done with shall go at once, with its rows.
        self._row = lru_cache(n_rows)(partial(_row, library))
        # A body is as large as a row, and what a gloss has above its foot half as large.
        self._parts = lru_cache(max(1, 2 * n_rows // 3))(partial(_Parts.of, library))
        self._lock = Lock()  # threads that want the same row compute it once
        self._n_mixed = 0

    def __reduce__(self) -> tuple[Any, ...]:
        """A mixer travels without its rows."""
        return partial(Mixer, self._library, n_rows=self._n_rows, compiles=self._compiles), ()

    def mix(self, recipe: Recipe) -> TabularBrdf:
        """The table of a recipe.

        Raises
        ------
        RecipeError
            When the recipe names a material that the library does not have.
        """
        grid = self._library.grid
        mixed = self._aligned(recipe) if _aligns(recipe) else self._pointwise(recipe)
        values = with_body(mixed, recipe.body_scale, grid)
        return TabularBrdf(values.reshape(3, *grid.shape), grid, name=_title(recipe))

    def _pointwise(self, recipe: Recipe) -> Table:
        is_alone = len(recipe.names) == 1
        mapping = Blend.LINEAR.mapping if is_alone else recipe.blend.mapping
        with self._lock:
            # Mapped once: a logarithm takes as long as the whole sum.
            rows = [self._row(name, mapping) for name in recipe.names]
        if is_alone:
            return rows[0]
        values = np.empty_like(rows[0])
        self._n_mixed += 1
        mean = _weighted_sum if self._compiling() else _plain_sum
        for out, channel, weights in zip(values, range(3), recipe.weights, strict=True):
            used = np.flatnonzero(weights)
            mean(out, [rows[i][channel] for i in used], weights[used])
            if mapping is not Blend.LINEAR.mapping:
                mapping.back(out, out=out)
        return values

    def _aligned(self, recipe: Recipe) -> Table:
        with self._lock:
            parts = [self._parts(name) for name in recipe.names]
        grid = self._library.grid
        mapping = recipe.blend.mapping
        self._n_mixed += 1
        values = aligned_mean(
            [part.lobes for part in parts],
            recipe.weights,
            mapping,
            grid,
            compiled=self._compiling(),
        )
        table = TabularBrdf(values.reshape(3, *grid.shape), grid)
        limit = np.maximum(1, np.max([part.albedos for part in parts], axis=0))
        share = np.min(limit / np.maximum(albedos(table, LIMITED_AT), limit), axis=0)
        return values * share.astype(np.float32)[:, None] if (share < 1).any() else values

    def _compiling(self) -> bool:
        return self._compiles and self._n_mixed > N_AT_ONCE


class _Parts(NamedTuple):
    """What a blend that aligns takes of a material."""

    lobes: gloss.Gloss
    albedos: Float64[np.ndarray, "n_angles 3"]

    @classmethod
    def of(cls, library: Library, name: str) -> "_Parts":
        row = _row(library, name)
        table = TabularBrdf(row.reshape(3, *library.grid.shape), library.grid)
        return cls(gloss.Gloss.of(row, library.grid), albedos(table, LIMITED_AT))


def mix(
    library: Library | str,
    recipe: Recipe | Mapping[str, Any] | str,
    *,
    blend: Blend | str = Blend.LINEAR,
) -> TabularBrdf:
    """The table of a recipe, mixed from full tables of the library.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    recipe : Recipe, mapping or str
        Or its weights: ``{"gold-paint": 0.7, "teflon": 0.3}``, ``"gold-paint=0.7, teflon=0.3"``.
    blend : Blend or str
        How weights are mixed; a recipe says so itself.

    Examples
    --------
    >>> import halfway
    >>> table = halfway.mix("builtin:merl-abc", "gold-paint=0.7, teflon=0.3")
    >>> table.name
    'mix of 2'

    Raises
    ------
    RecipeError
        When the weights are no recipe, or of a material that the library does not have; or there is no such blend.
    """
    opened = open_library(library)
    return Mixer(opened).mix(_to_recipe(opened, recipe, Blend(blend)))


def _aligns(recipe: Recipe) -> bool:
    return recipe.blend.aligns and len(recipe.names) > 1


def _to_recipe(library: Library, recipe: Recipe | Mapping[str, Any] | str, blend: Blend) -> Recipe:
    match recipe:
        case Recipe():
            return recipe
        case str():
            return replace(Recipe.from_text(library, recipe), blend=blend)
        case _:
            return Recipe.of(library, recipe, blend)


def _row(library: Library, name: str, mapping: BlendMapping = Blend.LINEAR.mapping) -> Table:
    """The samples of a material, mapped."""
    try:
        row = library.row(library.index(name))
    except LibraryError as error:
        raise RecipeError(str(error)) from None
    return row if mapping is Blend.LINEAR.mapping else mapping.to(row)


def _title(recipe: Recipe) -> str:
    return recipe.material or f"mix of {len(recipe.names)}"


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
