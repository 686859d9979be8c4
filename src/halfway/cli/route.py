"""``halfway route``: recipes, and tables, on the way from one material to another."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from .console import cache_folder, say, track


class SpaceName(StrEnum):
    anchored = "anchored"
    paper = "paper"
    linear = "linear"


class Pace(StrEnum):
    perceptual = "perceptual"
    uniform = "uniform"


class Format(StrEnum):
    none = "none"
    merl = "merl"


def route(
    words: Annotated[
        list[str],
        typer.Argument(metavar="[LIB] A B [C...]", help="Two or more materials, by name."),
    ],
    n: Annotated[int, typer.Option("-n", help="Materials on the route, both ends included.")] = 51,
    t: Annotated[
        str,
        typer.Option("--t", metavar="LIST", help="t instead of -n: 0,0.25,1 or 0.0001:1:0.0001."),
    ] = "",
    space: Annotated[
        SpaceName,
        typer.Option(
            help="anchored: straight in colour, through real materials; paper: the paper's; linear: the ends alone."
        ),
    ] = SpaceName.anchored,
    pace: Annotated[
        Pace, typer.Option(help="perceptual: equal visible steps; uniform: the paper's.")
    ] = Pace.perceptual,
    detour: Annotated[
        float,
        typer.Option(
            help="Longest anchored way, as a multiple of the direct one; 1 is nearly linear."
        ),
    ] = 1.1,
    components: Annotated[
        int, typer.Option("-k", help="Scores that span the space; the paper's takes 1 to 6.")
    ] = 3,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="DIR", help="[default: A-to-B]")
    ] = None,
    format: Annotated[
        Format, typer.Option(help="Tables to write beside recipes.json.")
    ] = Format.none,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print recipes.json; write files only with -o.")
    ] = False,
) -> None:
    """Go from one material to another, and on.

    Writes DIR/recipes.json, and with --format the tables 000.binary, 001.binary ... The same command again goes on
    where it stopped.

    \b
    halfway route light-brown-fabric blue-fabric -o fabric --format merl
    halfway route teflon gold-paint chrome -n 101
    halfway route cherry-235 tungsten-carbide --space paper --pace uniform --t 0.0001:1:0.0001
    """
    from halfway.export import write_route
    from halfway.library import BasisImages, open_library
    from halfway.space import Route, make_space, perceptual

    from .arguments import parse_t, split_library

    where, stops = split_library(words)
    library = open_library(where)
    for stop in stops:
        library.index(stop)
    made = make_space(
        space, library, n_components=components, detour=detour, cache=cache_folder(), track=track
    )
    found = Route.through(made, stops)
    if pace is Pace.perceptual:
        found = perceptual(found, BasisImages.fit(library, cache=cache_folder(), track=track))
    ts = parse_t(t) if t else found.steps(n)
    if as_json:
        print(json.dumps(found.to_json(ts)))
    if output is None and as_json:
        return
    folder = output or Path("-to-".join(stops))
    written = write_route(folder, found, ts, library, format=format, track=track)
    tables = f", {written.n_written} tables written" if format != "none" else ""
    kept = f", {written.n_kept} kept" if written.n_kept else ""
    say(f"{folder}: {len(ts)} recipes{tables}{kept}. Next: halfway render {folder} -o route.png")
