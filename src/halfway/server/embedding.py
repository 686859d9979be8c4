"""Spaces as something to look at: up to three coordinates a material, and the edges between them.

The page stretches each axis so that the materials spread evenly: scores are ruled by the highlight and span five
decades, and a plain plot is one heap with a few points far away.
"""

from typing import TypeAlias

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ..components import Pca
from ..space import AnchoredSpace, PaperSpace, Space
from .schema import Channel, Embedding, SpaceView

Edges: TypeAlias = list[tuple[int, int]]
CHANNELS: tuple[Channel, Channel, Channel] = ("r", "g", "b")
N_AXES = 3
"""Coordinates that can be looked at together."""


def look_at(space: Space, pca: Pca) -> SpaceView:
    """The space as points in up to three dimensions, in one view or several."""
    match space:
        case PaperSpace():
            embeddings = [
                Embedding(
                    name=channel.upper(),
                    channel=channel,
                    axes=_scores(triangulation.points),
                    points=triangulation.points[:, :N_AXES].tolist(),
                    edges=_edges(triangulation.simplices),
                )
                for channel, triangulation in zip(CHANNELS, space.triangulations, strict=True)
            ]
        case AnchoredSpace():
            scores, body = space.points[:, :-3][:, :N_AXES], space.points[:, -3:]
            embeddings = [
                _joint("Scores", _scores(scores), scores, _hull(scores)),
                _joint("Body colour", list(space.coordinates[-3:]), body, _hull(body)),
            ]
        case _:
            scores = pca.joint_scores(N_AXES)
            # Nothing of it is a place to go to.
            embeddings = [_joint("Scores", _scores(scores), scores, [])]
    return SpaceView(name=space.name, embeddings=embeddings)


def _joint(name: str, axes: list[str], points: np.ndarray, edges: Edges) -> Embedding:
    return Embedding(name=name, channel="all", axes=axes, points=points.tolist(), edges=edges)


def _scores(points: np.ndarray) -> list[str]:
    return [f"score {i + 1}" for i in range(min(N_AXES, points.shape[1]))]


def _hull(points: np.ndarray) -> Edges:
    """The edges of the hull, beyond which there is no mix; none where the points are flat."""
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
