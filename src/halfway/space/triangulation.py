"""Delaunay triangulation of points in any dimension, and the way a straight line takes through it.

Inside a simplex with vertices v_0 ... v_d the barycentric weights of x solve

    sum_j w_j v_j = x,   sum_j w_j = 1                                   (eq. 4)

so along x(t) = (1 - t) p + t q they are linear in t: where each leaves [0, 1] is solved once for all simplices, and a
straight line becomes a few *knots* between which the weights are interpolated exactly.

What real scores do to a triangulation, and what happens then:

- points closer than `MERGE` of the extent are one vertex (the first of them);
- directions in which the points do not extend are dropped, with a warning;
- in one dimension the simplices are the gaps between sorted points;
- flat simplices, whose weights are not determined, are left out, and a line bridges the gap they leave.

Qhull runs with its default options: joggled input (QJ) always succeeds, with garbage.
"""

import warnings
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float64, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay, KDTree

from .._types import Points
from ..errors import DegenerateSpaceWarning, OutsideHullError
from .way import Way

MERGE = 1e-9
"""Points closer than this share of the largest extent are one."""
FLAT = 1e-6
"""A direction in which the points extend by less than this share of the largest extent is the rounding of 32-bit tables."""
INSIDE = 1e-9
"""A weight above minus this is 0: rounding, not a place outside."""
SINGULAR = 1e12
"""Condition number above which a simplex is flat."""


@dataclass(frozen=True, eq=False)
class Triangulation:
    """The Delaunay triangulation of n points."""

    points: Points
    """The points as given, shape (n, k)."""
    simplices: Int[np.ndarray, "n_simplices n_vertices"]
    """Indices of the vertices, into `points`; flat simplices left out."""
    origin: Float64[np.ndarray, " k"]
    basis: Float64[np.ndarray, "k d"]
    """Columns span the directions that count, scaled so that the largest extent is 1."""
    _inverses: Float64[np.ndarray, "n_simplices n_vertices n_vertices"]
    """Take (x, 1) to the barycentric weights."""

    @classmethod
    def of(cls, points: Points) -> "Triangulation":
        """Triangulate; warns where points coincide or lie in fewer dimensions than they have coordinates."""
        origin, basis = affine_frame(points)
        flat = (points - origin) @ basis
        kept = representatives(flat)
        simplices = kept[_delaunay(flat[kept])]
        corners = np.concatenate([flat, np.ones((len(flat), 1))], axis=1)[simplices]
        matrices = np.swapaxes(corners, 1, 2)
        sound = _well_conditioned(matrices)
        return cls(points, simplices[sound], origin, basis, np.linalg.inv(matrices[sound]))

    @property
    def n_dimensions(self) -> int:
        """Dimensions in which the points extend."""
        return self.basis.shape[1]

    @property
    def barycentric(self) -> Float64[np.ndarray, "n_simplices n_vertices k_and_1"]:
        """For each simplex what takes (x, 1) to the weights of its vertices, in the coordinates of `points`."""
        flatten = np.column_stack([self.basis.T, -self.origin @ self.basis])
        return self._inverses @ np.vstack(
            [flatten, np.eye(1, flatten.shape[1], flatten.shape[1] - 1)]
        )

    def weights(self, x: Float64[np.ndarray, " k"]) -> Float64[np.ndarray, " n_points"]:
        """Barycentric weights of ``x`` over all points.

        Raises
        ------
        OutsideHullError
            When ``x`` is not in the hull.
        """
        barycentric = self._barycentric(x)
        best = int(barycentric.min(axis=1).argmax())
        if barycentric[best].min() < -INSIDE:
            raise OutsideHullError(outside_message(len(self.points)))
        return on_vertices(self.simplices[best], barycentric[best], len(self.points))

    def way(self, start: int, stop: int) -> Way:
        """The weights along the straight line from point ``start`` to point ``stop``, both ends exact."""
        crossings = self._crossings(self.points[start], self.points[stop])
        return Way.between(start, stop, len(self.points), crossings)

    def _crossings(
        self, p: Float64[np.ndarray, " k"], q: Float64[np.ndarray, " k"]
    ) -> list[tuple[float, np.ndarray]]:
        """The t strictly between 0 and 1 where the line changes its simplex, and the weights there."""
        at_p, at_q = self._barycentric(p), self._barycentric(q)
        enter, leave = _inside_interval(at_p, at_q)
        crossings: list[tuple[float, np.ndarray]] = []
        t = 0.0
        while True:
            here = np.flatnonzero((enter <= t + INSIDE) & (leave > t + INSIDE))
            if not len(here):
                # Nothing but flat simplices: go straight to where the next sound one begins.
                ahead = np.flatnonzero((enter > t) & (leave > enter + INSIDE))
                if not len(ahead):
                    return crossings
                i = int(ahead[enter[ahead].argmin()])
                t = float(enter[i])
            else:
                i = int(here[leave[here].argmax()])
                t = float(leave[i])
            if t >= 1 - INSIDE:
                return crossings
            barycentric = (1 - t) * at_p[i] + t * at_q[i]
            crossings.append((t, on_vertices(self.simplices[i], barycentric, len(self.points))))

    def _barycentric(
        self, x: Float64[np.ndarray, " k"]
    ) -> Float64[np.ndarray, "n_simplices n_vertices"]:
        return self._inverses @ np.append((x - self.origin) @ self.basis, 1.0)


def on_vertices(
    vertices: Int[np.ndarray, " n_vertices"],
    barycentric: Float64[np.ndarray, " n_vertices"],
    n_points: int,
) -> Float64[np.ndarray, " n_points"]:
    """Barycentric weights of the vertices of a simplex as weights of all points, without what rounding leaves below 0."""
    positive = np.where(barycentric > INSIDE, barycentric, 0.0)
    weights = np.zeros(n_points)
    weights[vertices] = positive / positive.sum()
    return weights


def outside_message(n: int) -> str:
    """What to say of a point outside the hull of ``n`` materials."""
    return f"the point is outside the hull of the {n} materials, so it is no mix of them: choose one between them."


def affine_frame(points: Points) -> tuple[np.ndarray, np.ndarray]:
    """A point and the directions in which the points extend, scaled alike so that the largest extent is 1.

    Scaling all axes alike changes no circumsphere, and makes the tolerances shares of the extent. Where the points
    extend in all dimensions, the directions are the axes.
    """
    n, k = points.shape
    origin = points.mean(axis=0)
    _, extents, directions = np.linalg.svd((points - origin) / np.sqrt(n), full_matrices=False)
    largest = extents.max(initial=0.0)
    n_kept = int((extents > FLAT * largest).sum())
    if n_kept == k:
        return origin, np.eye(k) / largest
    warnings.warn(
        f"{n} materials extend in {n_kept} of {k} dimensions: the space has {n_kept}.",
        DegenerateSpaceWarning,
        stacklevel=3,
    )
    return origin, directions[:n_kept].T / (largest or 1.0)


def representatives(points: Points) -> Int[np.ndarray, " n_kept"]:
    """The first of each group of points that coincide."""
    n = len(points)
    radius = MERGE * np.ptp(points, axis=0).max(initial=0.0)
    pairs = (
        KDTree(points).query_pairs(radius, output_type="ndarray")
        if points.shape[1]
        else _all_pairs(n)
    )
    if not len(pairs):
        return np.arange(n)
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(n, n))
    _, group = connected_components(graph, directed=False)
    kept = np.unique(group, return_index=True)[1]
    warnings.warn(
        f"{n - len(kept)} of {n} materials coincide with another in this space: they are one vertex of it.",
        DegenerateSpaceWarning,
        stacklevel=3,
    )
    return np.sort(kept)


def _all_pairs(n: int) -> Int[np.ndarray, "n_pairs 2"]:
    return np.stack([np.zeros(n - 1, np.intp), np.arange(1, n)], axis=1)


def _delaunay(points: Points) -> Int[np.ndarray, "n_simplices n_vertices"]:
    n, d = points.shape
    if d == 0:
        return np.zeros((1, 1), np.intp)
    if d == 1:
        order = points[:, 0].argsort()
        return np.stack([order[:-1], order[1:]], axis=1)
    if n == d + 1:
        return np.arange(n)[None]
    return Delaunay(points).simplices.astype(np.intp)


def _well_conditioned(matrices: Float64[np.ndarray, "n m m"]) -> Bool[np.ndarray, " n"]:
    """Which matrices have an inverse to rely on, by their condition number in the largest row sum."""
    invertible = np.linalg.det(matrices) != 0
    inverses = np.linalg.inv(
        np.where(invertible[:, None, None], matrices, np.eye(matrices.shape[1]))
    )
    size, inverse_size = (np.abs(m).sum(axis=2).max(axis=1) for m in (matrices, inverses))
    return invertible & (size * inverse_size < SINGULAR)


def _inside_interval(
    at_p: Float64[np.ndarray, "n m"], at_q: Float64[np.ndarray, "n m"]
) -> tuple[Float64[np.ndarray, " n"], Float64[np.ndarray, " n"]]:
    """From which t to which t in [0, 1] each row of (1 - t) at_p + t at_q is non-negative; empty where from > to."""
    slope = at_q - at_p
    with np.errstate(divide="ignore", invalid="ignore"):
        zero = -at_p / slope
    moving = np.abs(slope) > INSIDE
    enter = np.where(moving & (slope > 0), zero, 0.0).max(axis=1)
    leave = np.where(moving & (slope < 0), zero, 1.0).min(axis=1)
    never = (~moving & (at_p < -INSIDE)).any(axis=1)
    return np.where(never, 1.0, np.maximum(enter, 0.0)), np.where(
        never, 0.0, np.minimum(leave, 1.0)
    )
