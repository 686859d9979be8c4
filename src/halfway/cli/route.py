"""``halfway route``: recipes, and tables, on the way from one material to another."""

import json

from . import options
from .console import cache_folder, engine, say, track
from .options import Pace, SpaceName, TableFormat


def route(
    words: options.Stops,
    n: options.Steps = 51,
    t: options.Ts = "",
    space: options.Space = SpaceName.anchored,
    pace: options.Pacing = Pace.perceptual,
    detour: options.Detour = 1.1,
    components: options.Components = 3,
    output: options.RouteFolder = None,
    format: options.Tables = TableFormat.none,
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
    """
    from halfway.export import write_route
    from halfway.library import BasisImages, open_library
    from halfway.places import to_place
    from halfway.space import Route, make_space, perceptual

    from .arguments import parse_t, split_library

    where, stops = split_library(words)
    library = open_library(where)
    for stop in stops:
        library.index(stop)
    with engine(scheduler) as where:
        made = make_space(
            space,
            library,
            n_components=components,
            detour=detour,
            cache=cache_folder(),
            track=track,
            engine=where,
        )
        found = Route.through(made, stops)
        if pace is Pace.perceptual:
            found = perceptual(
                found, BasisImages.fit(library, cache=cache_folder(), track=track, engine=where)
            )
        ts = parse_t(t) if t else found.steps(n)
        if as_json:
            print(json.dumps(found.to_json(ts)))
        if output is None and as_json:
            return
        folder = to_place(output or "-to-".join(stops))
        written = write_route(folder, found, ts, library, format=format, track=track, engine=where)
    tables = f", {written.n_written} tables written" if format != "none" else ""
    kept = f", {written.n_kept} kept" if written.n_kept else ""
    say(f"{folder}: {len(ts)} recipes{tables}{kept}. Next: halfway render {folder} -o route.png")
