"""``halfway mix``: one new material, as a file."""

from pathlib import Path
from typing import Annotated

import typer

from . import options
from .console import say, work
from .options import SpaceName


def mix(
    words: Annotated[
        list[str] | None,
        typer.Argument(metavar="[LIB] [RECIPE]", help="Weights, or a recipe's JSON file."),
    ] = None,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="FILE", help="The file to write: .binary, .bsdf."),
    ] = ...,  # pyright: ignore[reportArgumentType] (required)
    point: Annotated[
        str,
        typer.Option(metavar="X,Y,...", help="A point of the space, instead of a recipe."),
    ] = "",
    space: options.Space = SpaceName.anchored,
    clamp: Annotated[
        bool, typer.Option(help="Take the nearest mix where the point is outside the hull.")
    ] = False,
) -> None:
    """Mix full tables into a new material.

    \b
    halfway mix "gold-paint=0.7, teflon=0.3" -o new.binary
    halfway mix route/recipes.json:25 -o middle.binary
    halfway mix --point=-2e4,1e3,-500,0.1,0.05,0.02 --clamp -o there.binary     coordinates: halfway space
    """
    import halfway
    from halfway.formats import write_brdf
    from halfway.space import make_space

    from ..locations import DEFAULT_LIBRARY
    from .arguments import ArgumentError, parse_point, to_recipe

    if point:
        if len(words or []) > 1:
            raise ArgumentError("--point and a recipe are given: a material takes one of them.")
        library = halfway.open_library(words[0] if words else DEFAULT_LIBRARY)
        x = parse_point(point)
        recipe = make_space(space, library, work=work()).at(x, clamp=clamp).recipe
    else:
        library, recipe = to_recipe(words or [])
    write_brdf(output, halfway.mix(library, recipe))
    say(f"{output}: a mix of {', '.join(recipe.names)}. Next: halfway render {output} -o new.png")
