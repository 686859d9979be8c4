"""Delaunay weights in any dimension, without the triangulation.

The Delaunay weights of a point x of the hull solve a linear programme,

    minimise  sum_i w_i |y_i|^2    subject to    sum_i w_i y_i = x,   sum_i w_i = 1,   w >= 0

whose basic solutions are the simplices: the triangulation is the lower hull of the points lifted to (y, |y|^2). A
hundred points have 242,000 simplices in eight dimensions; a straight line meets a few dozen of them. So a line from p to q
begins in the simplex of a programme about p,

    minimise  sum_i v_i |y_i - p|^2    subject to    sum_i v_i (y_i - p) = q - p,   v >= 0

(the first weights are w_i = t v_i), and each next simplex comes from a pivot of the dual simplex method: where the
weight of vertex j reaches 0, the vertex that replaces it is the first that the hyperplane through the other lifted
vertices meets when it is turned beyond the face,

    i = argmin  r_i / -b_j(y_i)    over the points beyond the face, b_j(y_i) < 0

with r_i the height of lifted point i above the simplex's hyperplane and b_j its barycentric coordinate on j.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int

from .._types import Points
from ..errors import OutsideHullError
from .triangulation import INSIDE, affine_frame, on_vertices, outside_message, representatives
from .way import Way

PIVOT = 1e-7
"""A point nearer to a face than this share of its opposite vertex's distance does not count as beyond it."""
PIVOTS = 10_000
"""After so many, a line that runs within rounding of lower-dimensional faces goes straight to its end."""


@dataclass(frozen=True, eq=False)
class DelaunayWalk:
    """The Delaunay triangulation of n points, as `Triangulation`, of which only what is asked for is ever made."""

    points: Points
    """The points as given, shape (n, k)."""
    _kept: Int[np.ndarray, " n_kept"]
    _origin: Float64[np.ndarray, " k"]
    _basis: Float64[np.ndarray, "k d"]
    _lifted: Float64[np.ndarray, "d_1 n_kept"]
    """Rows: the kept points' coordinates, and 1."""

    @classmethod
    def of(cls, points: Points) -> "DelaunayWalk":
        """Prepare; warns where points coincide or lie in fewer dimensions than they have coordinates."""
        origin, basis = affine_frame(points)
        flat = (points - origin) @ basis
        kept = representatives(flat)
        lifted = np.concatenate([flat[kept].T, np.ones((1, len(kept)))])
        return cls(points, kept, origin, basis, lifted)

    @property
    def n_dimensions(self) -> int:
        """Dimensions in which the points extend."""
        return self._basis.shape[1]

    @property
    def simplices(self) -> Int[np.ndarray, "0 n_vertices"]:
        """Those that are kept to be shown: none. A walk makes one where it is met."""
        return np.zeros((0, self.n_dimensions + 1), np.intp)

    def weights(self, x: Float64[np.ndarray, " k"]) -> Float64[np.ndarray, " n_points"]:
        """Barycentric weights of ``x`` over all points; raises as `Triangulation.weights` does."""
        target = self._flat(x)
        # About the target, where the heights of what matters are small numbers.
        costs = np.square(self._lifted - target[:, None]).sum(axis=0)
        order = _cheapest(costs, self._lifted, target)
        if order is None:
            raise OutsideHullError(outside_message(len(self.points)))
        vertices = _first_basis(self._lifted, order)
        # Least squares: where the points are nearly flat there are fewer vertices than equations.
        barycentric, *_ = np.linalg.lstsq(self._lifted[:, vertices], target)
        return on_vertices(self._kept[vertices], barycentric, len(self.points))

    def way(self, start: int, stop: int) -> Way:
        """The weights along the straight line from point ``start`` to point ``stop``, both ends exact."""
        crossings = self._crossings(self._flat(self.points[start]), self._flat(self.points[stop]))
        return Way.between(start, stop, len(self.points), crossings)

    def _crossings(
        self, p: Float64[np.ndarray, " d_1"], q: Float64[np.ndarray, " d_1"]
    ) -> list[tuple[float, np.ndarray]]:
        """The t strictly between 0 and 1 where the line changes its simplex, and the weights there."""
        crossings: list[tuple[float, np.ndarray]] = []
        vertices = self._first_simplex(p, q)
        if vertices is None:
            # Too many dimensions for the programme's precision: the two ends alone are weights as well.
            return []
        t = 0.0
        for _ in range(PIVOTS):
            inverse = np.linalg.inv(self._lifted[:, vertices])
            at_p, at_q = inverse @ p, inverse @ q
            slope = at_q - at_p
            falling = np.flatnonzero(slope < -INSIDE)
            zero = -at_p[falling] / slope[falling]
            if not len(zero) or zero.min() >= 1 - INSIDE:
                break
            leaving = int(falling[zero.argmin()])
            here = max(float(zero.min()), t)
            if here > t:
                t = here
                barycentric = (1 - t) * at_p + t * at_q
                weights = on_vertices(self._kept[vertices], barycentric, len(self.points))
                crossings.append((t, weights))
            entering = self._beyond(vertices, leaving, inverse)
            if entering is None:
                break
            vertices[leaving] = entering
        return crossings

    def _beyond(
        self, vertices: Int[np.ndarray, " d_1"], leaving: int, inverse: np.ndarray
    ) -> int | None:
        """The vertex on the other side of the face opposite ``leaving``; None where there is only the outside."""
        coordinate = inverse[leaving] @ self._lifted
        beyond = np.flatnonzero(coordinate < -PIVOT)
        if not len(beyond):
            return None
        height = self._costs - (self._costs[vertices] @ inverse) @ self._lifted
        turn = np.maximum(height[beyond], 0) / -coordinate[beyond]
        return int(beyond[turn.argmin()])

    def _first_simplex(
        self, p: Float64[np.ndarray, " d_1"], q: Float64[np.ndarray, " d_1"]
    ) -> Int[np.ndarray, "..."] | None:
        """Vertices of the simplex at p on the way to q; None where the programme fails."""
        away = self._lifted - p[:, None]
        costs = np.square(away).sum(axis=0)
        length = np.linalg.norm(q - p) or 1.0
        order = _cheapest(costs, away[:-1] / length, (q - p)[:-1] / length)
        if order is None:
            return None
        vertices = _first_basis(self._lifted, np.append(costs.argmin(), order))
        return vertices if len(vertices) == len(p) else None

    @property
    def _costs(self) -> Float64[np.ndarray, " n_kept"]:
        return np.square(self._lifted[:-1]).sum(axis=0)

    def _flat(self, x: Float64[np.ndarray, " k"]) -> Float64[np.ndarray, " d_1"]:
        return np.append((x - self._origin) @ self._basis, 1.0)


def _cheapest(
    costs: Float64[np.ndarray, " n"],
    columns: Float64[np.ndarray, "m n"],
    target: Float64[np.ndarray, " m"],
) -> Int[np.ndarray, " n"] | None:
    """The columns in the order in which they belong to the basis of the cheapest combination that makes ``target``."""
    from scipy.optimize import linprog

    solution = linprog(costs, A_eq=columns, b_eq=target, method="highs-ds")
    if solution.x is None:
        return None
    carrying = solution.x > INSIDE
    return np.lexsort((solution.lower.marginals, ~carrying))


def _first_basis(
    lifted: Float64[np.ndarray, "d_1 n"], order: Int[np.ndarray, " n_ordered"]
) -> Int[np.ndarray, " n_chosen"]:
    """The first columns in ``order`` that are linearly independent, as many as there are rows."""
    chosen: list[int] = []
    frame = np.zeros((0, len(lifted)))
    for i in order:
        column = lifted[:, i]
        rest = column - frame.T @ (frame @ column)
        # Twice is enough: rounding of the first projection is projected out by the second.
        rest = rest - frame.T @ (frame @ rest)
        length = np.linalg.norm(rest)
        if length > 1e-7 * np.linalg.norm(column):
            chosen.append(int(i))
            frame = np.concatenate([frame, rest[None] / length])
        if len(chosen) == len(lifted):
            break
    return np.array(chosen)
