"""How well a space places a material that it does not have.

Each material is taken out, placed at its own coordinates in the space of the others, or at the nearest point of their
hull, and mixed there. The error is the difference of that mix from the material's own table. A space with small errors
puts materials where its mixes look like them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Points
from ..brdf import MAPPINGS
from ..components import Pca
from ..errors import OutsideHullError
from ..look import appearance, cielab_difference
from ..space import DelaunayWalk, anchored_scale, nearest_in_hull
from ..tasks import HERE, Work
from .evaluation import Bench

Place = Callable[[int], Float64[np.ndarray, "3 N"]]
"""The weights over all materials where material i stands in the space of the others; its own weight is 0."""


@dataclass(frozen=True, eq=False)
class LeaveOneOut:
    """Errors of a space, one value per material in the library's order."""

    space: str
    names: tuple[str, ...]
    errors: Mapping[str, Float64[np.ndarray, " N"]]
    """By metric: those of `halfway.brdf.metrics`, "log by cell", and "seen", mean CIELAB in the judging scene."""

    def to_json(self) -> dict[str, Any]:
        """Mean and median error over the materials, and the worst material, by metric."""
        return {"space": self.space} | {
            metric: {
                "mean": float(errors.mean()),
                "median": float(np.median(errors)),
                "max": float(errors.max()),
                "worst": self.names[int(errors.argmax())],
            }
            for metric, errors in self.errors.items()
        }


def leave_one_out(name: str, place: Place, bench: Bench, *, work: Work = HERE) -> LeaveOneOut:
    """The errors of the space called ``name``, which places material i at ``place(i)``."""
    names = bench.samples.names
    measure = partial(_errors, place, bench)
    rows = list(work.run(measure, range(len(names)), label=f"Leaving one out of {name}"))
    return LeaveOneOut(name, names, {key: np.array([row[key] for row in rows]) for key in rows[0]})


@dataclass(frozen=True, eq=False)
class PaperPlace:
    """Where the paper's space of the others puts a material: their PCA, the material's scores in it, per channel.

    The Gram matrix ``U_ab = u_a . u_b`` of all materials holds what is needed. About the centroid of the others S it is

        U'_ab = U_ab - mean_s U_as - mean_s U_sb + mean_st U_st          s, t in S

    whose rows and columns in S have eigenvectors V and eigenvalues L; the material's score on component j is
    ``sum_s U'_is V_sj / sqrt(L_j)``.
    """

    pca: Pca
    n_components: int = 3

    def __call__(self, i: int) -> Float64[np.ndarray, "3 N"]:
        """The weights over all materials where material ``i`` stands in the space of the others."""
        others = np.delete(np.arange(len(self.pca.names)), i)
        weights = np.zeros((3, len(self.pca.names)))
        for c in range(3):
            v = self.pca.eigenvectors[c]
            placed = _project((v * self.pca.eigenvalues[c]) @ v.T, i, others, self.n_components)
            weights[c, others] = hull_weights(placed.others, placed.own)
        return weights


@dataclass(frozen=True, eq=False)
class AnchoredPlace:
    """Where the anchored space of the others puts a material: their joint PCA, as in `PaperPlace`, and its body colour."""

    pca: Pca
    body: Float64[np.ndarray, "N 3"]
    n_components: int = 3

    def __call__(self, i: int) -> Float64[np.ndarray, "3 N"]:
        """The weights over all materials where material ``i`` stands in the space of the others."""
        others = np.delete(np.arange(len(self.pca.names)), i)
        v = self.pca.eigenvectors
        gram = np.einsum("cij,cj,ckj->ik", v, self.pca.eigenvalues, v)
        placed = _project(gram, i, others, self.n_components)
        points = np.concatenate([placed.others, self.body[others]], axis=1)
        scale = anchored_scale(points, self.n_components)
        weights = np.zeros(len(self.pca.names))
        own = np.concatenate([placed.own, self.body[i]])
        weights[others] = hull_weights(points * scale, own * scale)
        return np.stack([weights] * 3)


class _Placed(NamedTuple):
    others: Points
    own: Float64[np.ndarray, " k"]


def _project(
    gram: Float64[np.ndarray, "N N"], i: int, others: np.ndarray, n_components: int
) -> _Placed:
    means = gram[:, others].mean(axis=1)
    centred = gram - means - means[:, None] + means[others].mean()
    eigenvalues, v = np.linalg.eigh(centred[np.ix_(others, others)])
    kept = slice(None, -n_components - 1, -1)
    scale = np.sqrt(np.maximum(eigenvalues[kept], 0))
    own = np.divide(
        centred[i, others] @ v[:, kept], scale, out=np.zeros_like(scale), where=scale > 0
    )
    return _Placed(v[:, kept] * scale, own)


def hull_weights(points: Points, x: Float64[np.ndarray, " k"]) -> Float64[np.ndarray, " n_points"]:
    """Delaunay weights of ``x`` over ``points``, or of the nearest point of their hull."""
    try:
        return DelaunayWalk.of(points).weights(x)
    except OutsideHullError:
        return nearest_in_hull(points, x)


def _errors(place: Place, bench: Bench, i: int) -> dict[str, float]:
    samples = bench.samples
    weights = np.stack([np.eye(len(samples.names))[i][None].repeat(3, 0), place(i)], axis=1)
    values = samples.mix(weights)
    looks = {metric: samples.features(values, metric) for metric in MAPPINGS}
    looks["log by cell"] = samples.features(values, by="cell")
    seen = appearance(bench.judging.mix(weights))
    errors = {name: float(np.linalg.norm(look[0] - look[1])) for name, look in looks.items()}
    return errors | {"seen": float(cielab_difference(seen[0], seen[1]))}
