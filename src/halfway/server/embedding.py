"""Spaces as something to look at: three coordinates a material.

Scores are ruled by the highlight and span five decades, so a plain plot is one heap with a few points far away. What is
shown is compressed along each axis,

    x' = asinh((x - centre) / spread)      centre: median; spread: median of |x - centre|

Straight lines of the space are curves in this picture; the triangulation's edges are drawn straight.
"""

from typing import Literal, TypeAlias

import numpy as np

from ..library import Pca
from ..space import PaperSpace, Space
from .schema import Channel, Embedding, ShownAxis, SpaceView

Edges: TypeAlias = list[tuple[int, int]]

CHANNELS: tuple[Channel, Channel, Channel] = ("r", "g", "b")


def look_at(space: Space, pca: Pca) -> SpaceView:
    """The space as points in three dimensions."""
    if isinstance(space, PaperSpace):
        embeddings = [
            _embedding(channel, triangulation.points, _edges(triangulation.simplices))
            for channel, triangulation in zip(CHANNELS, space.triangulations, strict=True)
        ]
    else:
        embeddings = [_embedding("all", joint_scores(pca), [])]
    return SpaceView(name=space.name, embeddings=embeddings)


def joint_scores(pca: Pca, n_components: int = 3) -> np.ndarray:
    """Scores of all channels together: of the sum of their Gram matrices; shape (N, k)."""
    gram = np.einsum("cik,ck,cjk->ij", pca.eigenvectors, pca.eigenvalues, pca.eigenvectors)
    eigenvalues, eigenvectors = np.linalg.eigh(gram)
    kept = eigenvectors[:, ::-1][:, :n_components]
    return kept * np.sqrt(np.maximum(eigenvalues[::-1][:n_components], 0.0))


def _embedding(channel: Channel | Literal["all"], points: np.ndarray, edges: Edges) -> Embedding:
    points = points[:, :3]
    axes = [_axis(f"score {i + 1}", x) for i, x in enumerate(points.T)]
    return Embedding(channel=channel, axes=axes, points=points.tolist(), edges=edges)


def _axis(name: str, x: np.ndarray) -> ShownAxis:
    centre = float(np.median(x))
    spread = float(np.median(np.abs(x - centre)))
    # Where most materials coincide the median says nothing: then the extent does.
    return ShownAxis(name=name, centre=centre, spread=spread or float(np.ptp(x)) or 1.0)


def _edges(simplices: np.ndarray) -> Edges:
    n = simplices.shape[1]
    pairs = np.concatenate([simplices[:, [i, j]] for i in range(n) for j in range(i + 1, n)])
    unique = np.unique(np.sort(pairs, axis=1), axis=0)
    return [(int(a), int(b)) for a, b in unique]
