"""How well a space places a material that it does not have.

Each material is taken out, placed at its own coordinates in the space of the others, or at the nearest point of their
hull, and mixed there. The error is the difference of that mix from the material's own table. A space with small errors
puts materials where its mixes look like them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float64

from ..brdf import metrics
from ..look import appearance, cielab_difference
from ..space import Space
from ..tasks import HERE, Work
from .evaluation import Bench


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


def leave_one_out(space: Space, bench: Bench, *, work: Work = HERE) -> LeaveOneOut:
    """The errors of a space, which places each material among the others."""
    names = bench.samples.names
    measure, label = partial(_errors, space, bench), f"Leaving one out of {space.name}"
    rows = list(work.run(measure, range(len(names)), label=label))
    errors = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    return LeaveOneOut(space.name, names, errors)


def _errors(space: Space, bench: Bench, i: int) -> dict[str, float]:
    samples = bench.samples
    weights = np.stack([np.eye(len(samples.names))[i][None].repeat(3, 0), space.without(i)], axis=1)
    values, pictures = bench.seen(weights, space.blend)
    looks: dict[str, np.ndarray] = {
        metric: samples.features(values, metric) for metric in metrics.MAPPINGS
    }
    looks["log by cell"] = samples.features(values, by="cell")
    seen = appearance(pictures)
    errors = {name: float(np.linalg.norm(look[0] - look[1])) for name, look in looks.items()}
    return errors | {"seen": float(cielab_difference(seen[0], seen[1]))}
