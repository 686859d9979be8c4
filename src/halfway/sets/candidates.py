"""What a set takes its samples of: weights, and what their mixes look like."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Float64

from ..brdf import TabularBrdf, albedos
from ..halfdiff import Grid
from ..library import Permuted
from ..look import Looks, appearance
from ..recipes import Blend
from ..tasks import HERE, Work

N_AT_ONCE = 32
THINNING = 4
"""Every so many pixels are enough to tell materials apart."""
ANGLES = np.radians([0.0, 30.0, 60.0, 75.0])
"""From which albedos are taken."""


class Weighed(NamedTuple):
    """Weights over the materials of a library, and the order that the mix's channels are put in."""

    weights: Float64[np.ndarray, "3 N"]
    order: str = Permuted.ORDERS[0]


@dataclass(frozen=True, eq=False)
class Candidate:
    """A mix, as it looks."""

    weighed: Weighed
    picture: Float32[np.ndarray, "n_pixels 3"]
    """CIELAB, in the pacing scene."""
    least: float
    """The least value of its table, 1/sr."""
    albedo: float
    """The largest share of light that it reflects, over channels and `ANGLES`."""


def candidates(
    looks: Looks, blend: Blend, weighed: Sequence[Weighed], *, work: Work = HERE
) -> Iterator[Candidate]:
    """Each mix as it looks, from small tables."""
    chunks = [weighed[i : i + N_AT_ONCE] for i in range(0, len(weighed), N_AT_ONCE)]
    for some in work.run(partial(_seen, looks, blend), chunks, label="Looking at mixes"):
        yield from some


def materials(looks: Looks, *, work: Work = HERE) -> list[Candidate]:
    """The materials of the library alone, as they look."""
    alone = np.broadcast_to(np.eye(len(looks.names)), (3, len(looks.names), len(looks.names)))
    weighed = [Weighed(alone[:, i]) for i in range(len(looks.names))]
    return list(candidates(looks, Blend.LINEAR, weighed, work=work))


def _seen(looks: Looks, blend: Blend, weighed: Sequence[Weighed]) -> list[Candidate]:
    tables = looks.tables.mix(np.stack([each.weights for each in weighed], axis=1), blend)
    pictures = looks.of_tables(tables)
    return [
        Candidate(
            each,
            appearance(picture[:, Permuted.channels(each.order)]),
            float(table.min()),
            _largest_albedo(table, looks.tables.grid),
        )
        for each, picture, table in zip(weighed, pictures, tables.swapaxes(0, 1), strict=True)
    ]


def _largest_albedo(table: Float[np.ndarray, "3 p"], grid: Grid) -> float:
    samples = np.where(grid.mask(), table.reshape(3, *grid.shape), np.float32(np.nan))
    return float(albedos(TabularBrdf(samples, grid), ANGLES).max())
