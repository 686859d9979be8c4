"""The paper's runs on any library, and what can be measured of them without a renderer.

The runs are the paper's method throughout: the space of three scores per channel, evenly spaced t. Plain linear
interpolation and our own space are measured on the same stops.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float64

from ..components import Pca
from ..errors import LibraryError
from ..judge import Bench, evaluate, uniform
from ..library import Library
from ..look import Looks, appearance, ciede2000_difference, cielab_difference
from ..recipes import Blend
from ..space import Route, Space, make_space
from ..tasks import HERE, Work
from .reported import FINE_TS, N_STEPS, RUNS, Run

SPACES = ("paper", "linear", "anchored")
"""In the order in which they are compared."""
LEAST_MATERIALS = 6
"""Two for each of the three runs."""


@dataclass(frozen=True)
class MeasuredRun:
    """One navigation, measured on the small lit sphere of `halfway.look.Looks`."""

    figure: int
    stops: tuple[str, str]
    stops_in_paper: tuple[str, str]
    n_materials: int
    """Measured materials that carry weight anywhere on the paper's way."""
    detour: dict[str, float]
    """Length of the way over the distance of its ends, by space."""
    jump: dict[str, float]
    """Largest step over mean step at uniform t, by space."""


@dataclass(frozen=True, eq=False)
class Experiment:
    """A library, the spaces that are compared on it, and the stops of each of the paper's runs."""

    library: Library
    pca: Pca
    bench: Bench
    spaces: dict[str, Space]
    stops: dict[int, tuple[str, str]]
    """By the number of the paper's figure; others stand in for materials that the library lacks."""

    @classmethod
    def fit(cls, library: Library, *, work: Work = HERE) -> "Experiment":
        """The experiment on ``library``; what is dear to fit is kept in the cache.

        Raises
        ------
        LibraryError
            With fewer than six materials.
        """
        if len(library) < LEAST_MATERIALS:
            raise LibraryError(
                f"{library.name} has {len(library)} materials: the paper's three runs need at least {LEAST_MATERIALS}."
            )
        bench = Bench.fit(library, work=work)
        fit = partial(make_space, blend=Blend.LINEAR, looks=bench.pacing, work=work)
        return cls(
            library,
            Pca.fit(library, work=work),
            bench,
            {name: fit(name, library) for name in SPACES},
            choose_stops(bench.pacing),
        )

    def route(self, run: Run, space: str = "paper") -> Route:
        """The way of a run in one of the spaces."""
        return Route.through(self.spaces[space], self.stops[run.figure])

    def measure(self, run: Run) -> MeasuredRun:
        """How direct and how even a run is in each space."""
        stops = self.stops[run.figure]
        pair = np.array([[self.library.index(stop) for stop in stops]])
        measured = {
            name: evaluate(space, self.bench, pair, paces={"uniform": uniform})
            for name, space in self.spaces.items()
        }
        return MeasuredRun(
            run.figure,
            stops,
            run.stops,
            len(self.route(run).used()),
            {name: float(each.detour[0]) for name, each in measured.items()},
            {name: float(each.jump["uniform"][0]) for name, each in measured.items()},
        )

    def evenly_seen(self, run: Run, n: int) -> tuple[float, ...]:
        """``n`` of the paper's fine list of t, from 0, one nth of the visible way after each other; 1 is not reached."""
        way = np.append(0.0, np.cumsum(self._steps(run, FINE_TS)))
        at = np.searchsorted(way, way[-1] * np.arange(n) / n)
        return tuple(FINE_TS[at].tolist())

    def largest_steps(self, run: Run) -> dict[str, float]:
        """The largest visible step (CIEDE2000) with 51 materials, and with the paper's fine list of t."""
        coarse = self._steps(run, np.linspace(0, 1, N_STEPS))
        return {"51": float(coarse.max()), "fine": float(self._steps(run, FINE_TS).max())}

    def _steps(self, run: Run, ts: np.ndarray) -> Float64[np.ndarray, " n_steps"]:
        route = self.route(run)
        looks = appearance(self.bench.pacing.thinned(16).mix(route.at(ts), route.blend))
        return np.asarray(ciede2000_difference(looks[:-1], looks[1:]), np.float64)


def largest_share_after(eigenvalues: Float64[np.ndarray, "3 N"], n: int) -> float:
    """The largest share that an eigenvalue after the first ``n`` has of the sum of its channel."""
    shares = eigenvalues / eigenvalues.sum(axis=1, keepdims=True)
    return float(shares[:, n:].max(initial=0.0))


def n_components_below(eigenvalues: Float64[np.ndarray, "3 N"], share: float) -> int:
    """Components until every further eigenvalue is below ``share`` of the sum of its channel."""
    shares = eigenvalues / eigenvalues.sum(axis=1, keepdims=True)
    return int((shares >= share).sum(axis=1).max())


def choose_stops(images: Looks) -> dict[int, tuple[str, str]]:
    """The paper's stops; where a library lacks one, the two materials that look farthest apart of those not yet taken."""
    known = {run.figure: run.stops for run in RUNS if set(run.stops) <= set(images.names)}
    taken = {name for stops in known.values() for name in stops}
    free = [name for name in images.names if name not in taken]
    for run in RUNS:
        if run.figure not in known:
            known[run.figure] = _farthest(images, free)
            free = [name for name in free if name not in known[run.figure]]
    return known


def _farthest(images: Looks, names: Sequence[str]) -> tuple[str, str]:
    at = [images.names.index(name) for name in names]
    looks = appearance(images.images[at, ::16])
    apart = np.array([cielab_difference(looks, one) for one in looks])
    i, j = sorted(divmod(int(apart.argmax()), len(names)))
    return names[i], names[j]
