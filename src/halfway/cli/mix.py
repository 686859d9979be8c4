"""``halfway mix``: one new material, as a file."""

from pathlib import Path
from typing import Annotated

import typer

from .console import say


def mix(
    words: Annotated[
        list[str], typer.Argument(metavar="[LIB] RECIPE", help="Weights, or a recipe's JSON file.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="A MERL file.")],
) -> None:
    """Mix full tables into a new material.

    \b
    halfway mix "gold-paint=0.7, teflon=0.3" -o new.binary
    halfway mix route/recipes.json:25 -o middle.binary
    """
    from halfway.formats import write_brdf
    from halfway.space import mix as mixed

    from .arguments import to_recipe

    library, recipe = to_recipe(words)
    write_brdf(output, mixed(library, recipe))
    say(f"{output}: a mix of {', '.join(recipe.names)}. Next: halfway render {output} -o new.png")
