"""What a benchmark measured."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from ..origin import Origin
from .scores import MEASURES, Scores

FORMAT = 1


@dataclass(frozen=True)
class Result:
    """The scores of one method in one setting."""

    task: str
    split: str
    method: str
    setting: int
    """k of `reconstruct`, n of `recover`; 0 where there is none."""
    n_materials: int
    scores: Scores
    """Means over the materials."""
    low: Scores = field(default_factory=dict[str, float])
    high: Scores = field(default_factory=dict[str, float])
    """Where directions are drawn: the ends of the middle 95 % of the draws' means."""
    n_draws: int = 1

    @classmethod
    def of(
        cls, task: str, split: str, method: str, setting: int, draws: Sequence[Sequence[Scores]]
    ) -> "Result":
        """Of the scores of each material, in each draw."""
        names = list(draws[0][0])
        means = np.array(
            [[np.mean([row[name] for row in rows]) for name in names] for rows in draws]
        )

        def named(values: np.ndarray) -> dict[str, float]:
            return dict(zip(names, values.tolist(), strict=True))

        low, high = np.quantile(means, [0.025, 0.975], axis=0)
        interval = (named(low), named(high)) if len(draws) > 1 else ({}, {})
        n = len(draws[0])
        return cls(
            task, split, method, setting, n, named(means.mean(axis=0)), *interval, len(draws)
        )


@dataclass(frozen=True)
class Benchmark:
    """All results, and of what."""

    library: str
    checksum: str
    origin: Origin
    grid: tuple[int, ...]
    seed: int
    results: tuple[Result, ...]
    seconds: float
    skipped: Mapping[str, str] = field(default_factory=dict[str, str])
    """What was not measured, and why."""

    def of(self, task: str, split: str = "") -> list[Result]:
        """The results of a task, on a split."""
        return [r for r in self.results if r.task == task and split in ("", r.split)]

    def to_json(self) -> dict[str, Any]:
        """The document ``benchmark.json``."""
        return {
            "format": FORMAT,
            **asdict(self),
            "measures": {name: measure._asdict() for name, measure in MEASURES.items()},
        }

    def lines(self) -> list[str]:
        """Each result in a line: its leading measure."""
        return [_line(result) for result in self.results]


LEADING = {"halfway": "log", "triplets": "majority"}
"""The measure of a task that says most; `mean-log` of the others."""


def _line(result: Result) -> str:
    name = LEADING.get(result.task, "mean-log")
    setting = f" {result.setting}" if result.setting else ""
    return (
        f"{result.task}{setting}, {result.split}: {result.method}: {name} {result.scores[name]:.4f}"
    )
