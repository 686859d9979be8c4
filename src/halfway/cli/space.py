"""``halfway space``: where the materials of a library, and others, are."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .completion import complete_names
from .console import say, show, show_json, work

if TYPE_CHECKING:
    import numpy as np

    from ..components import Newcomer
    from ..library import Library
    from ..space import Space


def space(
    lib: options.Lib = DEFAULT_LIBRARY,
    near: Annotated[
        str,
        typer.Option(
            metavar="WHAT",
            help="Say where this one stands, and what people find most alike: a name, a file, a recipe.",
            autocompletion=complete_names,
        ),
    ] = "",
    n: Annotated[int, typer.Option("-n", help="How many neighbours.")] = 8,
    space: options.Space = "anchored",
    components: options.Components = None,
    blend: options.Blending = None,
    as_json: options.AsJson = False,
) -> None:
    """Say where each material is in a space: the coordinates that `halfway mix --point` takes.

    \b
    halfway space --near gold-paint
    halfway space merl.brdflib --near scan.binary
    halfway space --space paper > scores.txt
    """
    from halfway.library import open_library
    from halfway.space import make_space

    library = open_library(lib)
    # A mistake is told before the space is fitted.
    newcomer = _newcomer(library, lib, near) if near and near not in library.names else None
    chosen = make_space(space, library, n_components=components, blend=blend, work=work())
    if near:
        point = chosen.point_of(newcomer) if newcomer else chosen.points[library.index(near)]
        alike = _alike(library, near, newcomer, n)
        _show_near(chosen, near, point, alike, as_json)
    elif as_json:
        show_json(chosen.to_json())
    else:
        say(f"in {chosen.unit}")
        show(_line(chosen.coordinates, "material"), *map(_line, chosen.points, chosen.names))


def _newcomer(library: "Library", lib: str, what: str) -> "Newcomer":
    """The one material that is called, filed or mixed so."""
    from halfway.components import Newcomer
    from halfway.recipes import open_materials, split_address

    from .arguments import ArgumentError

    is_addressed = len(split_address(what)) > 1
    materials = open_materials(
        [what], library="" if is_addressed or lib == DEFAULT_LIBRARY else lib
    )
    if len(materials) != 1:
        raise ArgumentError(
            f"--near {what} is {len(materials)} materials: expected one. Name one of them."
        )
    (material,) = materials
    return Newcomer(library, material.load(), material.label, work())


def _alike(
    library: "Library", name: str, newcomer: "Newcomer | None", n: int
) -> list[tuple[str, float]]:
    """The materials that people would find most alike to one, and how different."""
    from halfway.people import Impressions

    impressions = Impressions.fit(library, work=work())
    point = impressions.of(newcomer.brdf if newcomer else name)
    return [near for near in impressions.nearest(point, n + 1) if near[0] != name][:n]


def _show_near(
    space: "Space", name: str, point: "np.ndarray", others: list[tuple[str, float]], as_json: bool
) -> None:
    """A point, the mix that stands there or nearest to it, and the materials that are most alike."""
    position = space.at(point, clamp=True)
    if as_json:
        where = {"point": point.tolist(), "inside": position.inside, "mix": position.point.tolist()}
        show_json({**space.to_json(), "near": where, "neighbours": dict(others)})
        return
    say(f"in {space.unit}")
    show(_line(space.coordinates, "material"), _line(point, name))
    if not position.inside:
        show(_line(position.point, "(the nearest mix: it is outside the hull)"))
    say("how different people would find it (halfway.distances)")
    show(_line(["distance"], "material"), *(_line([distance], other) for other, distance in others))


def _line(values: "Sequence[float | str] | np.ndarray", name: str) -> str:
    """A line of a table, or its header."""
    return (
        "  ".join(f"{value:>12{'' if isinstance(value, str) else '.6g'}}" for value in values)
        + f"  {name}"
    )
