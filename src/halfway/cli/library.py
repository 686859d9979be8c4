"""``halfway library``: build and look at libraries."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from .check import UNREADABLE
from .compact import compact
from .console import say, show, show_json, working
from .options import AsJson, GridText, Lib, Scheduler, output_to

if TYPE_CHECKING:
    from ..formats import Skipped

FEW = 3

app = typer.Typer(help="Build a library of materials, or see what is in one.", no_args_is_help=True)


@app.command()
def build(
    sources: Annotated[
        list[str], typer.Argument(metavar="SOURCE...", help="Files, folders, zips, builtin:NAME.")
    ],
    output: Annotated[str, output_to("LIB", "The folder to write, or its URL.")],
    licence: Annotated[
        str, typer.Option(help="Licence of the measurements, kept in the library.")
    ] = "",
    source: Annotated[str, typer.Option(help="Where they come from, kept in the library.")] = "",
    grid: GridText = "",
    scheduler: Scheduler = "",
) -> None:
    """Tabulate every BRDF found in SOURCE into the library LIB. A SOURCE may be a library, and LIB itself: that adds to it.

    What is damaged is left out; the exit code is then 3.

    \b
    halfway library build ~/BRDFDatabase/brdfs -o merl.brdflib
    halfway library build merl_nbrdf.zip -o neural.brdflib
    halfway library build ~/BRDFDatabase/brdfs -o s3://bucket/merl.brdflib
    halfway library build mine.brdflib new.binary -o mine.brdflib
    """
    from halfway.library import Origin, build_library
    from halfway.locations import to_location

    from .arguments import parse_grid

    description = "built from files" if licence or source else ""
    with working(scheduler) as work:
        built = build_library(
            sources,
            to_location(output),
            origin=Origin(description, source, licence),
            grid=parse_grid(grid),
            work=work,
        )
    say(*skipped_lines(built.skipped))
    say(
        f"{output}: {len(built.library)} materials on {built.library.grid}"
        + (f", {len(built.skipped)} skipped" if built.skipped else "")
        + f". Next: halfway report {output} -o report"
    )
    if any(item.damaged for item in built.skipped):
        raise typer.Exit(UNREADABLE)


def skipped_lines(skipped: "Sequence[Skipped]") -> list[str]:
    """What was skipped and why: a line for each reason, and for each file where it is the reason of few."""
    lines: list[str] = []
    for reason in dict.fromkeys(item.reason for item in skipped):
        paths = [item.path for item in skipped if item.reason == reason]
        if len(paths) <= FEW:
            lines += [f"skipped {path}: {reason}" for path in paths]
        else:
            lines.append(f"skipped {len(paths):,}, {paths[0]} to {paths[-1]}: {reason}")
    return lines


app.command()(compact)


@app.command()
def info(lib: Lib = DEFAULT_LIBRARY, as_json: AsJson = False) -> None:
    """Say what is in a library.

    \b
    halfway library info builtin:merl-abc
    halfway library info merl.brdflib --json
    """
    from halfway.library import open_library

    library = open_library(lib)
    facts = library.facts()
    if as_json:
        show_json({"format": 1} | facts)
        return
    show(f"{library.name}: {len(library)} materials on {library.grid}")
    for key in ("description", "source", "licence"):
        if facts[key]:
            show(f"{key}: {facts[key]}")
    show(*library.storage(), *(f"  {name}" for name in library.names))


@app.command()
def verify(
    lib: Annotated[
        str,
        typer.Argument(metavar="LIB", help="A library's folder, a compact library, or its URL."),
    ],
    as_json: AsJson = False,
    scheduler: Scheduler = "",
) -> None:
    """Read all samples of a library again and compare them with its checksums; exits with 1 when some are damaged.

    Says as well which of the files that it was built of have changed since.

    \b
    halfway library verify merl.brdflib
    halfway library verify merl.brdfc
    """
    from halfway.library import open_library

    with working(scheduler) as work:
        verdict = open_library(lib).verify(work=work)
    kinds = {"damaged": verdict.damaged, "changed": verdict.changed}
    if as_json:
        document = {"format": 1, "library": lib, "ok": verdict.ok, "right": verdict.n_right}
        show_json(document | kinds)
    else:
        for name in verdict.damaged:
            show(f"damaged  {name}")
        for name in verdict.changed:
            show(f"changed since it was built  {name}")
        advice = "" if verdict.ok and not verdict.changed else " Build the library again."
        say(
            f"{lib}: {verdict.n_right:,} of {verdict.n_right + len(verdict.damaged):,} materials right.{advice}"
        )
    if not verdict.ok:
        raise typer.Exit(1)
