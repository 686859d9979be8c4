"""Perceptual pace: a route whose materials look equally far apart.

The distance of two materials is the mean CIELAB difference of their pictures on a small lit sphere
(`halfway.library.BasisImages`), and the length of a stretch of a route the sum over steps too short to matter. With L(t) the
length from the start to t, the paced route is

    u = L(t) / L(1)

so that equal steps of u are equal lengths. L is measured between knots that are added until no step is longer than
`FINEST` of the whole; between them t is linear in u, and the recipes stay piecewise linear.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float64

from ..brdf.image_metrics import appearance, cielab_difference
from ..library import BasisImages
from .route import Route

FINEST = 1 / 400
"""Largest step, as a share of the route's length, between knots at which the length is measured."""
N_START = 129
"""Even knots to begin with."""
N_ROUNDS = 12
"""How often steps may be halved: a jump within 1/500,000 of t is an instant."""
LEAST = 1e-9
"""Length of a step in which nothing changes, as a share of the whole: u stays a function of t and t of u."""
THINNING = 4
"""Every so many pixels of the basis images are enough to measure with."""

Places = Float64[np.ndarray, "..."]
"""Shares of a way, ascending."""


def perceptual(route: Route, images: BasisImages) -> Route:
    """The same way at perceptual pace; a route on which nothing changes keeps its own."""
    u, t = _lengths(route, replace(images, planes=images.planes[..., ::THINNING]))
    stop_ts = np.interp(route.stop_ts, t, u)
    return replace(route, pace="perceptual", knots=u, weights=route.at(t), stop_ts=stop_ts)


def _lengths(route: Route, images: BasisImages) -> tuple[Places, Places]:
    """The share u of its length that a route has covered at each of some t."""
    t = np.union1d(route.knots, np.linspace(0, 1, N_START))
    for _ in range(N_ROUNDS):
        steps = _steps(route, images, t)
        long = np.flatnonzero(steps > FINEST * steps.sum())
        if not len(long):
            break
        t = np.insert(t, long + 1, (t[long] + t[long + 1]) / 2)
    steps = _steps(route, images, t)
    if not steps.sum():
        return t, t
    u = np.append(0.0, np.cumsum(steps + LEAST * steps.sum()))
    return u / u[-1], t


def _steps(route: Route, images: BasisImages, t: Places) -> Places:
    pictures = appearance(images.mix(route.at(t)))
    return np.asarray(cielab_difference(pictures[1:], pictures[:-1]), np.float64)
