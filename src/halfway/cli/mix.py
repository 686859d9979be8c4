"""``halfway mix``: one new material, as a file."""

from pathlib import Path
from typing import Annotated

import typer

from . import options
from .completion import complete_names
from .console import say, work
from .options import Force, Library
from .outputs import writing


def mix(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[LIB] [RECIPE]",
            help="Weights of materials or files, or a recipe's JSON file.",
            autocompletion=complete_names,
        ),
    ] = None,
    output: Annotated[
        Path, options.output_to("FILE", "The file to write, as halfway convert does.")
    ] = ...,  # pyright: ignore[reportArgumentType] (required)
    point: Annotated[
        str, typer.Option(metavar="X,Y,...", help="A point of the space, instead of a recipe.")
    ] = "",
    blend: options.Blending = None,
    space: options.Space = "anchored",
    clamp: Annotated[
        bool, typer.Option(help="Take the nearest mix where the point is outside the hull.")
    ] = False,
    library: Library = "",
    force: Force = False,
) -> None:
    """Mix full tables into a new material.

    \b
    halfway mix "gold-paint=0.7, teflon=0.3" -o new.binary
    halfway mix "teflon=0.5, chrome=0.5" --blend lobes -o new.binary
    halfway mix "scan.binary=0.5, chrome=0.5" -o new.binary
    halfway mix route/recipes.json:25 -o middle.binary
    halfway mix --point=-2e4,1e3,-500,0.1,0.05,0.02 --clamp -o there.binary     coordinates: halfway space
    """
    from halfway.export import recipe_beside, write_material
    from halfway.library import open_library
    from halfway.recipes import NamedBrdf, open_recipe, split_library

    from .arguments import ArgumentError, parse_point

    words = words or []
    if point:
        from halfway.space import make_space

        where, rest = split_library(words)
        if rest:
            raise ArgumentError("--point and a recipe are given: a material takes one of them.")
        opened = open_library(library or where)
        chosen = make_space(space, opened, blend=blend, work=work())
        recipe = chosen.at(parse_point(point), clamp=clamp).recipe
    else:
        opened, recipe = open_recipe(words, library=library, blend=blend)
    material = NamedBrdf.mixed(opened, recipe)
    with writing(output, recipe_beside(output, material), force=force):
        write_material(output, material)
    say(f"{output}: a mix of {', '.join(recipe.names)}. Next: halfway render {output} -o new.png")
