"""A set of samples: new materials as recipes, each with a name and the split that it belongs to."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from ..library import Library, LibraryRef, Permuted
from ..recipes import Blend, Recipe
from .candidates import Candidate
from .diversity import Diversity

FORMAT = 2
"""Of recipes.json, as a route writes it too."""


class Sample(NamedTuple):
    """A new material."""

    name: str
    """Its number, and the two materials that it is most of."""
    split: str
    recipe: Recipe
    nearest: float
    """How far the sample, or the library's material, is that looks most like it."""

    def to_json(self) -> dict[str, Any]:
        weights = self.recipe.to_json()["weights"]
        return {
            "name": self.name,
            "split": self.split,
            "nearest": round(self.nearest, 3),
            "weights": weights,
        }


@dataclass(frozen=True, eq=False)
class SampleSet:
    """New materials of one library."""

    library: Library
    """Whose recipes they are."""
    samples: tuple[Sample, ...]
    splits: Mapping[str, Sequence[str]]
    """The materials that the samples of each split are mixed from."""
    how: Mapping[str, Any]
    """How they came about, as JSON."""
    diversity: Diversity

    @classmethod
    def of(
        cls,
        library: Library,
        blend: Blend,
        by_split: Mapping[str, Sequence[Candidate]],
        splits: Mapping[str, Sequence[str]],
        *,
        how: Mapping[str, Any],
        diversity: Diversity,
    ) -> "SampleSet":
        """The set of candidates over the materials of ``library``, split by split."""
        chosen = [(split, each) for split, some in by_split.items() for each in some]
        is_permuted = any(each.weighed.order != Permuted.ORDERS[0] for _, each in chosen)
        of = Permuted(library) if is_permuted else library
        digits = max(4, len(str(len(chosen))))
        samples = [
            Sample(
                f"{i:0{digits}d}-{_title(library.names, each)}",
                split,
                _recipe(LibraryRef.of(of), library.names, blend, each),
                nearest,
            )
            for i, ((split, each), nearest) in enumerate(
                zip(chosen, diversity.nearest, strict=True)
            )
        ]
        return cls(of, tuple(samples), splits, how, diversity)

    def __len__(self) -> int:
        return len(self.samples)

    def __repr__(self) -> str:
        return f"<SampleSet of {len(self)} materials of {self.library.name!r}>"

    @property
    def blend(self) -> Blend:
        """How they are mixed."""
        return self.samples[0].recipe.blend

    def to_json(self) -> dict[str, Any]:
        """The document ``recipes.json``."""
        return {
            "format": FORMAT,
            "library": self.library.name,
            "blend": str(self.blend),
            "drawn": dict(self.how),
            "splits": {split: list(names) for split, names in self.splits.items()},
            "diversity": self.diversity.to_json(),
            "recipes": [sample.to_json() for sample in self.samples],
            "library_address": self.library.address,
            "library_checksum": self.library.checksum,
            **asdict(self.library.origin),
        }


def _recipe(
    library: LibraryRef, names: Sequence[str], blend: Blend, candidate: Candidate
) -> Recipe:
    """Its recipe; of materials whose channels are in its order, each weighs in the channel that it came from."""
    weights, order = candidate.weighed
    ordered = [Permuted.name_of(name, order) for name in names]
    return Recipe.from_dense(library, ordered, weights[Permuted.channels(order)], blend)


def _title(names: Sequence[str], candidate: Candidate) -> str:
    weights, order = candidate.weighed
    mean = weights.mean(axis=0)
    largest = np.argsort(-mean, kind="stable")[:2]
    title = "-".join(names[int(i)] for i in largest if mean[i] > 0)
    return Permuted.name_of(title, order)
