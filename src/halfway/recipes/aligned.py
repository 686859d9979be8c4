"""The mean of materials whose highlights are first stretched to one width, the weighted geometric mean of theirs.

    m^-1( sum_i w_i m(body_i + stretched gloss_i) )        per channel

Square roots have compiled loops, of the same bits.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Table
from ..brdf import gloss
from ..halfdiff import Grid
from .blend import Mapping

_CHUNK = 1 << 18  # samples summed at once; a call costs more than a farther cache


def aligned_mean(
    parts: Sequence[gloss.Gloss],
    weights: Float64[np.ndarray, "3 n"],
    mapping: Mapping,
    grid: Grid,
    *,
    compiled: bool = False,
) -> Table:
    """The weighted mean of materials whose glosses are stretched to one width, shape (3, p) with theta_h first."""
    mean = _compiled_mean() if compiled and mapping.to is np.sqrt else _stretched_mean
    width = _mean_width(parts, weights)
    stretches = [gloss.Stretch.by(width / part.width, grid) for part in parts]
    _, n_rows, n = parts[0].body.shape
    values = np.empty((3, n_rows, n), np.float32)
    step = max(1, _CHUNK // n)
    for channel, each in enumerate(weights):
        lobes = [
            _Lobe(
                parts[i].body[channel], parts[i].gloss[channel], stretches[i], np.float32(each[i])
            )
            for i in np.flatnonzero(each).tolist()
        ]
        for start in range(0, n_rows, step):
            part = slice(start, start + step)
            mean(values[channel, part], lobes, part, mapping)
    return values.reshape(3, -1)


class _Lobe(NamedTuple):
    """One channel of a material in a mix."""

    body: np.ndarray
    highlight: np.ndarray
    stretch: gloss.Stretch
    weight: np.float32

    def rows(
        self, part: slice
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """What the compiled loops take of some rows."""
        lower, near, far = (each[part] for each in self.stretch)
        return self.body[part], self.highlight, lower, near, far


def _stretched_mean(total: np.ndarray, lobes: list[_Lobe], part: slice, mapping: Mapping) -> None:
    """Some rows of the mean of materials."""
    total[:] = 0
    for lobe in lobes:
        stretched = lobe.stretch.rows(lobe.highlight, part)
        stretched += lobe.body[part]
        mapping.to(stretched, out=stretched)
        stretched *= lobe.weight
        total += stretched
    mapping.back(total, out=total)


def _compiled_mean() -> Callable[..., None]:
    from .kernel import add_four_stretched_roots, add_stretched_roots  # numba takes a second

    def mean(
        total: np.ndarray,
        lobes: list[_Lobe],
        part: slice,
        mapping: Mapping,  # noqa: ARG001 (square roots)
    ) -> None:
        left = lobes
        while left:
            n = 4 if len(left) > 2 else 1  # four at once take as long as three
            group, rest = left[:n], left[n:]
            edges = left is lobes, not rest
            if n == 1:
                add_stretched_roots(total, *group[0].rows(part), group[0].weight, *edges)
            else:
                group += [group[-1]._replace(weight=np.float32(0))] * (n - len(group))
                weights = tuple(lobe.weight for lobe in group)
                rows = zip(*(lobe.rows(part) for lobe in group), strict=True)
                bodies, glosses, lower, near, far = rows
                add_four_stretched_roots(total, bodies, glosses, lower, near, far, weights, *edges)
            left = rest

    return mean


def _mean_width(parts: Sequence[gloss.Gloss], weights: Float64[np.ndarray, "3 n"]) -> float:
    return float(np.exp(weights.mean(axis=0) @ np.log([part.width for part in parts])))
