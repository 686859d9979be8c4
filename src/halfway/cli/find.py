"""``halfway find``: the recipe that has what is asked for."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .attributes import changes, perceived_json, perceived_lines, to_json
from .completion import complete_names
from .console import say, show, show_json, work
from .outputs import writing

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..library import Library
    from ..people import Perceived
    from ..recipes import Recipe

NAME_VALUE = "NAME=VALUE"
Like = Annotated[
    str,
    typer.Option(
        metavar="WHAT",
        help="What it shall be like: a name, a file, a recipe, a colour, a picture of a sphere.",
        autocompletion=complete_names,
    ),
]
Exactly = Annotated[
    list[str],
    typer.Option(
        "--set",
        metavar=NAME_VALUE,
        help="An attribute, or a perceived quality, exactly; again for more.",
    ),
]
AtMost = Annotated[list[str], typer.Option(metavar=NAME_VALUE, help="An attribute at the most.")]
AtLeast = Annotated[list[str], typer.Option(metavar=NAME_VALUE, help="An attribute at the least.")]
Few = Annotated[bool, typer.Option("--few", help="Of as few materials as can be.")]
Clamp = Annotated[bool, typer.Option("--clamp", help="Take the nearest where no mix has all that.")]
Release = Annotated[
    list[str],
    typer.Option(
        metavar="NAME",
        help="Do not hold this of the highlight beside a body colour; again for more.",
    ),
]
Lights = Annotated[
    str,
    typer.Option(
        metavar="WHAT",
        help="In which the picture was taken: .hdr, .exr, `studio`, or X,Y,Z to a light, right, up, to the viewer; X,Y,Z;X,Y,Z to several. "
        "[default: that of halfway's own spheres]",
    ),
]
Output = Annotated[Path | None, options.output_to("FILE", "A recipe, .json; or a material.")]


def find(
    lib: options.Lib = DEFAULT_LIBRARY,
    like: Like = "",
    exactly: Exactly = [],  # noqa: B006 (typer copies it, here and below)
    at_most: AtMost = [],  # noqa: B006
    at_least: AtLeast = [],  # noqa: B006
    blend: options.Blending = None,
    few: Few = False,
    clamp: Clamp = False,
    release: Release = [],  # noqa: B006
    lights: Lights = "",
    output: Output = None,
    as_json: options.AsJson = False,
    force: options.Force = False,
) -> None:
    """Find the recipe that has these attributes, and of those the one nearest to a material.

    \b
    halfway find --like cherry-235 --set gloss60=35 -o glossy.json
    halfway find merl.brdflib --set L=40 --set a=20 --set b=10 --at-most gloss60=5
    halfway find --like teflon --set gloss60=20 --blend lobes -o shiny.json
    halfway find --like cherry-235 --set metallic=.7 -o metallic.json   as people would perceive it: halfway attributes --perceived
    halfway find --like sphere.png -o seen.json                         in the light that small pictures have here
    halfway find --like photo.png --lights forest.exr -o seen.json      in that of a place
    halfway find --like scan.binary --set "body=#7a3b1e" -o new.binary  its highlight is held, unless --release gloss60
    """
    from halfway.control import Control, Wishes
    from halfway.people import QUALITIES
    from halfway.recipes import Blend

    from .arguments import ArgumentError, open_like, parse_lights, parse_targets

    wishes = Wishes.of(parse_targets(exactly), parse_targets(at_most), parse_targets(at_least))
    if not like and not list(wishes.each()):
        raise ArgumentError(
            "there is nothing to find: give --set, --at-most, --at-least or --like."
        )
    control = Control.of(lib, lights=parse_lights(lights) if lights else None, work=work())
    opened = open_like(like)
    recipe = control.find(
        wishes,
        like=opened,
        blend=Blend(blend or Blend.LINEAR),
        few=few,
        clamp=clamp,
        release=release,
    )
    if output:
        _write(output, control.library, recipe, force=force)
    has = control.attributes(recipe)
    _say_given_up(recipe, like, control.given_up(has, wishes, opened))
    seen = control.perceived(recipe) if wishes.names & set(QUALITIES) else {}
    _show(recipe, has, seen, as_json=as_json)
    if output:
        say(
            f"{output}: a mix of {', '.join(recipe.names)}. Next: halfway render {output} -o new.png"
        )


def _write(output: Path, library: "Library", recipe: "Recipe", *, force: bool) -> None:
    from halfway.export import write_material, write_recipe
    from halfway.recipes import NamedBrdf

    with writing(output, force=force):
        if output.suffix == ".json":
            write_recipe(output, library, recipe)
        else:
            write_material(output, NamedBrdf.mixed(library, recipe, output.stem))


def _say_given_up(recipe: "Recipe", like: str, lost: "Mapping[str, tuple[Any, Any]]") -> None:
    if recipe.is_recoloured:
        scale = ", ".join(f"{x:.3g}" for x in recipe.body_scale)
        also = f"; with it went {changes(lost)}" if lost else ""
        say(
            f"no mix has that body and keeps the highlight of {like}: "
            f"its body alone is scaled, red, green and blue by {scale}{also}"
        )
    elif lost:
        say(f"no nearer mix keeps what {like} has: {changes(lost)}")


def _show(
    recipe: "Recipe", read: "Mapping[str, Any]", seen: "Mapping[str, Perceived]", *, as_json: bool
) -> None:
    from halfway.instruments import described

    if as_json:
        also = perceived_json(seen)
        show_json({"format": 1, **recipe.to_json(), "attributes": to_json(read), **also})
        return
    show(*(f"{weight:.6f}  {name}" for name, weight in recipe.to_json()["weights"].items()))
    show(*described(read, read), *perceived_lines(seen))
