"""Spaces as something to look at: three coordinates a material.

Scores are ruled by the highlight and span five decades, so a plain plot is one heap with a few points far away. What is
shown is compressed along each axis,

    x' = asinh((x - median) / m)      m = median of |x - median|

scaled to [-1, 1]. Straight lines of the space are curves in this picture; the triangulation's edges are drawn straight.
"""

import numpy as np

from ..library import Pca
from ..space import PaperSpace, Space
from .schema import Channel, Embedding, SpaceView

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


def _embedding(
    channel: Channel | str, scores: np.ndarray, edges: list[tuple[int, int]]
) -> Embedding:
    n_axes = min(3, scores.shape[1])
    points = np.zeros((len(scores), 3))
    points[:, :n_axes] = np.stack([_compressed(x) for x in scores[:, :n_axes].T], axis=1)
    return Embedding.model_validate(
        {
            "channel": channel,
            "axes": [f"score {i + 1}" for i in range(n_axes)],
            "points": [tuple(point) for point in points.round(5).tolist()],
            "edges": edges,
        }
    )


def _compressed(x: np.ndarray) -> np.ndarray:
    away = x - np.median(x)
    spread = np.median(np.abs(away))
    compressed = np.arcsinh(away / spread) if spread > 0 else away
    low, high = compressed.min(), compressed.max()
    return 2 * (compressed - low) / (high - low) - 1 if high > low else np.zeros_like(x)


def _edges(simplices: np.ndarray) -> list[tuple[int, int]]:
    n = simplices.shape[1]
    pairs = np.concatenate([simplices[:, [i, j]] for i in range(n) for j in range(i + 1, n)])
    unique = np.unique(np.sort(pairs, axis=1), axis=0)
    return [(int(a), int(b)) for a, b in unique]
