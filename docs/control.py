"""What docs/control.md says of finding recipes, measured on a library of MERL's materials.

python docs/control.py merl_nbrdf.zip [--grid 90x45x45]
"""

import argparse
import time

import numpy as np

from halfway.brdf import fresnel
from halfway.cli.arguments import parse_grid
from halfway.control import Control, Wishes
from halfway.control.wishes import attribute
from halfway.halfdiff import MERL, Grid, cosines
from halfway.instruments import ATTRIBUTES, INSTRUMENTS, of_readings, read_table
from halfway.library import Library, ProceduralLibrary, open_library
from halfway.people import QUALITIES, Perception
from halfway.people.networks import networks
from halfway.people.perceived import lightness, samples
from halfway.recipes import Blend, Recipe, mix

ASKED = ("gloss60", "albedo", "body")
N_TRIPLES, N_BLENDED, N_PERCEIVED = 200, 20, 200
ORDER = ("chrome", "specular-black-phenolic", "teflon", "white-fabric", "blue-fabric")


def main() -> None:
    """Print every figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("library")
    parser.add_argument("--grid", default="90x45x45", help="that materials are sampled on")
    options = parser.parse_args()
    given, grid = open_library(options.library), parse_grid(options.grid) or MERL
    models = {name: given.material(name) for name in given.names}
    library = ProceduralLibrary(given.name, models, grid=grid)
    start = time.perf_counter()
    control = Control.of(library)
    print(
        f"{len(library)} materials on {library.grid}: read in {time.perf_counter() - start:.1f} s"
    )
    print_gloss(control)
    print_mirrors()
    print_found(control)
    print_blends(control)
    print_qualities(control)
    print_perceived(library)


def print_gloss(control: Control) -> None:
    """Gloss of some materials, from shiny to matte."""
    for name in ORDER:
        of = of_readings(control.readings.values[control.library.index(name)])
        print(
            f"  {name:24}"
            + "".join(f"  {n} {of[n]:7.2f}" for n in ("gloss20", "gloss60", "gloss85"))
        )


def print_mirrors() -> None:
    """What black glass reads as a table: a lobe of .1 degrees."""
    for grid in (Grid.merl(), Grid.merl(720, 360, 2)):
        angles = grid.centres()
        cos_i, cos_o = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
        tan, width = np.tan(angles.theta_h), np.radians(0.1)
        d = np.exp(-((tan / width) ** 2)) / (np.pi * width**2 * np.cos(angles.theta_h) ** 4)
        mirror = fresnel(np.cos(angles.theta_d), 1.567) * d / (4 * np.abs(cos_i * cos_o))
        values = np.where(grid.mask(), np.broadcast_to(mirror, grid.shape), np.nan).reshape(1, -1)
        read = [INSTRUMENTS[f"gloss{a}"](grid, grid.mask()).of(values)[0] for a in (20, 60, 85)]
        print(f"black glass on {grid}: " + ", ".join(f"{r:.2f}" for r in read))


def print_found(control: Control) -> None:
    """How exactly and how soon random reachable triples are found."""
    rng = np.random.default_rng(0)
    n, seconds, errors = len(control.library), [], []
    for _ in range(N_TRIPLES):
        weights = np.zeros(n)
        weights[rng.choice(n, 5, replace=False)] = rng.dirichlet(np.ones(5))
        of = of_readings(control.readings.mix(np.broadcast_to(weights, (3, n)), Blend.LINEAR))
        wishes = Wishes.of({name: of[name] for name in ASKED})
        start = time.process_time()
        recipe = control.find(wishes)
        seconds.append(time.process_time() - start)
        has = control.attributes(recipe)
        errors.append(max(np.abs(has[name] / of[name] - 1).max() for name in ASKED))
    print(
        f"{N_TRIPLES} triples of {', '.join(ASKED)}: largest relative error {max(errors):.1e}, "
        f"{1e3 * np.median(seconds):.1f} ms of CPU in the median, {1e3 * max(seconds):.0f} ms at most"
    )
    start = time.perf_counter()
    for name in (names := [n for n, a in ATTRIBUTES.items() if a.is_number and not a.needs]):
        control.reach(name, Wishes.of({"L": 30}))
    print(
        f"a range where L* = 30: {1e3 * (time.perf_counter() - start) / len(names):.0f} ms in the mean"
    )


def print_blends(control: Control) -> None:
    """How near, in units of `Attribute.close`, and how soon what a blend's own mixes have is found."""
    n = len(control.library)
    for blend in (Blend.ROOT, Blend.LOG, Blend.LOBES):
        rng, seconds, missed = np.random.default_rng(0), [], []
        for _ in range(N_BLENDED):
            weights = rng.dirichlet(np.ones(5))
            names = [control.library.names[i] for i in rng.choice(n, 5, replace=False)]
            parts = dict(zip(names, weights, strict=True))
            of = control.attributes(Recipe.of(control.library, parts, blend))
            wishes = Wishes.of({name: of[name] for name in ASKED})
            start = time.perf_counter()
            recipe = control.find(wishes, blend=blend, clamp=True)
            seconds.append(time.perf_counter() - start)
            missed.append(wishes.missed(read_table(mix(control.library, recipe))))
        print(
            f"{N_BLENDED} triples by {blend}: {sum(m <= 1 for m in missed)} found, the worst {max(missed):.2f} off, "
            f"{np.median(seconds):.1f} s in the median, {max(seconds):.1f} s at most"
        )


def print_qualities(control: Control) -> None:
    """How near, and how soon, random mixes are found by what people perceive of them, alone and beside an instrument's number."""
    rng, n, reader = np.random.default_rng(0), len(control.library), control.reader(QUALITIES)
    for k, beside in ((1, ()), (2, ()), (1, ("gloss60",)), (1, ("body",))):
        seconds, missed = [], []
        for _ in range(N_PERCEIVED):
            weights = np.zeros(n)
            weights[rng.choice(n, 5, replace=False)] = rng.dirichlet(np.ones(5))
            of = reader.of(control.recipe(weights, Blend.LINEAR))
            names = (*rng.choice(list(QUALITIES), k, replace=False), *beside)
            wishes = Wishes({name: attribute(name).of(of) for name in names})
            start = time.process_time()
            recipe = control.find(wishes, clamp=True)
            seconds.append(time.process_time() - start)
            missed.append(wishes.missed(reader.of(recipe)))
        print(
            f"{N_PERCEIVED} wishes of {k} perceived {' '.join(beside)}: {sum(m <= 1 for m in missed)} found, "
            f"{1e3 * np.median(seconds):.0f} ms of CPU in the median, {1e3 * max(seconds):.0f} ms at most"
        )
    for name in QUALITIES:
        start = time.process_time()
        ends = control.reach(name, Wishes.of({"gloss60": 20}))
        assert ends is not None
        print(
            f"  {name} {ends.low:.2f} to {ends.high:.2f} at gloss60 = 20, {time.process_time() - start:.1f} s"
        )


def print_perceived(library: Library) -> None:
    """How much of each network a straight line explains, and what the stand-ins' components change."""
    rows = np.stack([samples(library.material(name)) for name in library.names])
    x, by_stand_ins = (lightness(Perception.of(of).scores(rows)) for of in (library, None))
    line = np.column_stack([np.ones(len(x)), x])
    for name, network in networks().items():
        values, others = network.of(x), network.of(by_stand_ins)
        rest = values - line @ np.linalg.lstsq(line, values, rcond=None)[0]
        print(
            f"  {name:22} explained {1 - rest.var() / values.var():.2f}, by the stand-ins' components "
            f"rms {np.sqrt(np.mean((values - others) ** 2)):.3f}, correlation {np.corrcoef(values, others)[0, 1]:.3f}"
        )


if __name__ == "__main__":
    main()
