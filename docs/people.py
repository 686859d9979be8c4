"""What the pace of people does, beside that of pictures: the table of docs/navigation.md.

python docs/people.py LIB [--pairs 20], with LIB of the neural fits on 90 x 30 x 36 cells.
"""

import argparse
from collections.abc import Callable

import numpy as np

from halfway import open_library
from halfway.cli.console import cache_folder
from halfway.judge import sample_pairs
from halfway.look import JUDGING_SCENE, PACING_SCENE, Looks, appearance, ciede2000_difference
from halfway.people import Impressions, apart
from halfway.space import Route, by_people, make_space, perceptual
from halfway.tasks import Work

N_STEPS = 41


def main() -> None:
    """Print a row for each pace."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("library")
    parser.add_argument("--pairs", type=int, default=20)
    options = parser.parse_args()
    library, work = open_library(options.library), Work(cache=cache_folder())
    impressions = Impressions.fit(library, work=work)
    looks, judged = (Looks.fit(library, s, work=work) for s in (PACING_SCENE, JUDGING_SCENE))
    paces: dict[str, Callable[[Route], Route]] = {
        "uniform": lambda route: route,
        "perceptual": lambda route: perceptual(route, looks),
        "people": lambda route: by_people(route, impressions),
    }
    space = make_space("anchored", library, work=work)
    pairs = sample_pairs(len(library), options.pairs)
    routes = [Route.through(space, [space.names[i] for i in pair]) for pair in pairs]
    print("| pace | pictures: largest / mean step | judged | people | detour, people |")
    for name, pace in paces.items():
        rows = [_measured(pace(route), impressions, looks, judged) for route in routes]
        middle, most = np.median(rows, axis=0), np.max(rows, axis=0)
        print(
            f"| {name} | "
            + " | ".join(f"{a:.3f} ({b:.3f})" for a, b in zip(middle, most, strict=True))
            + " |",
            flush=True,
        )


def _measured(
    route: Route, impressions: Impressions, looks: Looks, judged: Looks
) -> tuple[float, float, float, float]:
    """Largest step over the mean one, in pictures, in those that no pace knows, and for people; and the way of those over the direct one."""
    weights = route.at(np.linspace(0, 1, N_STEPS))
    seen = [appearance(each.mix(weights, route.blend)) for each in (looks, judged)]
    steps = [np.asarray(ciede2000_difference(a[:-1], a[1:]), np.float64) for a in seen]
    points = impressions.mix(weights, route.blend)
    told = apart(points[:-1], points[1:])
    jumps = [float(each.max() / each.mean()) for each in (*steps, told)]
    return jumps[0], jumps[1], jumps[2], float(told.sum() / apart(points[0], points[-1]))


if __name__ == "__main__":
    main()
