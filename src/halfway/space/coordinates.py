"""Coordinates: the named numbers of each material that a space is made of.

They come in *groups* that belong together, such as the first scores of a principal component analysis or a body colour. Each
group has a unit, says how far its materials are spread where distances count, and knows the coordinates of a material that is not
in the library, and those that one of its own would have among the others, which leave-one-out asks for.

    Scores      of the library's PCA, of one channel or of all together
    Numbers     of each material by itself, such as its body colour
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Points
from ..components import Newcomer, Pca
from ..errors import SpaceError
from ..library import Library
from ..recipes import Blend


class LeftOut(NamedTuple):
    """Coordinates of a material that is left out, beside those of the others without it."""

    others: Points
    own: Float64[np.ndarray, " d"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Group(ABC):
    """Coordinates that belong together; every one is a linear functional of the BRDF, so a linear mix reproduces it."""

    label: str
    """For people: what the group is."""
    names: tuple[str, ...]
    points: Points
    """Shape (N, d), in the library's order."""
    spread: float | None = None
    """Root of the summed variances of the group where distances count; None leaves the numbers as they are."""
    unit: str = "1/sr"

    @abstractmethod
    def of(self, newcomer: Newcomer) -> Float64[np.ndarray, " d"]:
        """The coordinates of a material that is not in the library."""

    @abstractmethod
    def without(self, i: int) -> LeftOut:
        """The coordinates where material ``i`` is not in the library."""

    def scale_of(self, points: Points) -> Float64[np.ndarray, " d"]:
        """What ``points`` of this group are multiplied by where distances count."""
        if self.spread is None:
            return np.ones(points.shape[1])
        variance = np.square(points - points.mean(axis=0)).mean(axis=0).sum()
        return np.full(points.shape[1], self.spread / (np.sqrt(variance) or 1.0))


@dataclass(frozen=True, eq=False, kw_only=True)
class Numbers(Group):
    """Numbers that each material has by itself."""

    read: Callable[[Library], Points] | None = None
    """What reads them off the tables of a library; None where they are not of the tables."""

    def of(self, newcomer: Newcomer) -> Float64[np.ndarray, " d"]:
        if self.read is None:
            raise SpaceError(
                f"{self.label} of {newcomer.name} is not known: {', '.join(self.names)} cannot be read off a table. "
                "Choose another space."
            )
        return self.read(newcomer.alone)[0]

    def without(self, i: int) -> LeftOut:
        return LeftOut(np.delete(self.points, i, axis=0), self.points[i])


@dataclass(frozen=True, eq=False, kw_only=True)
class Scores(Group):
    """The first scores on the principal components of one channel, or of all channels together.

    The Gram matrix ``U_ab = u_a . u_b`` of all materials holds what leaving one out needs. About the centroid of the
    others S it is

        U'_ab = U_ab - mean_s U_as - mean_s U_sb + mean_st U_st          s, t in S

    whose rows and columns in S have eigenvectors V and eigenvalues L; the score of a material i that is not in S on
    component j is ``sum_s U'_is V_sj / sqrt(L_j)``. That of any other material is the same, with its own products U'_is; and
    with the scores ``Y_sj = V_sj sqrt(L_j)`` it is ``sum_s U'_is Y_sj / sum_s Y_sj^2``.
    """

    label: str = "Scores"
    pca: Pca
    channels: tuple[int, ...] = (0, 1, 2)
    blend: Blend | None = None
    """In whose mapping samples are, and then weighed by cosines; None: as they are."""

    @classmethod
    def joint(
        cls, pca: Pca, n: int, *, spread: float | None = None, blend: Blend | None = None
    ) -> "Scores":
        """The first ``n`` scores of all channels together: as many as there are."""
        points = pca.joint_scores(n)
        unit = blend.mapping.unit if blend else "1/sr"
        names = _score_names(points)
        return cls(names=names, points=points, spread=spread, unit=unit, pca=pca, blend=blend)

    @classmethod
    def of_channel(cls, pca: Pca, n: int, channel: int) -> "Scores":
        """The first ``n`` scores of one channel, as they are."""
        points = pca.scores(n)[channel]
        return cls(names=_score_names(points), points=points, pca=pca, channels=(channel,))

    def of(self, newcomer: Newcomer) -> Float64[np.ndarray, " d"]:
        along = newcomer.products(self.blend)[list(self.channels)].sum(axis=0) @ self.points
        squares = np.square(self.points).sum(axis=0)
        return np.divide(along, squares, out=np.zeros_like(squares), where=squares > 0)

    def without(self, i: int) -> LeftOut:
        others = np.delete(np.arange(len(self.points)), i)
        means = self._gram[:, others].mean(axis=1)
        centred = self._gram - means - means[:, None] + means[others].mean()
        eigenvalues, v = np.linalg.eigh(centred[np.ix_(others, others)])
        kept = slice(None, -self.points.shape[1] - 1, -1)
        scale = np.sqrt(np.maximum(eigenvalues[kept], 0))
        own = np.divide(
            centred[i, others] @ v[:, kept], scale, out=np.zeros_like(scale), where=scale > 0
        )
        return LeftOut(v[:, kept] * scale, own)

    @cached_property
    def _gram(self) -> Float64[np.ndarray, "N N"]:
        which = list(self.channels)
        v, eigenvalues = self.pca.eigenvectors[which], self.pca.eigenvalues[which]
        return np.einsum("cij,cj,ckj->ik", v, eigenvalues, v)


def _score_names(points: Points) -> tuple[str, ...]:
    return tuple(f"score_{i + 1}" for i in range(points.shape[1]))


@dataclass(frozen=True, eq=False)
class Coordinates:
    """The coordinates of the materials of a library: groups side by side."""

    groups: tuple[Group, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Of each coordinate."""
        return tuple(name for group in self.groups for name in group.names)

    @cached_property
    def points(self) -> Points:
        """Where each material is, shape (N, d)."""
        return np.concatenate([group.points for group in self.groups], axis=1)

    @cached_property
    def scale(self) -> Float64[np.ndarray, " d"]:
        """What the coordinates are multiplied by where distances count."""
        return self._scale([group.points for group in self.groups])

    def of(self, newcomer: Newcomer) -> Float64[np.ndarray, " d"]:
        """The coordinates of a material that is not in the library."""
        return np.concatenate([group.of(newcomer) for group in self.groups])

    def without(self, i: int) -> LeftOut:
        """The scaled coordinates where material ``i`` is not in the library; the scale is that of the others."""
        parts = [group.without(i) for group in self.groups]
        scale = self._scale([part.others for part in parts])
        others, own = (np.concatenate(each, axis=-1) for each in zip(*parts, strict=True))
        return LeftOut(others * scale, own * scale)

    def _scale(self, parts: Sequence[np.ndarray]) -> Float64[np.ndarray, " d"]:
        scales = [group.scale_of(part) for group, part in zip(self.groups, parts, strict=True)]
        return np.concatenate(scales)
