"""A chart: the materials as points of some coordinates, and the Delaunay weights between them.

The paper's space has a chart for each channel; ours has one for all. Distances, and which point of the hull is the nearest
to a point outside, are those of the scaled coordinates.
"""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float64

from ..errors import OutsideHullError
from .coordinates import Coordinates
from .hull import nearest_in_hull
from .triangulation import Triangulation
from .walk import DelaunayWalk
from .way import Way

Channel = Literal["r", "g", "b", "all"]
ON_THE_HULL = 1e-6
"""A point this near to the hull, as a share of the extent of each coordinate, is on it: rounding."""


class Located(NamedTuple):
    """Where a point is among the materials."""

    weights: Float64[np.ndarray, " N"]
    """Of the point itself, or of the nearest of the hull."""
    inside: bool


@dataclass(frozen=True, eq=False)
class Chart:
    """The materials as points, and the weights at any other."""

    coordinates: Coordinates
    delaunay: Triangulation | DelaunayWalk
    """Of the scaled points."""
    channel: Channel = "all"
    """Whose weights it gives."""

    @classmethod
    def of(
        cls, coordinates: Coordinates, channel: Channel = "all", *, walked: bool = True
    ) -> "Chart":
        """The chart of some coordinates; ``walked``: no triangulation is made, only met, with the same weights."""
        scaled = coordinates.points * coordinates.scale
        delaunay = DelaunayWalk.of(scaled) if walked else Triangulation.of(scaled)
        return cls(coordinates, delaunay, channel)

    def way(self, start: int, stop: int) -> Way:
        """The weights along the straight line from one material to another."""
        return self.delaunay.way(start, stop)

    def locate(self, x: Float64[np.ndarray, " d"]) -> Located:
        """The weights at a point, or at the nearest one of the hull."""
        scale = self.coordinates.scale
        try:
            return Located(self.delaunay.weights(x * scale), inside=True)
        except OutsideHullError:
            points = self.coordinates.points
            weights = nearest_in_hull(points * scale, x * scale)
            extent = np.ptp(points, axis=0)
            off = np.abs(weights @ points - x)
            return Located(weights, inside=bool((off <= ON_THE_HULL * extent).all()))

    def without(self, i: int) -> Float64[np.ndarray, " N"]:
        """The weights where material ``i`` stands among the others, or at the nearest point of their hull."""
        others, own = self.coordinates.without(i)
        weights = np.zeros(len(others) + 1)
        try:
            among = DelaunayWalk.of(others).weights(own)
        except OutsideHullError:
            among = nearest_in_hull(others, own)
        weights[np.arange(len(weights)) != i] = among
        return weights

    def triangulation(self) -> Triangulation:
        """The triangulation of the scaled points, made where it is only walked."""
        match self.delaunay:
            case Triangulation():
                return self.delaunay
            case DelaunayWalk():
                return Triangulation.of(self.delaunay.points)
