"""``halfway report``: the paper's table and figures, for any library."""

import json
from dataclasses import asdict
from typing import Annotated, Any

import typer

from ..locations import DEFAULT_LIBRARY
from .console import say, working
from .options import Scheduler


def report(
    lib: Annotated[str, typer.Argument(metavar="[LIB]")] = DEFAULT_LIBRARY,
    output: Annotated[
        str, typer.Option("--output", "-o", metavar="DIR", help="The folder to write, or its URL.")
    ] = "report",
    pairs: Annotated[
        int,
        typer.Option(
            help="Pairs of materials that spaces are compared on; 0 compares none, -1 takes all."
        ),
    ] = 0,
    seed: Annotated[int, typer.Option(help="Of the sample of pairs.")] = 0,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print report.json, or the plan of --dry-run.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say what it takes: blocks, memory, time; and stop.")
    ] = False,
    scheduler: Scheduler = "",
) -> None:
    """Principal components of a library: Table I, eigenvalues, triangulation; and how well spaces move in it.

    \b
    halfway report merl.brdflib -o report
    halfway report merl_nbrdf.zip --pairs 200
    halfway report builtin:synthetic-2000 --dry-run
    """
    from halfway.components import Pca, PcaPlan
    from halfway.export import write_report
    from halfway.judge import compare_spaces
    from halfway.library import open_library
    from halfway.locations import to_location

    library = open_library(lib)
    if dry_run:
        plan = PcaPlan.of(library).timed(library)
        print(
            json.dumps({"format": 1, **asdict(plan)}, indent=1)
            if as_json
            else "\n".join(plan.lines())
        )
        return
    compared: list[dict[str, Any]] = []
    with working(scheduler) as work:
        pca = Pca.fit(library, work=work)
        if pairs:
            n_pairs = None if pairs < 0 else pairs
            compared = compare_spaces(library, n_pairs=n_pairs, seed=seed, work=work)
    found = write_report(to_location(output), library, pca, spaces=compared)
    if as_json:
        print(json.dumps(found.to_json(), indent=1))
    else:
        about = f", {library.origin.description}" if library.origin.description else ""
        print(f"{library.name}: {len(library)} materials{about}")
        print(
            "components  mean relative error  uncentred  total    unexplained variance  rms error (1/sr)"
        )
        for row in found.table_1:
            print(
                f"{row.n_components:10d}  {row.mean_relative_error:19.4f}  {row.mean_relative_error_uncentred:9.4f}  "
                f"{row.total_relative_error:7.4f}  {row.unexplained_variance:20.2e}  {row.rms_error:16.4g}"
            )
        _print_spaces(compared)
    say(f"{output}: report.json, eigenvalues and triangulation (png, svg)")


def _print_spaces(spaces: list[dict[str, Any]]) -> None:
    if not spaces:
        return
    print(
        "space     detour: median  90 %   max  jump, perceptual: max  judged  hue strays  realism  others  left out"
    )
    for found in spaces:
        detour, left = found["detour"], found.get("leave_one_out")
        print(
            f"{found['space']:9} {detour['median']:14.3f} {detour['90th percentile']:5.2f} {detour['max']:5.2f} "
            f"{found['jump']['perceptual']['max']:22.3f} {found['judged_jump']['perceptual']['max']:7.3f} "
            f"{found['hue_excursion']['median']:11.2f} {found['realism']['log by cell']['median']:8.4f} "
            f"{found['others']['median']:7.2f} "
            + (f"{left['log']['mean']:9.4f}" if left else "        -")
        )
