"""``halfway space``: where the materials of a library are."""

import json
from typing import Annotated

import typer

from .console import work


def space(
    lib: Annotated[str, typer.Argument(metavar="[LIB]")] = "builtin:merl-abc",
    near: Annotated[
        str, typer.Option(metavar="NAME", help="List the materials nearest to this one.")
    ] = "",
    n: Annotated[int, typer.Option("-n", help="How many neighbours.")] = 8,
    as_json: Annotated[bool, typer.Option("--json", help="For programs.")] = False,
) -> None:
    """Say where each material is in the anchored space: the coordinates that `halfway mix --point` takes.

    \b
    halfway space --near gold-paint
    halfway space merl.brdflib --json
    """
    from halfway.library import open_library
    from halfway.space import anchored_space

    library = open_library(lib)
    library.index(near or library.names[0])
    made = anchored_space(library, work=work())
    neighbours = made.neighbours(near, n) if near else []
    if as_json:
        found = {"neighbours": dict(neighbours)} if near else {}
        print(json.dumps({**made.to_json(), **found}, indent=1))
    elif near:
        for name, distance in neighbours:
            print(f"{distance:10.4f}  {name}")
    else:
        print("  ".join(f"{name:>12}" for name in made.coordinates))
        for name, point in zip(made.names, made.points, strict=True):
            print("  ".join(f"{value:12.6g}" for value in point), "", name)
