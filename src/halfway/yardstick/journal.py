"""What a benchmark has measured so far, in a file: a run that is stopped goes on from there.

{"of": {...}, "seconds": 0}                              what all is measured of, and what it took before
{"unit": ["recover", "liu2023", "mine", 5, 0], "scores": ..., "seconds": 71.2}      one line for each part, once it is measured
"""

import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from ..errors import HalfwayError
from ..files import write_text
from ..locations import append_text
from ..tasks import Work

T = TypeVar("T")
Unit = tuple[str | int, ...]


class Journal:
    """The parts that are measured, by what they are; open one with `Journal.open`."""

    def __init__(self, path: Path | None, known: dict[Unit, Any], before: float = 0.0) -> None:
        self._path = path
        self._known = known
        self._start = time.monotonic() - before

    @property
    def seconds(self) -> float:
        """How long the run has taken, with what earlier ones noted."""
        return time.monotonic() - self._start

    @classmethod
    def open(cls, path: Path | None, of: Mapping[str, Any]) -> "Journal":
        """Of a run; with a path, what an earlier run noted there counts as measured; a `HalfwayError` where it measured something else."""
        if path is None:
            return cls(None, {})
        head, *lines = noted = list(_whole_lines(path)) or [{"of": of}]
        if differ := [name for name in of if head.get("of", {}).get(name) != of[name]]:
            raise HalfwayError(
                f"{path} holds results of a run that was stopped, of another {differ[0].replace('_', ' ')}: "
                "expected the same, to go on from there. Choose another folder with -o, or add --force to begin again."
            )
        known = {tuple(line["unit"]): line["scores"] for line in lines}
        journal = cls(path, known, noted[-1].get("seconds", 0.0))
        journal._rewrite(of)
        return journal

    def run(
        self, f: Callable[[T], Any], tasks: Sequence[T], unit: Unit, work: Work, *, label: str
    ) -> list[Any]:
        """``f`` of every task, in order; what is known is not measured again."""
        units = [(*unit, i) for i in range(len(tasks))]
        missing = [i for i, each in enumerate(units) if each not in self._known]
        results = work.run(f, [tasks[i] for i in missing], label=label)
        for i, scores in zip(missing, results, strict=True):
            self._add(units[i], scores)
        return [self._known[each] for each in units]

    def _add(self, unit: Unit, scores: Any) -> None:
        self._known[unit] = scores
        if self._path:
            append_text(self._path, _line(unit=unit, scores=scores, seconds=self.seconds))

    def _rewrite(self, of: Mapping[str, Any]) -> None:
        """Without a line that was cut off."""
        known = ({"unit": unit, "scores": scores} for unit, scores in self._known.items())
        lines = [_line(**each, seconds=self.seconds) for each in ({"of": of}, *known)]
        if self._path:
            write_text(self._path, "".join(lines))


def _whole_lines(path: Path) -> Iterator[Any]:
    """Up to one that is cut off."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    for line in text.splitlines():
        try:
            yield json.loads(line)
        except ValueError:
            return


def _line(**facts: Any) -> str:
    return json.dumps(facts) + "\n"
