"""``recover``: a whole material from a few measured directions, as two answers.

    completion    the weighted sum of a library's materials, in the log-relative mapping, that `regression` gives
    mix           the recipe whose values at the directions are nearest to those measured, in the same mapping

The completion comes nearer: its weights may be negative and their sum extrapolates. It promises none of a BRDF's laws but reciprocity;
`halfway.brdf.repair` restores them. A mix keeps them all, and is as far off as the library is from having the material.

How sure the completion is, is measured: each material of the library is recovered from the same directions without itself, and s(cell) is the root mean
square of what that misses. An interval is the completion give or take so many s that the library's own materials lie in it on the share of cells
that is asked for.
"""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Float64
from scipy.optimize import nnls

from ..brdf import Brdf, TabularBrdf
from ..errors import LibraryError
from ..library import Library, open_library
from ..measurements import Measurements
from ..recipes import Blend, Recipe
from ..tasks import HERE, Work
from .log_relative import Cosines, cosines_at, mapped, unmapped
from .setup import Channels, Setup, as_batches, spread

_TO_COMPLETION = 1e-6
"""How much nearness to the completion counts beside nearness to the measurements: it decides where those leave a choice."""
_SUM_OF_ONE = 1e3
"""Weight of what the weights must sum to, against all that they shall fit."""
_LEAST_WEIGHT = 1e-5
_LABELS = ("completed", "at the least", "at the most")


class Completion(NamedTuple):
    """A completed measurement: a table, and how sure it is."""

    table: TabularBrdf
    low: TabularBrdf
    high: TabularBrdf
    """The ends of the interval."""


@dataclass(frozen=True, eq=False)
class Recovery:
    """What a measured material is, as far as a library knows materials."""

    setup: Setup
    measurements: Measurements
    weights: Float64[np.ndarray, "m n_rows"]
    """Of the library's rows, for each channel or for all; they sum to 1, and some are negative."""

    @classmethod
    def of(cls, setup: Setup, measurements: Measurements) -> "Recovery":
        """What was measured at the directions of a setup."""
        return cls(setup, measurements, setup.weights(measurements.values))

    def completion(self, level: float = 0.9, *, work: Work = HERE) -> Completion:
        """The completed table, and the interval in which it lies on a share ``level`` of the cells; NaN where a material is unmeasured."""
        library = self.setup.library
        half = self.setup.half_width(level)
        block = partial(
            _block, library, self.setup.channels, self.weights, self.setup.left_out, half
        )
        blocks = list(work.run(block, library.blocks(), label="Completion"))
        parts = (np.concatenate(parts, axis=1) for parts in zip(*blocks, strict=True))
        values = (part.reshape(3, *library.grid.shape) for part in parts)
        labels = (f"{self.measurements.name} {what}".strip() for what in _LABELS)
        table, low, high = (
            TabularBrdf(each, library.grid, name=label)
            for each, label in zip(values, labels, strict=True)
        )
        return Completion(table, low, high)

    def mix(self, blend: Blend | str = Blend.LINEAR) -> Recipe:
        """The recipe that is nearest to what was measured."""
        library, m = self.setup.library, Blend(blend)
        if m.aligns:
            raise LibraryError(
                f"no nearest mix is known in the blend {m}, which moves highlights: expected linear, root or log."
            )
        fits = [
            _weighed(m, *each)
            for each in (
                (self.setup.values, self._measured, self.setup.cosines, self._shares),
                (
                    self.setup.probes.values,
                    self._completed,
                    self.setup.probes.cosines,
                    self._probed,
                ),
            )
        ]
        systems = np.concatenate(fits, axis=1)
        if self.setup.channels == "together":
            systems = systems.reshape(1, -1, systems.shape[-1])
        weights = np.broadcast_to([_convex(system) for system in systems], (3, len(library)))
        return Recipe.from_dense(library, library.names, np.array(weights), m)

    def residuals(self, brdf: Brdf) -> Float64[np.ndarray, "n 3"]:
        """By how much a BRDF misses the measured values, in the mapping: about relative errors, where they are small."""
        wi, wo, values = self.measurements.wi, self.measurements.wo, self.measurements.values
        cosines = wi[:, 2:], wo[:, 2:]
        return mapped(brdf.eval(wi, wo), cosines) - mapped(values, cosines)

    @property
    def _measured(self) -> Float64[np.ndarray, "3 n"]:
        return self.measurements.values[self.setup.used].T

    @property
    def _shares(self) -> Float64[np.ndarray, " n"]:
        weights = self.measurements.weights[self.setup.used]
        return weights / weights.sum()

    @property
    def _probed(self) -> Float64[np.ndarray, " n_pairs"]:
        n = self.setup.probes.values.shape[-1]
        return np.full(n, _TO_COMPLETION / n)

    @property
    def _completed(self) -> Float64[np.ndarray, "3 n_pairs"]:
        """The completion where leave-one-out is taken."""
        probes = self.setup.probes
        completed = self.weights @ probes.batches(self.setup.channels)
        return unmapped(completed.reshape(3, -1), probes.cosines)


def recover(
    library: Library | str,
    measurements: Measurements,
    *,
    channels: Channels = "apart",
    work: Work = HERE,
) -> Recovery:
    """What a measured material is, as far as a library knows materials.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    measurements : Measurements
        From one pair of directions on; a file's: `read_measurements`.
    channels : {"apart", "together"}
        Whether each channel is recovered by itself, or one weight holds for a material's three.

    Examples
    --------
    >>> import halfway
    >>> library = halfway.open_library("builtin:merl-abc")
    >>> plan = halfway.plan(library, 2)
    >>> values = library.material("teflon").eval(plan.wi, plan.wo)
    >>> recovery = halfway.recover(library, halfway.Measurements(plan.wi, plan.wo, values))
    >>> "teflon" in recovery.mix().names
    True

    Raises
    ------
    LibraryError
        When the library is measured at none of the directions.
    """
    opened = open_library(library)
    setup = Setup.of(
        opened,
        measurements.wi,
        measurements.wo,
        weights=measurements.weights,
        channels=channels,
        work=work,
    )
    return Recovery.of(setup, measurements)


def _block(
    library: Library,
    channels: Channels,
    weights: Float64[np.ndarray, "m n_rows"],
    left_out: Float64[np.ndarray, "n_rows n_rows"],
    half: float,
    columns: slice,
) -> tuple[Float32[np.ndarray, "3 n"], ...]:
    """The completion and the ends of its interval on one block."""
    cosines = cosines_at(library.grid, columns)
    batches = as_batches(mapped(library.columns(columns), cosines), channels)
    completed = (weights.astype(np.float32) @ batches).reshape(3, -1)
    apart = spread(left_out.astype(np.float32) @ batches - batches)
    values = (unmapped(completed + k * apart, cosines) for k in (0, -half, half))
    return tuple(each.astype(np.float32) for each in values)


def _weighed(
    blend: Blend,
    materials: Float[np.ndarray, "3 N n"],
    wanted: Float[np.ndarray, "3 n"],
    cosines: Cosines,
    shares: Float64[np.ndarray, " n"],
) -> Float64[np.ndarray, "3 n n_columns"]:
    """Rows of the least squares of a mix: the materials and, in the last column, what is wanted.

    In the mapping of the blend, where mixes are sums, each as steep as the log-relative mapping is there.
    """
    mapping = blend.mapping
    at = mapping.to(wanted)
    step = 1e-4 * (1 + at)
    slope = (mapped(mapping.back(at + step), cosines) - mapped(wanted, cosines)) / step
    rows = np.concatenate([mapping.to(materials), at[:, None]], axis=1).swapaxes(1, 2)
    return rows * (slope * np.sqrt(shares))[..., None]


def _convex(system: Float64[np.ndarray, "n n_columns"]) -> Float64[np.ndarray, " N"]:
    """The weights, none negative and summing to 1, with which the columns but the last come nearest to the last."""
    triangle = np.asarray(np.linalg.qr(system, mode="r"))
    strong = _SUM_OF_ONE * np.linalg.norm(triangle) * np.ones((1, triangle.shape[1]))
    triangle = np.vstack([triangle, strong])
    weights, _ = nnls(triangle[:, :-1], triangle[:, -1])
    weights[weights < _LEAST_WEIGHT] = 0
    return weights / weights.sum()
