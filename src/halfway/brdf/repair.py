"""Make a table physically sound, changing as little as possible, and say what was changed.

    holes          take the nearest measured sample, in steps of cells
    infinite       as holes
    below horizon  become unmeasured
    negative       become 0
    albedo > 1     f_r(wi, wo) times min(s(theta_i), s(theta_o)), with s = 1 / albedo where that is above 1, and else 1

where an albedo is that from the worst azimuth, so that a surface is scaled the same however it is turned. The last keeps reciprocity, changes nothing that is lit and seen from angles that were sound, and leaves no albedo above 1:
a'(theta_i) <= s(theta_i) a(theta_i), again up to the tolerance of the check.
"""

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from .._types import Mask
from ..halfdiff import Grid, cosines
from .albedo_operator import albedos
from .check import ALBEDO_TOLERANCE, GRAZING_DEGREES, STEEP_DEGREES
from .table import TabularBrdf

_DEGREES = np.unique([*STEEP_DEGREES, *GRAZING_DEGREES, *np.arange(0, 90, 2.5), 89.5])


class Repaired(NamedTuple):
    """A sound table and what was done to make it so."""

    table: TabularBrdf
    changes: tuple[str, ...]
    """One sentence each; empty where the table was sound."""


def repair(table: TabularBrdf) -> Repaired:
    """The nearest sound table, as above; the same one if it was sound."""
    values = np.array(table.values)
    mask = table.grid.mask()
    changes: list[str] = []

    outside = ~np.isnan(values) & ~mask
    if outside.any():
        values[outside] = np.nan
        changes.append(f"{_count(outside)} below the horizon were removed.")

    infinite = np.isinf(values)
    values[infinite] = np.nan
    holes = np.isnan(values) & mask
    if infinite.any():
        changes.append(f"{_count(infinite)} were infinite and count as unmeasured.")
    if holes.any():
        n_empty = sum(
            _fill(channel, hole, table.grid) for channel, hole in zip(values, holes, strict=True)
        )
        changes.append(f"{_count(holes)} were unmeasured and took {_source(n_empty)}.")

    negative = values < 0
    if negative.any():
        changes.append(
            f"{_count(negative)} were negative, down to {values[negative].min():.3g} /sr, and became 0."
        )
        values[negative] = 0

    passive, most = _passive(TabularBrdf(values, table.grid, name=table.name))
    if most is not None:
        changes.append(
            f"Up to {most:.3g} times the light was reflected; such angles were scaled down to reflect all of it."
        )
    return Repaired(passive if changes else table, tuple(changes))


def _count(cells: Mask) -> str:
    n = int(cells.sum())
    return f"{n:,} of {cells.size:,} samples"


def _source(n_empty: int) -> str:
    return "0 in a channel without any measured sample" if n_empty else "the nearest measured one"


def _fill(channel: np.ndarray, holes: Mask, grid: Grid) -> bool:
    """Fill ``holes`` in place; True where there was nothing to fill them with."""
    from scipy.ndimage import distance_transform_edt

    known = ~np.isnan(channel)
    if not known.any():
        channel[holes] = 0
        return True
    # A periodic axis goes on at its other end: half a turn either way is enough.
    padding = [(axis.size // 2,) * 2 if axis.periodic else (0, 0) for axis in grid.axes]
    padded = np.pad(known, padding, mode="wrap")
    nearest = np.asarray(
        distance_transform_edt(~padded, return_distances=False, return_indices=True)
    )
    inner = tuple(
        slice(before, before + n) for (before, _), n in zip(padding, grid.shape, strict=True)
    )
    indices = [
        (index[inner] - before) % n
        for index, (before, _), n in zip(nearest, padding, grid.shape, strict=True)
    ]
    channel[holes] = channel[tuple(index[holes] for index in indices)]
    return False


def _passive(table: TabularBrdf) -> tuple[TabularBrdf, float | None]:
    """The table with no albedo above 1, and the largest it had if that was above 1."""
    albedo = albedos(table, np.radians(_DEGREES))
    largest = float(albedo.max())
    if largest <= 1 + ALBEDO_TOLERANCE:
        return table, None
    # The samples that a lookup blends stand at other angles, on a coarse grid far off: what is left over is taken off
    # an ever wider neighbourhood, which in the end is all.
    for width in range(len(_DEGREES)):
        table = _times(table, _lesser(table, _least_around(1 / np.maximum(1, albedo), width)))
        albedo = albedos(table, np.radians(_DEGREES))
        if albedo.max() <= 1 + ALBEDO_TOLERANCE / 2:
            break
    return table, largest


def _least_around(factors: np.ndarray, width: int) -> np.ndarray:
    """The least factor within ``width`` angles either way, per channel."""
    padded = np.pad(factors, ((width, width), (0, 0)), mode="edge")
    return sliding_window_view(padded, 2 * width + 1, axis=0).min(axis=-1)


def _times(table: TabularBrdf, factors: np.ndarray) -> TabularBrdf:
    values = (table.values * factors).astype(np.float32)
    return TabularBrdf(values, table.grid, name=table.name)


def _lesser(table: TabularBrdf, factors: np.ndarray) -> np.ndarray:
    """The lesser of the factors of each cell's two directions, per channel; ``factors`` has shape (n_angles, 3)."""
    angles = table.grid.centres()
    both = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    theta_i, theta_o = (np.degrees(np.arccos(np.clip(c, 0, 1))) for c in both)
    return np.stack(
        [
            np.minimum(np.interp(theta_i, _DEGREES, f), np.interp(theta_o, _DEGREES, f))
            for f in factors.T
        ]
    )
