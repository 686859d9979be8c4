"""``halfway report``: the paper's table and figures, for any library."""

from contextlib import nullcontext
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from .console import say, show, show_json, working
from .options import Force, Lib, Scheduler, output_to

if TYPE_CHECKING:
    from ..library import Library

Folder = Annotated[str | None, output_to("DIR", "A folder, or its URL. [default: report]")]
Components = Annotated[
    str, typer.Option("-k", metavar="LIST", help="Numbers of components in Table I.")
]
Pairs = Annotated[
    int,
    typer.Option(
        help="Pairs of materials that spaces are compared on; 0 compares none, -1 takes all."
    ),
]


def report(
    lib: Lib = DEFAULT_LIBRARY,
    output: Folder = None,
    components: Components = "3,5,15,30,36,45",
    pairs: Pairs = 0,
    seed: Annotated[int, typer.Option(help="Of the sample of pairs.")] = 0,
    as_json: Annotated[
        bool,
        typer.Option(
            "--json", help="Print report.json, or the plan of --dry-run; write files only with -o."
        ),
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say what it takes: blocks, memory, time; and stop.")
    ] = False,
    scheduler: Scheduler = "",
    force: Force = False,
) -> None:
    """Principal components of a library: Table I, eigenvalues, triangulation; and how well spaces move in it.

    \b
    halfway report merl.brdflib -o report
    halfway report merl_nbrdf.zip --pairs 200
    halfway report -k 1,2,10 --json
    halfway report builtin:synthetic-2000 --dry-run
    """
    from halfway.batch import filling
    from halfway.components import Pca
    from halfway.export import Report, write_report
    from halfway.judge import compare_spaces
    from halfway.library import open_library
    from halfway.locations import to_location

    from .arguments import parse_counts

    counts = parse_counts(components)
    library = open_library(lib)
    if dry_run:
        _say_plan(library, as_json)
        return
    output = output or ("" if as_json else "report")
    folder = to_location(output)
    with filling(folder, "report", force=force) if output else nullcontext() as scratch:
        with working(scheduler) as work:
            pca = Pca.fit(library, work=work)
            n_pairs = None if pairs < 0 else pairs
            spaces = compare_spaces(library, n_pairs=n_pairs, seed=seed, work=work) if pairs else []
        report = Report.of(library, pca, n_components=counts, spaces=spaces)
        if scratch:
            write_report(scratch, library, pca, n_components=counts, spaces=spaces)
    if as_json:
        show_json(report.to_json())
    else:
        about = f", {report.description}" if report.description else ""
        show(f"{library.name}: {len(library)} materials{about}", *report.lines())
    if output:
        say(f"{output}: report.json, eigenvalues and triangulation (png, svg)")


def _say_plan(library: "Library", as_json: bool) -> None:
    from halfway.components import PcaPlan

    plan = PcaPlan.of(library).timed(library)
    facts = {"format": 1, **asdict(plan)}
    if as_json:
        show_json(facts)
    else:
        show(*plan.lines())
