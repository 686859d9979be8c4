"""Weights, drawn evenly from a space by what is seen.

The Delaunay simplices of a chart cut the hull of its materials. One is drawn with a chance that goes with its *visible volume*, that
of the simplex whose corners are the pictures x_j of its materials, points of CIELAB at all pixels,

    V = sqrt(det G) / d!        G_jk = (x_j - x_0) . (x_k - x_0) / n_pixels

and of its corners any number, two at the least; between them a point, evenly: its weights have a flat Dirichlet distribution. By the
volume of scores, most would be drawn between a few mirrors, whose scores are far from everything; and with all corners always, nearly
all would be in the middle, where many materials are a little of each: of MERL's neural fits 62 % had a sample nearby, and so 83 %.

Delaunay simplices grow in number as a power of the materials, so more than `MOST_TOGETHER` are cut by themselves in groups, at random.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial
from warnings import catch_warnings, simplefilter

import numpy as np
from jaxtyping import Float, Float64, Int

from .._types import Points
from ..errors import DegenerateSpaceWarning, SpaceError
from ..space import Space, Triangulation

MOST_TOGETHER = 128
"""Materials that are triangulated together: in seven dimensions some hundred thousand simplices, and five seconds."""

Squares = Float64[np.ndarray, "N N"]
"""Squared distances of pictures: mean over pixels, CIELAB."""


def squared_distances(pictures: Float[np.ndarray, "N n_pixels 3"]) -> Squares:
    """Between the pictures of all materials."""
    x = pictures.reshape(len(pictures), -1).astype(np.float64) / np.sqrt(pictures.shape[1])
    products = x @ x.T
    squares = products.diagonal()
    return np.maximum(squares[:, None] + squares - 2 * products, 0)


def visible_volumes(
    simplices: Int[np.ndarray, "n m"], squares: Squares
) -> Float64[np.ndarray, " n"]:
    """The volume of each simplex, whose corners are given by the distances of their pictures."""
    first, others = simplices[:, :1], simplices[:, 1:]
    from_first = squares[first, others]
    between = squares[others[:, :, None], others[:, None, :]]
    gram = (from_first[:, :, None] + from_first[:, None, :] - between) / 2
    return np.sqrt(np.maximum(np.linalg.det(gram), 0)) / factorial(others.shape[1])


@dataclass(frozen=True, eq=False)
class Simplices:
    """Simplices of some materials, and the chance of each to be drawn from."""

    corners: Int[np.ndarray, "n m"]
    """Materials, by their index in the library."""
    chances: Float64[np.ndarray, " n"]

    @classmethod
    def of(
        cls, points: Points, materials: Int[np.ndarray, " n_materials"], squares: Squares
    ) -> "Simplices":
        """The Delaunay simplices of some of all materials, which are ``points``."""
        with catch_warnings():
            # Few materials extend in fewer dimensions than the space of all.
            simplefilter("ignore", DegenerateSpaceWarning)
            corners = materials[Triangulation.of(points[materials]).simplices]
        volumes = visible_volumes(corners, squares)
        # Where nothing has a volume, all look alike and any will do.
        return cls(corners, volumes + np.finfo(float).tiny)

    def draw(
        self, rng: np.random.Generator, n: int, n_materials: int
    ) -> Float64[np.ndarray, "n N"]:
        """Weights of ``n`` materials over all."""
        which = rng.choice(len(self.corners), n, p=self.chances / self.chances.sum())
        weights = np.zeros((n, n_materials))
        weights[np.arange(n)[:, None], self.corners[which]] = _shares(rng, n, self.corners.shape[1])
        return weights


def _shares(rng: np.random.Generator, n: int, m: int) -> Float64[np.ndarray, "n m"]:
    """Shares of m corners: of a number of them that is drawn evenly, two at the least, and flat between those."""
    n_used = rng.integers(min(2, m), m + 1, n)
    rank = rng.permuted(np.tile(np.arange(m), (n, 1)), axis=1)
    amounts = rng.exponential(size=(n, m)) * (rank < n_used[:, None])
    return amounts / amounts.sum(axis=1, keepdims=True)


@dataclass(frozen=True, eq=False)
class Drawing:
    """What weights over some materials of a space are drawn from."""

    charts: tuple[tuple[Simplices, ...], ...]
    """Of each chart, the simplices of each group."""
    n_materials: int
    """All of the library's."""

    @classmethod
    def of(
        cls, space: Space, materials: Int[np.ndarray, " n_materials"], squares: Squares
    ) -> "Drawing":
        """Over these materials, in an order that says which are cut together where they are many.

        Raises
        ------
        SpaceError
            When the space has no points between its routes.
        """
        if not space.charts:
            raise SpaceError(
                f"the space {space.name!r} has no points between its routes: nothing can be drawn from it. "
                "Choose another space."
            )
        groups = np.array_split(materials, -(-len(materials) // MOST_TOGETHER))
        points = [chart.coordinates.points * chart.coordinates.scale for chart in space.charts]
        charts = [
            tuple(Simplices.of(each, np.sort(group), squares) for group in groups)
            for each in points
        ]
        return cls(tuple(charts), len(space.names))

    def draw(self, rng: np.random.Generator, n: int) -> Float64[np.ndarray, "3 n N"]:
        """Weights of ``n`` materials over all, for each channel."""
        each = [self._of_chart(groups, rng, n) for groups in self.charts]
        return np.broadcast_to(np.stack(each), (3, n, self.n_materials))

    def _of_chart(
        self, groups: Sequence[Simplices], rng: np.random.Generator, n: int
    ) -> Float64[np.ndarray, "n N"]:
        counts = rng.multinomial(n, np.full(len(groups), 1 / len(groups)))
        drawn = [
            group.draw(rng, int(k), self.n_materials)
            for group, k in zip(groups, counts, strict=True)
        ]
        return rng.permutation(np.concatenate(drawn))
