"""``halfway route``: recipes, and tables, on the way from one material to another."""

import json
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from . import options
from .console import say, working

if TYPE_CHECKING:
    from ..library import Library
    from ..recipes import Recipe
    from ..space import Route


def route(
    words: options.Stops,
    n: options.Steps = 51,
    t: options.Ts = "",
    space: options.Space = "anchored",
    pace: options.Pacing = "perceptual",
    detour: options.Detour = 1.1,
    components: options.Components = None,
    blend: options.Blending = None,
    along: options.Along = "",
    output: options.RouteFolder = None,
    format: options.Tables = "none",
    as_json: options.RouteJson = False,
    scheduler: options.Scheduler = "",
) -> None:
    """Go from one material to another, and on.

    Writes DIR/recipes.json, and with --format the tables 000.binary, 001.binary ... The same command again goes on
    where it stopped; halfway verify DIR checks what is there.

    \b
    halfway route light-brown-fabric blue-fabric -o fabric --format merl
    halfway route teflon gold-paint chrome -n 101
    halfway route cherry-235 tungsten-carbide --space paper --pace uniform --t 0.0001:1:0.0001
    halfway route cherry-235 --along gloss60=2:20 -n 9
    halfway route found.json teflon --blend linear                      from a recipe, such as halfway find writes
    """
    import halfway
    from halfway.export import write_route
    from halfway.locations import to_location
    from halfway.recipes import split_library
    from halfway.space import SPACES

    from .arguments import parse_t, require_length

    address, stops = split_library(words)
    library = halfway.open_library(address)
    require_length(n)
    wanted = parse_t(t) if t else None
    if along:
        stops, make = _along(library, stops, along, n, blend)
    else:
        through = [_stop(library, address, word) for word in stops]
        _refuse_mistakes(library, through, n, wanted, blend or SPACES[space].usual_blend)
        make = partial(halfway.route, library, *through, space=space, pace=pace, blend=blend)
        make = partial(make, n_components=components, detour=detour)
    with working(scheduler) as work:
        way = make(work=work)
        ts = wanted or way.steps(n)
        if as_json:
            print(json.dumps(way.to_json(ts)))
        if output is None and as_json:
            return
        folder = to_location(output or "-to-".join(word.removesuffix(".json") for word in stops))
        written = write_route(folder, way, ts, library, format=format, work=work)
    tables = f", {written.n_written} tables written" if format != "none" else ""
    kept = f", {written.n_kept} kept" if written.n_kept else ""
    say(f"{folder}: {len(ts)} recipes{tables}{kept}. Next: halfway render {folder} -o route.png")


def _stop(library: "Library", address: str, word: str) -> "str | Recipe":
    """The material of a name, or the recipe in a file."""
    from halfway.recipes import is_recipe_file, open_recipe

    if word in library.names or not is_recipe_file(word):
        return word
    return open_recipe([address, word])[1]


def _refuse_mistakes(
    library: "Library", stops: "list[str | Recipe]", n: int, wanted: list[float] | None, blend: str
) -> None:
    """A mistake is told before a space is fitted."""
    import halfway

    straight = halfway.route(library, *stops, space="linear", pace="uniform", blend=blend)
    checked = wanted or straight.steps(n)
    straight.recipes([min(checked), max(checked)])


def _along(
    library: "Library", words: list[str], along: str, n: int, blend: str | None
) -> "tuple[list[str], Callable[..., Route]]":
    """The words that a route along an attribute is called by, and what makes it."""
    from halfway.space import along as route_along

    from .arguments import ArgumentError, parse_range

    if len(words) != 1:
        raise ArgumentError(
            f"--along takes one material to be like, and {len(words)} are given: name one."
        )
    name, start, stop = parse_range(along)
    make = partial(route_along, library, words[0], name, start, stop, n=n, blend=blend or "linear")
    return [words[0], f"{name}-{stop:g}"], make
