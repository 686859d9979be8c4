"""Spaces: where each material is a point, and what lies between two of them.

    paper     each channel by itself: the first k scores and their Delaunay triangulation (the paper's method)
    linear    no space at all: the two end materials in plain proportion, for comparison

A space answers one question: the weights on the way from one material to another, as a piecewise linear function of t.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from ..components import Pca
from ..errors import SpaceError
from ..library import Library
from ..recipes import Recipe
from .triangulation import Path, Triangulation, corners
from .walk import DelaunayWalk

SIMPLICES_PER_POINT = (1, 2, 6.8, 32, 190, 1300)
"""Of the Delaunay triangulation of many points that are spread evenly, in 1 to 6 dimensions."""
MOST_SIMPLICES = 1e6
"""More are not made: a million takes a gigabyte in six dimensions."""


class Leg(NamedTuple):
    """Weights of all materials on the way from one to another, per channel, linear between the knots."""

    knots: Float64[np.ndarray, " n_knots"]  # ascending from 0 to 1
    weights: Float64[np.ndarray, "3 n_knots N"]


class Space(ABC):
    """Where each material of a library is a point."""

    name: str
    """What the space is called on the command line and in JSON."""
    library: str
    names: tuple[str, ...]

    @abstractmethod
    def leg(self, start: int, stop: int) -> Leg:
        """The straight way from material ``start`` to material ``stop``."""


@dataclass(frozen=True, eq=False)
class PaperSpace(Space):
    """The paper's space: three triangulations, one per channel, of the first k scores.

    Reference: Nunes, Miranda, Andrade, sections III B to E.
    """

    library: str
    names: tuple[str, ...]
    triangulations: tuple[Triangulation | DelaunayWalk, ...]
    """One per channel; walks where there are too many simplices to make, which give the same weights."""
    name = "paper"

    @classmethod
    def fit(cls, library: Library, pca: Pca, *, n_components: int = 3) -> "PaperSpace":
        """The space of the first ``n_components`` scores (1 to 6; the paper uses 3)."""
        if not 1 <= n_components <= 6:
            raise SpaceError(
                f"a space of {n_components} components cannot be made: expected 1 to 6 "
                "(a triangulation of 100 points has 530 simplices in 3 dimensions, 20,000 in 6)."
            )
        n_simplices = len(library) * SIMPLICES_PER_POINT[n_components - 1]
        kind = Triangulation if n_simplices <= MOST_SIMPLICES else DelaunayWalk
        return cls(library.name, library.names, tuple(map(kind.of, pca.scores(n_components))))

    def leg(self, start: int, stop: int) -> Leg:
        return _together([t.path(start, stop) for t in self.triangulations])

    def recipe(self, point: Float64[np.ndarray, "3 k"]) -> Recipe:
        """The recipe of any point, given by its scores in each channel.

        Raises
        ------
        OutsideHullError
            When the point of a channel is not between its materials.
        """
        weights = [t.weights(x) for t, x in zip(self.triangulations, point, strict=True)]
        return Recipe.from_dense(self.library, self.names, np.stack(weights))


@dataclass(frozen=True, eq=False)
class LinearSpace(Space):
    """Plain linear interpolation of the two end materials."""

    library: str
    names: tuple[str, ...]
    name = "linear"

    def leg(self, start: int, stop: int) -> Leg:
        ends = corners(len(self.names), start, stop)
        return Leg(np.array([0.0, 1.0]), np.stack([ends] * 3))


def _together(channels: list[Path]) -> Leg:
    """One leg with the knots of all channels; a knot more on a linear piece changes nothing."""
    knots = np.unique(np.concatenate([path.knots for path in channels]))
    return Leg(knots, np.stack([interpolate(knots, path.knots, path.weights) for path in channels]))


def interpolate(
    t: Float64[np.ndarray, " n"],
    knots: Float64[np.ndarray, " n_knots"],
    weights: Float64[np.ndarray, "... n_knots N"],
) -> Float64[np.ndarray, "... n N"]:
    """Weights at each ``t``, linear between the knots and exact on them."""
    piece = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)
    share = ((t - knots[piece]) / (knots[piece + 1] - knots[piece]))[:, None]
    return (1 - share) * weights[..., piece, :] + share * weights[..., piece + 1, :]
