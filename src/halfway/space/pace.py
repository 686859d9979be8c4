"""Perceptual pace: a route whose materials look equally far apart.

The distance of two materials is the mean CIEDE2000 difference of their pictures on a small lit sphere
(`halfway.look.Looks`), and the length of a stretch of a route the sum over steps too short to matter. With L(t) the
length from the start to t, the paced route is

    u = L(t) / L(1)

so that equal steps of u are equal lengths. L is measured leg by leg, so that a leg is as long on any route, between values
of t that are added until no step is longer than `FINEST` of the leg; between them t is linear in u, and the recipes stay
piecewise linear.

CIEDE2000 and not the plain distance in CIELAB: strong colours, where CIELAB exaggerates, would get all the steps.

The pace of people is the same by another distance, that which agrees with their answers (`halfway.people.Impressions`).
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float64

from ..colour import Lab
from ..look import Looks, appearance, ciede2000_difference
from ..people import Impressions, apart
from ..recipes import Blend
from .routes import Route
from .way import Way

FINEST = 1 / 200
"""Largest step, as a share of the leg's length, between two t at which the length is measured."""
N_START = 65
"""Even steps of a leg to begin with, and one."""
N_ROUNDS = 12
"""How often steps may be halved: a jump within 1/500,000 of t is an instant."""
LEAST = 1e-9
"""Length of a step in which nothing changes, as a share of the leg: u stays a function of t and t of u."""
THINNING = 4
"""Every so many pixels of the basis images are enough to measure with."""

Shares = Float64[np.ndarray, "..."]
"""Shares of a way, ascending."""


class Measure(NamedTuple):
    """By what mixes differ."""

    at: Callable[[Float64[np.ndarray, "3 n N"], Blend], np.ndarray]
    """What counts of mixes, given by their weights over all materials; one after another."""
    apart: Callable[[Any, Any], np.ndarray | np.floating]
    """How far apart they are, one by one."""


def _look(images: Looks, weights: Float64[np.ndarray, "3 n N"], blend: Blend) -> Lab:
    return appearance(images.mix(weights, blend))


def perceptual(route: Route, images: Looks) -> Route:
    """The same way at perceptual pace; a route on which nothing changes keeps its own."""
    return paced(route, *lengths(route, images))


def by_people(route: Route, impressions: Impressions) -> Route:
    """The same way, as far from one material to the next as people would say."""
    return paced(route, *lengths(route, impressions), pace="people")


def lengths(route: Route, by: Looks | Impressions) -> tuple[Shares, Shares]:
    """Some t, the knots among them, and the length of the route from its start to each, strictly ascending.

    By what is seen, or by what people would say.
    """
    if isinstance(by, Impressions):
        measure = Measure(by.mix, apart)
    else:
        measure = Measure(partial(_look, by.thinned(THINNING)), ciede2000_difference)
    legs = [_leg(route, measure, start, stop) for start, stop in pairwise(route.stop_ts)]
    t = [t[:-1] for t, _ in legs]
    steps = np.concatenate([steps for _, steps in legs])
    return np.append(np.concatenate(t), 1.0), np.append(0.0, np.cumsum(steps))


def paced(route: Route, t: Shares, length: Shares, *, pace: str = "perceptual") -> Route:
    """The same way, equal lengths in equal times; ``length`` has been covered at each ``t``."""
    u = length / length[-1]
    stop_ts = np.interp(route.stop_ts, t, u)
    return replace(route, pace=pace, way=Way(u, route.at(t)), stop_ts=stop_ts)


def _leg(route: Route, measure: Measure, start: float, stop: float) -> tuple[Shares, Shares]:
    """Some t from one stop to the next, the knots among them, and the lengths of the steps between, none 0."""
    knots = route.way.knots
    between = knots[(knots >= start) & (knots <= stop)]
    t = np.union1d(between, np.linspace(start, stop, N_START))
    looks = measure.at(route.at(t), route.blend)
    steps = np.asarray(measure.apart(looks[:-1], looks[1:]), np.float64)
    for _ in range(N_ROUNDS):
        long = np.flatnonzero(steps > FINEST * steps.sum())
        if not len(long):
            break
        middle = (t[long] + t[long + 1]) / 2
        halfway = measure.at(route.at(middle), route.blend)
        second_halves = measure.apart(halfway, looks[long + 1])
        steps[long] = measure.apart(looks[long], halfway)
        steps = np.insert(steps, long + 1, second_halves)
        t = np.insert(t, long + 1, middle)
        looks = np.insert(looks, long + 1, halfway, axis=0)
    length = np.append(0.0, np.cumsum(steps))
    return t, np.diff(length) + LEAST * length[-1] if length[-1] else LEAST * np.diff(t)
