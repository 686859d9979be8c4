"""``halfway space``: where the materials of a library, and others, are."""

import json
from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .completion import complete_names
from .console import say, show, work
from .options import SpaceName


def space(
    lib: options.Lib = DEFAULT_LIBRARY,
    near: Annotated[
        str,
        typer.Option(
            metavar="WHAT",
            help="List the materials nearest to this one: a name, a file, a recipe.",
            autocompletion=complete_names,
        ),
    ] = "",
    n: Annotated[int, typer.Option("-n", help="How many neighbours.")] = 8,
    space: options.Space = SpaceName.anchored,
    components: options.Components = None,
    blend: options.Blending = None,
    as_json: options.AsJson = False,
) -> None:
    """Say where each material is in a space: the coordinates that `halfway mix --point` takes.

    \b
    halfway space --near gold-paint
    halfway space merl.brdflib --json
    halfway space --space paper > scores.txt
    """
    from halfway.library import open_library
    from halfway.space import make_space

    library = open_library(lib)
    if near:
        library.index(near)
    chosen = make_space(space, library, n_components=components, blend=blend, work=work())
    neighbours = chosen.neighbours(near, n) if near else []
    if as_json:
        nearest = {"neighbours": dict(neighbours)} if near else {}
        print(json.dumps({**chosen.to_json(), **nearest}, indent=1))
    elif near:
        say(
            f"distance, in the scaled coordinates of the {space} space, in which scores have a spread of 1"
        )
        show(*(f"{distance:10.4f}  {name}" for name, distance in neighbours))
    else:
        say("in 1/sr")
        show("  ".join(f"{name:>12}" for name in chosen.coordinates) + "  material")
        for name, point in zip(chosen.names, chosen.points.tolist(), strict=True):
            show("  ".join(f"{value:12.6g}" for value in point) + f"  {name}")
