"""What the page on blends measures and shows: ``python docs/blends.py LIB [WHAT...]``.

LIB is a library of the neural fits (``halfway library build merl_nbrdf.zip -o LIB --grid 90x30x36``), WHAT some of ``left-out
ladders highlights laws pictures pairs``, or all.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from halfway import Pca, open_library
from halfway.brdf import TabularBrdf, check
from halfway.cli.console import cache_folder
from halfway.halfdiff import Grid
from halfway.judge import Bench, highlight, ladder_errors, ladders, leave_one_out
from halfway.library import Library, LibraryRef
from halfway.look import PACING_SCENE, Looks, SphereOperator, body_colours, shown
from halfway.recipes import Blend, Mixer, Recipe
from halfway.render import Renderer, pictures
from halfway.space import AnchoredSpace, Coordinates, LinearSpace, Route, Scores
from halfway.space.anchored import body_group
from halfway.tasks import Work

PAIRS = (
    ("cherry-235", "tungsten-carbide"),
    ("pink-felt", "chrome"),
    ("white-fabric", "black-obsidian"),
    ("red-plastic", "gold-metallic-paint2"),
)
HARD = (
    ("polyurethane-foam", "chrome"),
    ("blue-fabric", "gold-paint"),
    ("green-fabric", "steel"),
    ("black-fabric", "white-marble"),
    ("pink-fabric", "black-phenolic"),
    ("beige-fabric", "hematite"),
    ("white-fabric2", "silver-metallic-paint"),
    ("pink-felt", "yellow-plastic"),
    ("light-brown-fabric", "tungsten-carbide"),
    ("blue-metallic-paint", "pearl-paint"),
    ("two-layer-gold", "teflon"),
    ("alumina-oxide", "ss440"),
    ("chrome", "chrome-steel"),
    ("red-fabric2", "specular-green-phenolic"),
    ("polyethylene", "nickel"),
    ("black-soft-plastic", "color-changing-paint3"),
)
"""Cloth and rubber to mirrors, two mirrors, coats over coats."""
N_PAIRS = 50
SHEETS = Path("pairs")
N_ROUTES = 500
N_COLUMNS = 7
WORK = Work(cache=cache_folder())
OUTPUT = Path(__file__).parent / "images" / "blends.webp"


def left_out(library: Library) -> None:
    """Errors of every material that is left out and placed by its coordinates."""
    bench = Bench.fit(library, work=WORK)
    spaces = {
        f"{blend}, {k} scores": AnchoredSpace.fit(library, blend=blend, n_components=k, work=WORK)
        for blend in Blend
        for k in (3, 4)
    }
    looks, pca = Looks.fit(library, work=WORK), Pca.fit(library, work=WORK)
    groups = Scores.joint(pca, 3, spread=1.0), body_group(body_colours(library, work=WORK))
    by_cell = AnchoredSpace.of(LibraryRef.of(library), Coordinates(groups), looks)
    print("| blend, components | log | log by cell | seen |\n|---|---|---|---|")
    for name, space in {"linear, 3 scores by cell": by_cell, **spaces}.items():
        errors = leave_one_out(space, bench, work=WORK).errors
        log, by_cells, seen = (errors[m].mean() for m in ("log", "log by cell", "seen"))
        print(f"| {name} | {log:.4f} | {by_cells:.3f} | {seen:.2f} |", flush=True)


def rungs(library: Library) -> None:  # noqa: ARG001
    """Errors to the rung in the middle."""
    print("| ladder | blend | log | of linear's | seen |\n|---|---|---|---|---|")
    for ladder in ladders(Grid.merl(90, 30, 36)):
        linear = ladder_errors(ladder, Blend.LINEAR)
        for blend in Blend:
            errors = ladder_errors(ladder, blend)
            ratio = np.median(errors.log / linear.log)
            print(
                f"| {ladder.name} | {blend} | {np.median(errors.log):.4f} | {ratio:.2f} | {np.median(errors.seen):.2f} |",
                flush=True,
            )


def widths(library: Library) -> None:
    """The width of the highlight along each pair, and how far the body's hue strays."""
    bench = Bench.fit(library, work=WORK)
    mixer = Mixer(library)
    print("| pair | blend | width in degrees, t = 0 to 1 | hue |\n|---|---|---|---|")
    for stops in PAIRS:
        for blend in (Blend.LINEAR, Blend.LOBES):
            route = Route.through(LinearSpace.of(library, blend=blend), stops)
            found = [highlight(mixer.mix(r)) for r in route.recipes(route.steps(9))]
            shown_widths = " ".join(f"{np.degrees(each.width):.2g}" for each in found)
            falls = all(a.width >= b.width for a, b in pairwise(found))
            hue = hue_excursion(bench, route)
            print(
                f"| {' to '.join(stops)} | {blend} | {shown_widths}{'' if falls else ' (rises)'} | {hue:.1f} |",
                flush=True,
            )


def hue_excursion(bench: Bench, route: Route) -> float:
    """As `halfway.judge.evaluate` has it."""
    from halfway.judge import evaluate, uniform

    space = LinearSpace.of(bench.library, blend=route.blend)
    pair = np.array([[bench.library.index(stop) for stop in route.stops]])
    return float(evaluate(space, bench, pair, paces={"uniform": uniform}).hue_excursion[0])


def laws(library: Library) -> None:
    """Recipes of random routes in each blend that break a law that their materials keep."""
    rng = np.random.default_rng(0)
    sound = {name for name in library.names if check(library.brdf(name)).ok}
    print(f"{len(sound)} of {len(library)} materials are sound")
    for blend in Blend:
        space = AnchoredSpace.fit(library, blend=blend, work=WORK)
        mixer, n_recipes, n_broken = Mixer(library), 0, 0
        for _ in range(N_ROUTES):
            stops = rng.choice(library.names, 2, replace=False).tolist()
            for recipe in Route.through(space, stops).recipes([0.25, 0.5, 0.75]):
                if set(recipe.names) <= sound:
                    n_recipes += 1
                    n_broken += not check(mixer.mix(recipe)).ok
        print(
            f"{blend}: {n_broken} of {n_recipes} recipes of {N_ROUTES} routes break a law",
            flush=True,
        )


def rows(library: Library) -> None:
    """Rows of spheres: each pair, linear above lobes."""
    mixer, picture = Mixer(library), under_lights(library, 112)
    tiles = [
        picture(table)
        for stops in PAIRS
        for blend in (Blend.LINEAR, Blend.LOBES)
        for table in on_the_way(mixer, library, stops, blend)
    ]
    pictures.write(OUTPUT, pictures.sheet(tiles, columns=N_COLUMNS))


def looked_at(library: Library) -> None:
    """Sheets of fifty pairs in the folder ``pairs``: linear and lobes under three lights, linear and lobes in the studio."""
    rng = np.random.default_rng(0)
    drawn = (tuple(rng.choice(library.names, 2, replace=False).tolist()) for _ in range(N_PAIRS))
    stops = [*PAIRS, *HARD, *drawn][:N_PAIRS]
    mixer, studio = Mixer(library), Renderer("sphere", size=(96, 96), spp=16, env="studio")
    lights = under_lights(library, 96)
    SHEETS.mkdir(exist_ok=True)
    for i, pair in enumerate(stops):
        linear, lobes = (on_the_way(mixer, library, pair, b) for b in (Blend.LINEAR, Blend.LOBES))
        ends = studio.picture(lobes[0]), studio.picture(lobes[-1])
        mixed = [(1 - t) * ends[0] + t * ends[1] for t in np.linspace(0, 1, N_COLUMNS)]
        between = (studio.picture(table) for table in lobes[1:-1])
        tiles = [*map(lights, linear), *map(lights, lobes), *mixed, ends[0], *between, ends[1]]
        sheet = pictures.sheet(tiles, columns=N_COLUMNS)
        pictures.write(SHEETS / f"{i:02d}-{'-to-'.join(pair)}.png", sheet)


def on_the_way(
    mixer: Mixer, library: Library, stops: tuple[str, str], blend: Blend
) -> list[TabularBrdf]:
    """A pair in seven steps, without other materials."""
    return [
        mixer.mix(Recipe.of(library, dict(zip(stops, (1 - t, t), strict=True)), blend))
        for t in np.linspace(0, 1, N_COLUMNS)
    ]


def under_lights(library: Library, size: int) -> Callable[[TabularBrdf], np.ndarray]:
    """What makes pictures of a sphere under three lights."""
    scene = replace(PACING_SCENE, size=size)
    operator, mask = SphereOperator.of(scene, library.grid), scene.mask()

    def picture(table: TabularBrdf) -> np.ndarray:
        tile = np.full((*mask.shape, 3), 0.02, np.float32)
        tile[mask] = shown(operator.picture(table.values.reshape(3, -1)))
        return tile

    return picture


PARTS = {
    "left-out": left_out,
    "ladders": rungs,
    "highlights": widths,
    "laws": laws,
    "pictures": rows,
    "pairs": looked_at,
}

if __name__ == "__main__":
    where, *wanted = sys.argv[1:]
    for name in wanted or PARTS:
        PARTS[name](open_library(where))
