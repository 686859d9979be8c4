"""Routes: from one material to another, and on.

The straight line from p to q in a space is ``s(t) = (1 - t) p + t q`` (eq. 6); its recipes are piecewise linear in t.
With several stops each leg takes an equal share of t, until `halfway.space.perceptual` paces the whole.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Float64, Int

from .._types import Weights
from ..errors import SpaceError
from ..library import LibraryRef
from ..recipes import Blend, Recipe
from .space import Space
from .way import Way

FORMAT = 2
"""Of recipes.json; 1 had no blend, and was linear."""


@dataclass(frozen=True, eq=False)
class Route:
    """A sequence of recipes through two or more stops.

    Examples
    --------
    >>> import halfway
    >>> library = halfway.open_library("builtin:merl-abc")
    >>> route = halfway.route(library, "teflon", "gold-paint", space="linear", pace="uniform")
    >>> route.recipe(0.25).to_json()["weights"]
    {'gold-paint': 0.25, 'teflon': 0.75}
    """

    library: LibraryRef
    space: str
    pace: str
    stops: tuple[str, ...]
    names: tuple[str, ...]
    """All materials of the library."""
    way: Way
    """The weights of all materials, for each channel."""
    stop_ts: Float64[np.ndarray, " n_stops"]
    """The t of each stop, ascending from 0 to 1."""
    blend: Blend
    """How its recipes are mixed."""

    @classmethod
    def through(cls, space: Space, stops: Sequence[str | Recipe]) -> "Route":
        """The route through materials named ``stops``, or recipes of theirs, at the paper's uniform pace.

        Raises
        ------
        SpaceError
            With fewer than two stops, a stop that follows itself, one that the library does not have, or that is mixed in another
            way than the route.
        """
        _check_stops(stops)
        legs = [space.between(a, b) for a, b in pairwise(_weights(space, s) for s in stops)]
        return cls(
            space.library,
            space.name,
            "uniform",
            tuple(map(_label, stops)),
            space.names,
            Way.chain(legs),
            # The very numbers at which `Way.chain` puts its knots.
            np.arange(len(stops)) / len(legs),
            space.blend,
        )

    def __repr__(self) -> str:
        return f"Route({' to '.join(self.stops)}, {self.space}, {self.pace} pace, {self.library.name!r})"

    def steps(self, n: int) -> list[float]:
        """``n`` values of t from 0 to 1: every stop, and each leg evenly, as many steps as its share of t.

        Raises
        ------
        SpaceError
            When n is less than the number of stops.
        """
        if n < max(2, len(self.stops)):
            raise SpaceError(
                f"a route of {n} materials cannot pass {len(self.stops)} stops: expected -n {len(self.stops)} or more."
            )
        borders = _rounded(self.stop_ts * (n - 1))
        return np.interp(np.arange(n), borders, self.stop_ts).tolist()

    def at(self, t: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, "3 n N"]:
        """Weights of all materials at each t in [0, 1]."""
        return self.way.at(t)

    def recipe(self, t: float) -> Recipe:
        """The recipe at one t."""
        return self.recipes([t])[0]

    def recipes(self, t: Sequence[float] | np.ndarray) -> list[Recipe]:
        """The recipe at each t.

        Raises
        ------
        SpaceError
            When a t is not in [0, 1].
        """
        ts = np.asarray(t, np.float64)
        outside = ts[~((ts >= 0) & (ts <= 1))]
        if len(outside):
            raise SpaceError(
                f"t = {outside[0]:g} is off the route: expected 0 (first stop) to 1 (last stop)."
            )
        # Of a large library a route touches a few dozen materials.
        used = self.used()
        names = [self.names[i] for i in used]
        weights = Way(self.way.knots, self.way.weights[..., used]).at(ts)
        return [
            Recipe.from_dense(self.library, names, w, self.blend)
            for w in np.moveaxis(weights, 1, 0)
        ]

    def used(self) -> Int[np.ndarray, " n_used"]:
        """Indices of the materials that carry weight anywhere on the route."""
        return np.flatnonzero(self.way.weights.any(axis=(0, 1)))

    def to_json(self, t: Sequence[float] | np.ndarray) -> dict[str, Any]:
        """The document ``recipes.json``: the recipes at each t, and where they come from."""
        recipes = zip(t, self.recipes(t), strict=True)
        return {
            "format": FORMAT,
            "library": self.library.name,
            "space": self.space,
            "pace": self.pace,
            "blend": str(self.blend),
            "stops": list(self.stops),
            "recipes": [{"t": float(x), "weights": r.to_json()["weights"]} for x, r in recipes],
            "library_address": self.library.address,
            "library_checksum": self.library.checksum,
        }


def _rounded(borders: Float64[np.ndarray, " n_stops"]) -> Float64[np.ndarray, " n_stops"]:
    """Whole numbers near ``borders``, strictly ascending; the first and the last stay."""
    whole = np.round(borders)
    for i in range(1, len(whole) - 1):
        whole[i] = np.clip(whole[i], whole[i - 1] + 1, whole[-1] - (len(whole) - 1 - i))
    return whole


def _weights(space: Space, stop: str | Recipe) -> Weights:
    if isinstance(stop, str):
        return Recipe.of(space.library, {space.names[space.index(stop)]: 1.0}).dense(space.names)
    if stop.is_recoloured:
        raise SpaceError(
            f"{_label(stop)} has its body scaled, which a route cannot carry: expected weights alone."
        )
    if len(stop.names) > 1 and stop.blend is not space.blend:
        raise SpaceError(
            f"{_label(stop)} is mixed by the blend {str(stop.blend)!r}, and the route by {str(space.blend)!r}: expected the same. "
            f"Take --blend {stop.blend}."
        )
    return stop.dense(space.names)


def _label(stop: str | Recipe) -> str:
    if isinstance(stop, str):
        return stop
    return stop.names[0] if len(stop.names) == 1 else f"mix of {len(stop.names)}"


def _check_stops(stops: Sequence[str | Recipe]) -> None:
    if len(stops) < 2:
        raise SpaceError(
            f"a route with {len(stops)} stop goes nowhere: name at least two materials."
        )
    for stop, following in pairwise(stops):
        if stop == following:
            raise SpaceError(
                f"{_label(stop)} follows itself on this route: name each stop once in a row."
            )
