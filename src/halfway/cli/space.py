"""``halfway space``: where the materials of a library are."""

import json
from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .console import work
from .options import SpaceName


def space(
    lib: Annotated[str, typer.Argument(metavar="[LIB]")] = DEFAULT_LIBRARY,
    near: Annotated[
        str, typer.Option(metavar="NAME", help="List the materials nearest to this one.")
    ] = "",
    n: Annotated[int, typer.Option("-n", help="How many neighbours.")] = 8,
    space: options.Space = SpaceName.anchored,
    components: options.Components = 3,
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
    library.index(near or library.names[0])
    places = make_space(space, library, n_components=components, work=work())
    neighbours = places.neighbours(near, n) if near else []
    if as_json:
        nearest = {"neighbours": dict(neighbours)} if near else {}
        print(json.dumps({**places.to_json(), **nearest}, indent=1))
    elif near:
        for name, distance in neighbours:
            print(f"{distance:10.4f}  {name}")
    else:
        print("  ".join(f"{name:>12}" for name in places.coordinates))
        for name, point in zip(places.names, places.points, strict=True):
            print("  ".join(f"{value:12.6g}" for value in point), "", name)
