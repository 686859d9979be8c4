"""The anchored space: one recipe for all channels, and colours that go straight.

Barycentric weights reproduce every coordinate of a point that is a *linear* functional of the BRDF. So the
coordinates of a material are the first k scores of all channels together (k = 3), and its body colour, the mean
beside the highlight, one number per channel:

    y = (score_1, ..., score_k, body_r, body_g, body_b)

Along a straight line in this space the body colour of the mix goes straight as well: brown to grey does not pass green.
The scores are scaled together to unit variance, the body colours to `BODY_SPREAD`: the scale decides which materials are
near, not what is reproduced. Any other linear coordinates may stand beside these or in their place.

Two recipes reproduce every place on the line from material A to material B: the Delaunay weights, which mix the
materials nearest to it, and the two ends in plain proportion. The first passes through real materials and may wander in
what the coordinates do not say; the second never wanders, and shows two highlights at once. Any blend of the two
reproduces the same coordinates:

    w(t) = b w_Delaunay(t) + (1 - b) ((1 - t) A + t B),    0 <= b <= 1

A leg takes the largest b (of `SHARES`) whose path, in pictures of a lit sphere, is at most ``detour`` times as long as
the distance of its ends. ``detour`` = 1 gives the ends alone (or nearly), infinity the space alone.
"""

from bisect import bisect_left
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float64

from ..components import MappedRows, Pca
from ..errors import SpaceError
from ..library import Library, LibraryRef
from ..look import Looks, appearance, body_colours, cielab_difference
from ..recipes import Blend
from ..tasks import HERE, Work
from .chart import Chart
from .coordinates import Coordinates, Group, Numbers, Scores
from .space import Space
from .way import Way

N_COMPONENTS = 4
"""Joint scores: with three a material that is left out is placed worse, with five ways wander."""
BODY_SPREAD = 0.3
"""Spread of the body colours, where that of the scores is 1."""
DETOUR = 1.1
"""Largest length of a leg, as a multiple of the distance of its ends."""
SHARES = np.linspace(1, 0, 17)
"""Shares of the Delaunay weights that a leg tries, from the largest."""
N_PICTURES = 17
"""Pictures that a leg is measured in."""
THINNING = 4
"""Every so many pixels of the looks are enough to measure with."""


@dataclass(frozen=True, eq=False, repr=False)
class AnchoredSpace(Space):
    """The anchored space of a library."""

    detour: float
    _looks: Looks
    name = "anchored"
    summary = "one recipe for all channels; keeps body colours on the straight way between them"
    usual_blend = Blend.LOBES

    @classmethod
    def fit(
        cls,
        library: Library,
        *,
        n_components: int | None = None,
        detour: float = DETOUR,
        blend: Blend = Blend.LOBES,
        looks: Looks | None = None,
        work: Work = HERE,
    ) -> "AnchoredSpace":
        """The space of ``n_components`` joint scores and the body colours of the materials, in the mapping of a blend.

        Without ``n_components`` it has `N_COMPONENTS`, or as many as the materials and their body colours leave. ``looks`` are
        the library's, where they are at hand.

        Raises
        ------
        SpaceError
            With fewer than 0 components, or a detour below 1.
        """
        k = min(N_COMPONENTS, max(0, len(library) - 4)) if n_components is None else n_components
        if k < 0:
            raise SpaceError(f"a space of {k} components cannot be made: expected 0 or more.")
        pca = Pca.fit(MappedRows(library, blend), work=work)
        scores = Scores.joint(pca, k, spread=1.0, blend=blend)
        body = body_group(body_colours(library, blend=blend, work=work), blend)
        return cls.of(
            LibraryRef.of(library),
            Coordinates((scores, body)),
            looks or Looks.fit(library, work=work),
            detour=detour,
            blend=blend,
        )

    @classmethod
    def of(
        cls,
        library: LibraryRef,
        coordinates: Coordinates,
        looks: Looks,
        *,
        detour: float = DETOUR,
        blend: Blend = Blend.LINEAR,
    ) -> "AnchoredSpace":
        """The space of any linear ``coordinates`` of the materials, which ``looks`` shows.

        Raises
        ------
        SpaceError
            With a detour below 1.
        """
        if not detour >= 1:
            raise SpaceError(
                f"a detour of {detour:g} is shorter than the direct way: expected 1 or more."
            )
        chart = Chart.of(coordinates)
        return cls(library, looks.names, (chart,), detour, looks.thinned(THINNING), blend=blend)

    def leg(self, start: int, stop: int) -> Way:
        (chart,) = self.charts
        winding = chart.way(start, stop)
        straight = Way.between(start, stop, len(self.names)).at(winding.knots)

        def leg(i: int) -> Way:
            share = SHARES[i]
            way = Way(winding.knots, share * winding.weights + (1 - share) * straight)
            return Way.of_channels([way])

        return leg(bisect_left(range(len(SHARES) - 1), True, key=lambda i: self._is_short(leg(i))))

    def to_json(self) -> dict[str, Any]:
        """The names of the coordinates, the point of each material, and the longest detour."""
        return {**super().to_json(), "detour": self.detour}

    def _is_short(self, leg: Way) -> bool:
        weights = leg.at(np.linspace(0, 1, N_PICTURES))
        pictures = appearance(self._looks.mix(weights, self.blend))
        length = cielab_difference(pictures[1:], pictures[:-1]).sum()
        return bool(length <= self.detour * cielab_difference(pictures[0], pictures[-1]))


def body_group(body: Float64[np.ndarray, "N 3"], blend: Blend = Blend.LINEAR) -> Group:
    """Body colours as coordinates, in the mapping of a blend."""
    names = ("body_r", "body_g", "body_b")
    return Numbers(
        label="Body colour",
        names=names,
        points=body,
        spread=BODY_SPREAD,
        unit=blend.mapping.unit,
        read=partial(body_colours, blend=blend),
    )
