"""How different the materials of a set are, and whether they are sound.

Distances are means over a lit sphere in CIELAB (`halfway.look.cielab_difference`; 2.3 is just noticeable on patches).

coverage    share of the library's materials that a sample looks at least as much like as the next material of the library does

Reference: M. F. Naeem, S. J. Oh, Y. Uh, Y. Choi, J. Yoo, "Reliable Fidelity and Diversity Metrics for Generative Models", ICML 2020,
section 3.2, with one neighbour.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float64

from ..tasks import HERE, Work
from .apart import Apart
from .candidates import Candidate


@dataclass(frozen=True, eq=False)
class Diversity:
    """Of the n samples of a set, beside the N materials of their library."""

    between: Float64[np.ndarray, " n"]
    """How far the nearest other sample is."""
    from_library: Float64[np.ndarray, " n"]
    """How far the nearest material of the library is."""
    reach: Float64[np.ndarray, " N"]
    """How far the nearest sample is from each material of the library."""
    within_library: Float64[np.ndarray, " N"]
    """How far the nearest other material is."""
    least: float
    """The least value of any sample, 1/sr."""
    albedo: float
    """The largest share of light that any sample reflects in a channel."""

    @classmethod
    def of(
        cls, samples: Sequence[Candidate], materials: Sequence[Candidate], *, work: Work = HERE
    ) -> "Diversity":
        """Of the samples of a set, beside the materials of the library alone."""
        theirs, ours = (
            Apart(np.stack([each.picture for each in some])) for some in (materials, samples)
        )

        def of_sample(i: int) -> tuple[float, float]:
            picture = samples[i].picture
            return ours.nearest(picture, but=i), theirs.nearest(picture)

        def of_material(i: int) -> tuple[float, float]:
            picture = materials[i].picture
            return ours.nearest(picture), theirs.nearest(picture, but=i)

        rows = work.run(of_sample, range(len(samples)), label="Nearest neighbours")
        between, from_library = np.array(list(rows)).T
        reach, within = np.array([of_material(i) for i in range(len(materials))]).T
        return cls(
            between,
            from_library,
            reach,
            within,
            min(each.least for each in samples),
            max(each.albedo for each in samples),
        )

    @property
    def nearest(self) -> Float64[np.ndarray, " n"]:
        """How far the nearest other sample or material of the library is from each."""
        return np.minimum(self.between, self.from_library)

    @property
    def coverage(self) -> float:
        """Share of the library's materials that the set covers."""
        return float((self.reach <= self.within_library).mean())

    def to_json(self) -> dict[str, Any]:
        return {
            "coverage": round(self.coverage, 4),
            "nearest_sample": _spread(self.between),
            "nearest_material": _spread(self.from_library),
            "library": {
                "nearest_material": _spread(self.within_library),
                "nearest_sample": _spread(self.reach),
            },
            "least_value": self.least,
            "largest_albedo": round(self.albedo, 4),
        }

    def lines(self) -> list[str]:
        """For people."""
        return [
            f"nearest sample: {_shown(self.between)}; among the library's materials {_shown(self.within_library)}",
            f"nearest material of the library: {_shown(self.from_library)}",
            f"coverage: {self.coverage:.0%} of the library's materials look no more like their neighbour than like a sample",
            f"laws: least value {self.least:.3g} 1/sr; reflects at most {self.albedo:.3f} of the light; reciprocal as mixes are",
        ]


def _spread(distances: Float64[np.ndarray, " n"]) -> dict[str, float]:
    low, median, high = np.quantile(distances, [0, 0.5, 1])
    return {"min": round(low, 3), "median": round(median, 3), "max": round(high, 3)}


def _shown(distances: Float64[np.ndarray, " n"]) -> str:
    spread = _spread(distances)
    return f"{spread['min']:.2f} to {spread['max']:.2f}, median {spread['median']:.2f}"
