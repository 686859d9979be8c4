"""``halfway library compact``: a library as principal components, in one file."""

from typing import Annotated, Literal

import typer

from ..locations import to_location
from .console import say, working
from .options import Force, Scheduler, output_to
from .outputs import writing


def compact(
    lib: Annotated[str, typer.Argument(metavar="LIB")],
    output: Annotated[str, output_to("FILE", "The file to write, NAME.brdfc, or its URL.")],
    components: Annotated[
        int, typer.Option("-k", help="Principal components; more lose less and take more room.")
    ] = 36,
    mapping: Annotated[
        Literal["log", "linear"],
        typer.Option(
            help="log: errors are shares of the value; linear: the paper's, of f_r itself."
        ),
    ] = "log",
    precision: Annotated[
        Literal["int8", "float16", "float32"], typer.Option(help="Of the components.")
    ] = "int8",
    shared: Annotated[
        bool, typer.Option(help="Whether the three channels share their components.")
    ] = True,
    scheduler: Scheduler = "",
    force: Force = False,
) -> None:
    """Keep a library as its mean, components and scores, in one file that opens like a library.

    What is read from it is a reconstruction: never negative, and otherwise without the promises of a measured material.

    \b
    halfway library compact merl.brdflib -k 36 -o merl.brdfc
    halfway library compact merl_nbrdf.zip -k 108 -o neural.brdfc

    \b
    One material of k components as the paper has them, as a table:
    halfway library compact merl.brdflib -k 5 --mapping linear --no-shared --precision float32 -o five.brdfc
    halfway convert five.brdfc:chrome chrome-5.binary
    """
    from halfway.components import compact_library
    from halfway.library import Coding, open_library

    library = open_library(lib)
    coding = Coding(mapping, shared, precision)
    with writing(to_location(output), force=force), working(scheduler) as work:
        compacted = compact_library(
            library, to_location(output), n_components=components, coding=coding, work=work
        )
    say(
        f"{output}: {len(compacted)} materials on {compacted.grid}",
        *compacted.storage(),
        f"Next: halfway route {output} A B",
    )
