"""What the benchmarks share: the one table at the end.

It is printed when all is done, and written to figures.json for `table.py`; what was not run stays there as it was.
"""

import json
import os
import platform
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path

import pytest

FIGURES = Path(__file__).parent / "figures.json"


@dataclass(frozen=True)
class Figure:
    """One line of the table."""

    what: str
    compared: str
    """What the ratio is of: ``theirs / ours`` where larger is better, ``ours / limit`` where smaller is."""
    ratio: float
    goal: str = ""
    """``<= 1.5`` or ``>= 10``, where one was set."""
    note: str = ""
    """What one side takes, as measured."""
    date: str = field(default_factory=partial(time.strftime, "%Y-%m-%d"))

    @property
    def missed(self) -> bool:
        sign, _, number = self.goal.partition(" ")
        return (
            bool(sign)
            and not {"<=": self.ratio <= float(number), ">=": self.ratio >= float(number)}[sign]
        )


class Figures(list[Figure]):
    """The table so far."""

    def note(
        self, what: str, compared: str, ratio: float, *, goal: str = "", note: str = ""
    ) -> None:
        self.append(Figure(what, compared, float(f"{ratio:.3g}"), goal, note))


@pytest.fixture(scope="session")
def figures(request: pytest.FixtureRequest) -> Iterator[Figures]:
    measured = Figures()
    request.config.stash[_KEY] = measured
    yield measured
    about = {
        "cores": os.cpu_count(),
        "processor": _processor(),
        "python": platform.python_version(),
    }
    rows = {
        (row["what"], row["compared"]): row
        for row in [*json.loads(FIGURES.read_text())["figures"], *map(asdict, measured)]
    }
    FIGURES.write_text(
        json.dumps({"about": about, "figures": list(rows.values())}, indent=1) + "\n"
    )


def _processor() -> str:
    """What the processor calls itself."""
    about = Path("/proc/cpuinfo")
    lines = about.read_text().splitlines() if about.exists() else []
    names = (line.partition(": ")[2] for line in lines if line.startswith("model name"))
    return next(names, platform.machine())


_KEY = pytest.StashKey[Figures]()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    measured = terminalreporter.config.stash.get(_KEY, None)
    if not measured:
        return
    terminalreporter.section("figures: ratios measured in this run")
    for f in measured:
        goal = f"goal {f.goal}{': missed' if f.missed else ''}" if f.goal else ""
        terminalreporter.write_line(
            f"{f.what:44}  {f.compared:44}  {f.ratio:8.4g}  {goal:22}  {f.note}"
        )


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory):
    """The built-in library, stored: 100 materials on the MERL grid."""
    from halfway import build_library

    return build_library(
        ["builtin:merl-abc"], tmp_path_factory.mktemp("bench") / "merl.brdflib"
    ).library
