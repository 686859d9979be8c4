"""Spaces as something to look at: up to three coordinates a material, and the edges between them.

The page stretches each axis so that the materials spread evenly: scores are ruled by the highlight and span five
decades, and a plain plot is one heap with a few points far away.
"""

from typing import Literal, TypeAlias

import numpy as np

from ..library import Pca
from ..space import PaperSpace, Space
from .schema import Channel, Embedding, SpaceView

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
    axes = [f"score {i + 1}" for i in range(points.shape[1])]
    return Embedding(channel=channel, axes=axes, points=points.tolist(), edges=edges)


def _edges(simplices: np.ndarray) -> Edges:
    n = simplices.shape[1]
    pairs = np.concatenate([simplices[:, [i, j]] for i in range(n) for j in range(i + 1, n)])
    unique = np.unique(np.sort(pairs, axis=1), axis=0)
    return [(int(a), int(b)) for a, b in unique]
