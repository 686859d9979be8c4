"""``halfway benchmark``: the yardstick."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..locations import DEFAULT_LIBRARY
from .console import say, show, show_json, work
from .options import AsJson, Force, GridText, Lib, output_to

if TYPE_CHECKING:
    from halfway.yardstick import RecoveryMethod

PROCESS_DRAWS = 3
"""Of directions for the neural process, of which one table takes seconds."""


class SplitName(StrEnum):
    liu2023 = "liu2023"
    kind = "kind"
    leave_one_out = "leave-one-out"


Quick = Annotated[
    bool, typer.Option("--quick", help="A coarse grid, one split, few settings: a minute or two.")
]
Splits = Annotated[
    list[SplitName] | None,
    typer.Option("--split", help="One or more. [default: all; of the quick one, liu2023]"),
]
Answers = Annotated[
    Path | None,
    typer.Option(metavar="CSV", help="Answered triplets: reference,a,b,votes_a,votes_b."),
]
Process = Annotated[
    Path | None,
    typer.Option("--neural-process", metavar="H5", help="The networks of Zheng et al. 2021."),
]
PageFolder = Annotated[Path | None, output_to("DIR", "The folder to write. [default: benchmark]")]


def benchmark(
    lib: Lib = DEFAULT_LIBRARY,
    output: PageFolder = None,
    quick: Quick = False,
    split: Splits = None,
    grid: GridText = "",
    seed: Annotated[int, typer.Option(help="Of directions that are drawn.")] = 0,
    answers: Answers = None,
    neural_process: Process = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Measure how materials are reconstructed, recovered, mixed and compared, on one page beside what others published.

    \b
    halfway benchmark --quick
    halfway benchmark merl_nbrdf.zip -o yardstick
    halfway benchmark merl.brdflib --split liu2023 --answers answers.csv --neural-process weights.h5
    """
    from contextlib import nullcontext

    from halfway import yardstick
    from halfway.batch import filling, keeping
    from halfway.library import open_library

    from .arguments import parse_grid

    fits, recoveries = _methods(neural_process)
    library = open_library(lib)
    folder = output or (None if as_json else Path("benchmark"))
    kept = keeping(folder, "measured.jsonl", "benchmark", force=force) if folder else nullcontext()
    with kept as journal:
        measured = yardstick.benchmark(
            library,
            quick=quick,
            grid=parse_grid(grid),
            splits=split,
            seed=seed,
            answers=answers,
            recoveries=recoveries,
            fits=fits,
            journal=journal,
            work=work(),
        )
    if folder:
        with filling(folder, "benchmark", force=force) as scratch:
            yardstick.write_page(scratch, measured)
    if as_json:
        show_json(measured.to_json())
    else:
        show(*measured.lines())
    if folder:
        say(f"{folder}: benchmark.html, and every number in benchmark.json")


def _methods(neural_process: Path | None) -> tuple[dict[str, Any], dict[str, "RecoveryMethod"]]:
    """The networks of a file as methods, and all that recover."""
    from halfway.yardstick import RECOVERIES, NeuralProcess, RecoveryMethod

    if not neural_process:
        return {}, {**RECOVERIES}
    process = NeuralProcess.read(neural_process)
    networks = {
        "neural process, planned directions": RecoveryMethod(process.planned),
        "neural process, random directions": RecoveryMethod(process.unplanned, PROCESS_DRAWS),
    }
    return {"neural process": process.reconstruct}, {**RECOVERIES, **networks}
