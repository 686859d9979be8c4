"""What every space can say of itself.

A space has one or more charts, in which materials are points, or none; and it knows the way from one material to another.
Whoever shows, walks or judges a space asks for these and never for its kind.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from itertools import product
from typing import Any, ClassVar, NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Weights
from ..components import Newcomer
from ..errors import OutsideHullError, SpaceError
from ..library import LibraryRef
from ..recipes import Blend, Recipe
from .chart import Chart
from .embedding import Embedding, embeddings_of
from .triangulation import Triangulation
from .way import Way


class Position(NamedTuple):
    """A point of a space, and the material that stands there."""

    recipe: Recipe
    point: Float64[np.ndarray, " d"]
    """The point that was asked for, or the nearest that is a mix."""
    inside: bool
    """Whether the point that was asked for is a mix."""


@dataclass(frozen=True, eq=False)
class Space(ABC):
    """Where each material of a library is a point."""

    library: LibraryRef
    names: tuple[str, ...]
    """All materials of the library."""
    charts: tuple[Chart, ...]
    """One for all channels, or one for each; none where nothing lies between the ways."""
    blend: Blend = field(default=Blend.LINEAR, kw_only=True)
    """How its recipes are mixed."""
    name: ClassVar[str]
    """What the space is called on the command line and in JSON."""
    summary: ClassVar[str]
    """One line on what it is."""
    usual_blend: ClassVar[Blend] = Blend.LINEAR
    """How its recipes are mixed unless a person says otherwise."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self.names)} materials of {self.library.name!r}>"

    @abstractmethod
    def leg(self, start: int, stop: int) -> Way:
        """The weights from material ``start`` to material ``stop``, for each channel."""

    def between(self, start: Weights, stop: Weights) -> Way:
        """The weights from one mix to another: the mean of the legs between their materials.

        It begins and ends with the two exactly, and what is linear along each leg is so along their mean.
        """
        pairs = list(product(*(np.flatnonzero(w.any(axis=0)).tolist() for w in (start, stop))))
        legs = [self.leg(i, j) if i != j else self._stay(i) for i, j in pairs]
        return Way.mean(legs, np.stack([start[:, i] * stop[:, j] for i, j in pairs], axis=1))

    def _stay(self, i: int) -> Way:
        return Way.of_channels([Way.between(i, i, len(self.names))])

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The names of the coordinates of a point, chart after chart; those of a channel begin with its letter."""
        return tuple(
            name if chart.channel == "all" else f"{chart.channel}_{name}"
            for chart in self.charts
            for name in chart.coordinates.names
        )

    @property
    def unit(self) -> str:
        """Of the coordinates: that of a BRDF value in the mapping in which they are linear."""
        units = {group.unit for chart in self.charts for group in chart.coordinates.groups}
        return ", ".join(sorted(units)) or "1/sr"

    @property
    def points(self) -> Float64[np.ndarray, "N d"]:
        """Where each material is: its `coordinates`."""
        parts = [chart.coordinates.points for chart in self.charts]
        return np.concatenate([np.zeros((len(self.names), 0)), *parts], axis=1)

    def point_of(self, newcomer: Newcomer) -> Float64[np.ndarray, " d"]:
        """Where a material stands that is not of the library: its `coordinates`.

        Raises
        ------
        SpaceError
            When a coordinate cannot be read off its table.
        """
        parts = [chart.coordinates.of(newcomer) for chart in self.charts]
        return np.concatenate([np.zeros(0), *parts])

    def at(
        self, point: Mapping[str, float] | Sequence[float] | np.ndarray, *, clamp: bool = False
    ) -> Position:
        """The material at any point.

        Parameters
        ----------
        point : array of shape (d,), or mapping
            Every coordinate, in the order or by the names of `coordinates`.
        clamp : bool
            Take the nearest point of the hull where the point is outside.

        Raises
        ------
        SpaceError
            When the point has other coordinates, or the space has no points between its ways.
        OutsideHullError
            When the point is outside the hull; the message has the distance and the nearest point.
        """
        x = self._numbers(point)
        ends = np.cumsum([len(chart.coordinates.names) for chart in self.charts])
        parts = np.split(x, ends[:-1])
        located = [chart.locate(part) for chart, part in zip(self.charts, parts, strict=True)]
        inside = all(each.inside for each in located)
        reached = [
            w.weights @ c.coordinates.points for c, w in zip(self.charts, located, strict=True)
        ]
        if not (inside or clamp):
            raise OutsideHullError(self._outside(parts, reached))
        weights = np.stack([each.weights for each in located])
        dense = np.broadcast_to(weights, (3, len(self.names)))
        recipe = Recipe.from_dense(self.library, self.names, dense, self.blend)
        return Position(recipe, np.concatenate(reached), inside)

    def without(self, i: int) -> Float64[np.ndarray, "3 N"]:
        """The weights of the others where material ``i`` stands in their space, or at the nearest point of their hull."""
        weights = np.stack([chart.without(i) for chart in self.charts])
        return np.broadcast_to(weights, (3, len(self.names)))

    def index(self, name: str) -> int:
        """Position of the material called ``name``.

        Raises
        ------
        SpaceError
            When there is none.
        """
        if name not in self.names:
            near = get_close_matches(name, self.names, n=3, cutoff=0.5)
            hint = f" did you mean {', '.join(near)}?" if near else f" such as {self.names[0]}."
            raise SpaceError(f"{name!r} is not a material of {self.library.name}:{hint}")
        return self.names.index(name)

    def embeddings(self) -> list[Embedding]:
        """The materials as points in up to three dimensions, to be looked at; none where there are no charts."""
        return [embedding for chart in self.charts for embedding in embeddings_of(chart)]

    def triangulations(self) -> list[Triangulation]:
        """The Delaunay triangulation of the scaled points of each chart."""
        return [chart.triangulation() for chart in self.charts]

    def to_json(self) -> dict[str, Any]:
        """The names of the coordinates and the point of each material."""
        return {
            "format": 1,
            "library": self.library.name,
            "space": self.name,
            "coordinates": list(self.coordinates),
            "unit": self.unit,
            "points": dict(zip(self.names, self.points.tolist(), strict=True)),
        }

    def _numbers(self, point: Mapping[str, float] | Sequence[float] | np.ndarray) -> np.ndarray:
        names = self.coordinates
        if not names:
            raise SpaceError(
                f"the space {self.name!r} has no points between its routes: choose another space."
            )
        if isinstance(point, Mapping):
            missing = [name for name in names if name not in point]
            unknown = [name for name in point if name not in names]
            if missing or unknown:
                raise SpaceError(
                    f"the point lacks {missing} and has {unknown}: expected the coordinates {', '.join(names)}."
                )
            point = [point[name] for name in names]
        x = np.asarray(point, np.float64).ravel()
        if len(x) != len(names) or not np.isfinite(x).all():
            what = (
                f"{len(x)} coordinates" if len(x) != len(names) else f"the coordinates {x.tolist()}"
            )
            raise SpaceError(
                f"the point has {what}: expected {len(names)} numbers, {', '.join(names)}."
            )
        return x

    def _outside(self, asked: Sequence[np.ndarray], reached: Sequence[np.ndarray]) -> str:
        scales = [chart.coordinates.scale for chart in self.charts]
        off = [(a - b) * s for a, b, s in zip(asked, reached, scales, strict=True)]
        listed = ",".join(f"{value:.6g}" for value in np.concatenate(reached))
        return (
            f"the point is outside the hull of the {len(self.names)} materials, {np.linalg.norm(np.concatenate(off)):.3g} "
            f"from it in scaled coordinates: no mix stands there. The nearest that does is {listed}; --clamp takes it."
        )
