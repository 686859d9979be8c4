"""A frame of a route from basis images, against rendering the mixed table."""

import numpy as np
from racing import race, ratio

from halfway import LinearSpace, Route
from halfway.recipes import Mixer
from halfway.render import BasisPictures, Renderer

SIZE = 256


def bench_frames(figures, library):
    renderer = Renderer("teapot", size=(SIZE, SIZE), spp=64)
    basis = BasisPictures(renderer, library.brdf)
    mixer = Mixer(library)
    stops = ["light-brown-fabric", "blue-fabric", "gold-paint"]
    route = Route.through(LinearSpace.of(library), stops)
    recipes = iter(route.recipes(np.linspace(0, 1, 12)))
    recipe = next(recipes)
    basis.render(stops)
    seconds = race(
        lambda: basis.picture(recipe),
        lambda: renderer.picture(mixer.mix(next(recipes))),
        rounds=5,
    )
    note = f"{1e3 * np.median(seconds[:, 0]):.1f} ms, {SIZE} x {SIZE}"
    figures.note(
        "a frame of a route", "rendering it / from basis images", ratio(seconds, 1, 0), note=note
    )
