"""Charts as something to look at: the coordinates of each material, and the edges between them."""

from typing import NamedTuple, TypeAlias

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from .._types import Points
from .chart import Channel, Chart

Edges: TypeAlias = list[tuple[int, int]]
N_AXES = 3
"""Coordinates that can be looked at together."""


class Embedding(NamedTuple):
    """The materials as points, whose first `N_AXES` coordinates are looked at."""

    name: str
    channel: Channel
    """Whose weights place a mix in it."""
    axes: list[str]
    """What the coordinates are."""
    points: Points
    """In the library's order; the point of a mix is the mix of the points."""
    edges: Edges
    """Of the triangulation, or of the hull, beyond which there is no mix."""


def embeddings_of(chart: Chart) -> list[Embedding]:
    """One embedding for each group of a chart's coordinates.

    A chart of one group shows its triangulation; several show the hull of each, for the triangulation has more dimensions.
    """
    groups, simplices = chart.coordinates.groups, chart.delaunay.simplices
    return [
        Embedding(
            group.label if chart.channel == "all" else chart.channel.upper(),
            chart.channel,
            [name.replace("_", " ") for name in group.names],
            group.points,
            _edges(simplices) if len(groups) == 1 else _hull(group.points[:, :N_AXES]),
        )
        for group in groups
    ]


def _hull(points: Points) -> Edges:
    """The edges of the hull; none where the points are flat."""
    extents = np.ptp(points, axis=0)
    if points.shape[1] < 2 or not extents.all():
        return []
    try:
        # Coordinates differ by orders of magnitude, and Qhull's tolerances are absolute.
        return _edges(ConvexHull(points / extents).simplices)
    except QhullError:
        return []


def _edges(simplices: np.ndarray) -> Edges:
    n = simplices.shape[1]
    pairs = np.concatenate([simplices[:, [i, j]] for i in range(n) for j in range(i + 1, n)])
    unique = np.unique(np.sort(pairs, axis=1), axis=0)
    return [(int(a), int(b)) for a, b in unique]
