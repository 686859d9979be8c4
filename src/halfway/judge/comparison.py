"""All spaces of a library, measured side by side."""

from typing import Any

from ..library import Library
from ..recipes import Blend
from ..space import SPACES, make_space
from ..tasks import HERE, Work
from .evaluation import Bench, evaluate, sample_pairs
from .leave_one_out import leave_one_out


def compare_spaces(
    library: Library, *, n_pairs: int | None = None, seed: int = 0, work: Work = HERE
) -> list[dict[str, Any]]:
    """Every space, and the first in every blend, on the same pairs of materials (None: all), and leaving out each in turn, as JSON."""
    bench = Bench.fit(library, work=work)
    pairs = sample_pairs(len(library), n_pairs, seed=seed)
    measured: list[dict[str, Any]] = []
    first, *others = SPACES
    usual = SPACES[first].usual_blend
    blends = [usual, *(blend for blend in Blend if blend is not usual)]
    for name, blend in [*((first, blend) for blend in blends), *((name, None) for name in others)]:
        space = make_space(name, library, blend=blend, looks=bench.pacing, work=work)
        measures = {"seed": seed, **evaluate(space, bench, pairs, work=work).to_json()}
        measures["blend"] = str(space.blend)
        if space.charts:
            left_out = leave_one_out(space, bench, work=work).to_json()
            del left_out["space"]
            measures["leave_one_out"] = left_out
        measured.append(measures)
    return measured
