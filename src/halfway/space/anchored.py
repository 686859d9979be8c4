"""The anchored space: one recipe for all channels, and colours that go straight.

Barycentric weights reproduce every coordinate of a point that is a *linear* functional of the BRDF. So the
coordinates of a material are the first k scores of all channels together (k = 3), and its body colour, the mean
beside the highlight, one number per channel:

    y = (score_1, ..., score_k, body_r, body_g, body_b)

Along a straight line in this space the body colour of the mix goes straight as well: brown to grey does not pass green.
The scores are scaled together to unit variance, the body colours to `BODY_SCALE`: the scale decides which materials are
near, not what is reproduced.

Two recipes reproduce every place on the line from material A to material B: the Delaunay weights, which mix the
materials nearest to it, and the two ends in plain proportion. The first passes through real materials and may wander in
what the coordinates do not say; the second never wanders, and shows two highlights at once. Any blend of the two
reproduces the same coordinates:

    w(t) = b w_Delaunay(t) + (1 - b) ((1 - t) A + t B),    0 <= b <= 1

A leg takes the largest b (of `SHARES`) whose path, in pictures of a lit sphere, is at most ``detour`` times as long as
the distance of its ends. ``detour`` = 1 gives the ends alone (or nearly), infinity the space alone.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float64

from .._types import Points
from ..components import Pca
from ..errors import OutsideHullError, SpaceError
from ..library import Library
from ..look import Looks, appearance, cielab_difference
from ..recipes import Recipe
from .hull import nearest_in_hull
from .spaces import Leg, Space, interpolate
from .triangulation import corners
from .walk import DelaunayWalk

BODY_SCALE = 0.3
"""Spread of the body colours, where that of the scores is 1."""
DETOUR = 1.1
"""Largest length of a leg, as a multiple of the distance of its ends."""
SHARES = np.linspace(1, 0, 17)
"""Shares of the Delaunay weights that a leg tries, from the largest."""
N_PICTURES = 33
"""Pictures that a leg is measured in."""
THINNING = 4
"""Every so many pixels of the basis images are enough to measure with."""


@dataclass(frozen=True, eq=False)
class AnchoredSpace(Space):
    """The anchored space of a library."""

    library: str
    names: tuple[str, ...]
    coordinates: tuple[str, ...]
    """What each coordinate is: ``score_1`` ..., ``body_r``, ``body_g``, ``body_b``, in 1/sr."""
    points: Points
    """Where each material is, shape (N, k + 3)."""
    detour: float
    scale: Float64[np.ndarray, " d"]
    """What the coordinates are multiplied by where distances count."""
    _walk: DelaunayWalk
    _images: Looks
    name = "anchored"

    @classmethod
    def fit(
        cls,
        library: Library,
        pca: Pca,
        images: Looks,
        body: Float64[np.ndarray, "N 3"],
        *,
        n_components: int = 3,
        detour: float = DETOUR,
    ) -> "AnchoredSpace":
        """The space of ``n_components`` joint scores and the body colours ``body`` of the materials, in 1/sr.

        Raises
        ------
        SpaceError
            With fewer than 0 components, or a detour below 1.
        """
        if n_components < 0:
            raise SpaceError(
                f"a space of {n_components} components cannot be made: expected 0 or more."
            )
        if not detour >= 1:
            raise SpaceError(
                f"a detour of {detour:g} is shorter than the direct way: expected 1 or more."
            )
        scores = pca.joint_scores(n_components)
        points = np.concatenate([scores, body], axis=1)
        scale = anchored_scale(points, scores.shape[1])
        return cls(
            library.name,
            library.names,
            (*(f"score_{i + 1}" for i in range(scores.shape[1])), "body_r", "body_g", "body_b"),
            points,
            detour,
            scale,
            DelaunayWalk.of(points * scale),
            replace(images, planes=images.planes[..., ::THINNING]),
        )

    def leg(self, start: int, stop: int) -> Leg:
        path = self._walk.path(start, stop)
        ends = corners(len(self.names), start, stop)
        straight = interpolate(path.knots, np.array([0.0, 1.0]), ends)
        share = self._share(Leg(path.knots, np.stack([path.weights, straight])))
        weights = share * path.weights + (1 - share) * straight
        return Leg(path.knots, np.stack([weights] * 3))

    def recipe(
        self, point: Mapping[str, float] | Float64[np.ndarray, " d"], *, clamp: bool = False
    ) -> Recipe:
        """The recipe of any point: the Delaunay weights of the materials around it.

        Parameters
        ----------
        point : array of shape (d,), or mapping
            Every coordinate, in the order or by the names of `coordinates`.
        clamp : bool
            Take the nearest point of the hull where the point is outside.

        Raises
        ------
        OutsideHullError
            When the point is outside the hull; the message has the distance and the nearest point.
        """
        x = self._coordinates_of(point) * self.scale
        try:
            weights = self._walk.weights(x)
        except OutsideHullError:
            weights = nearest_in_hull(self.points * self.scale, x)
            if not clamp:
                raise OutsideHullError(self._outside(x, weights)) from None
        return Recipe.from_dense(self.library, self.names, np.stack([weights] * 3))

    def neighbours(self, name: str, n: int = 8) -> list[tuple[str, float]]:
        """The ``n`` materials nearest to one, with their distances in the scaled space, nearest first."""
        scaled = self.points * self.scale
        distances = np.linalg.norm(scaled - scaled[self.names.index(name)], axis=1)
        nearest = distances.argsort(kind="stable")[1 : n + 1]
        return [(self.names[i], float(distances[i])) for i in nearest]

    def to_json(self) -> dict[str, Any]:
        """The names of the coordinates and the place of each material."""
        places = dict(zip(self.names, self.points.tolist(), strict=True))
        return {
            "format": 1,
            "library": self.library,
            "space": self.name,
            "detour": self.detour,
            "coordinates": list(self.coordinates),
            "unit": "1/sr",
            "points": places,
        }

    def _share(self, ways: Leg) -> float:
        """The largest share of the Delaunay weights whose path is short enough; ``ways`` holds it and the straight way."""
        t = np.linspace(0, 1, N_PICTURES)
        winding, straight = (
            self._images.mix(np.stack([interpolate(t, ways.knots, way)] * 3))
            for way in ways.weights
        )
        for share in SHARES[:-1]:
            pictures = appearance(share * winding + (1 - share) * straight)
            length = cielab_difference(pictures[1:], pictures[:-1]).sum()
            if length <= self.detour * cielab_difference(pictures[0], pictures[-1]):
                return float(share)
        return 0.0

    def _coordinates_of(self, point: Mapping[str, float] | np.ndarray) -> Float64[np.ndarray, " d"]:
        if isinstance(point, Mapping):
            missing = [name for name in self.coordinates if name not in point]
            unknown = [name for name in point if name not in self.coordinates]
            if missing or unknown:
                raise SpaceError(
                    f"the point lacks {missing} and has {unknown}: expected the coordinates {', '.join(self.coordinates)}."
                )
            point = np.array([point[name] for name in self.coordinates])
        if len(point) != len(self.coordinates):
            raise SpaceError(
                f"the point has {len(point)} coordinates: expected {len(self.coordinates)}, {', '.join(self.coordinates)}."
            )
        return np.asarray(point, np.float64)

    def _outside(self, x: Float64[np.ndarray, " d"], weights: Float64[np.ndarray, " N"]) -> str:
        nearest = weights @ self.points
        distance = np.linalg.norm(nearest * self.scale - x)
        listed = ",".join(f"{value:.6g}" for value in nearest)
        return (
            f"the point is outside the hull of the {len(self.names)} materials, {distance:.3g} from it (materials are "
            f"about 1 apart): no mix stands there. The nearest that does is {listed}; --clamp takes it."
        )


def anchored_scale(points: Points, n_components: int) -> Float64[np.ndarray, " d"]:
    """What to multiply coordinates by: the scores together to spread 1, the body colours to `BODY_SCALE`."""
    spread = np.square(points - points.mean(axis=0)).mean(axis=0)
    scores, body = (
        np.sqrt(part.sum()) or 1.0 for part in (spread[:n_components], spread[n_components:])
    )
    return np.array([1 / scores] * n_components + [BODY_SCALE / body] * 3)
