"""The table against Mitsuba's own materials: what a picture costs, and the time to the same error.

Teapot, environment light, direct, 64 samples a pixel. The time to the same error is CPU time x mean squared error.
"""

import numpy as np
import pytest
from studio import BLEND, PRINCIPLED, Blend, Studio, measured_bsdf, table_bsdf

from halfway.brdf import tabulate
from halfway.halfdiff import MERL
from halfway.library import open_library

SIZE = 256
SPP = 64
VIEWS = (0, 20, 45, 70, 85)
TABLES = "blue-fabric", "gold-paint", "cherry-235"


@pytest.fixture(scope="module")
def studios() -> tuple[Studio, Studio]:
    """Of the size that is timed, and of the one whose error is measured."""
    return Studio(SIZE), Studio(SIZE // 4)


def bench_analytic(figures, studios):
    import mitsuba as mi

    blend, principled = mi.load_dict(BLEND), mi.load_dict(PRINCIPLED)
    table = table_bsdf(tabulate(Blend(), MERL))
    what = f"a picture of {SIZE} x {SIZE}, {SPP} spp"
    costs = {bsdf: _costs(studios, bsdf) for bsdf in (blend, principled, table)}
    for name, bsdf in (("principled", principled), ("table", table)):
        seconds, to_error = np.divide(costs[bsdf], costs[blend])
        figures.note(what, f"{name} / blend of two lobes", seconds)
        figures.note(f"{what}, to the same error", f"{name} / blend of two lobes", to_error)
    deviation = _deviation(table) / _deviation(blend)
    figures.note("deviation of sample weights", "table / blend of two lobes", deviation)


@pytest.mark.parametrize("name", TABLES)
def bench_measured(figures, studios, name):
    table = open_library("builtin:merl-abc").brdf(name)
    ours, theirs = (_costs(studios, bsdf) for bsdf in (table_bsdf(table), measured_bsdf(table)))
    what = f"a picture of {name}, {SPP} spp"
    figures.note(what, "table / Mitsuba's measured", ours[0] / theirs[0])
    figures.note(f"{what}, to the same error", "table / Mitsuba's measured", ours[1] / theirs[1])


def _costs(studios: tuple[Studio, Studio], bsdf) -> tuple[float, float]:
    """CPU seconds of a picture, and those times its mean squared error."""
    timed, small = studios
    seconds = timed.seconds(timed.wearing(bsdf), SPP)
    return seconds, seconds * small.error(small.wearing(bsdf), SPP)


def _deviation(bsdf, n: int = 200_000) -> float:
    """Of the sample weights over their mean, averaged over five view angles."""
    import drjit as dr
    import mitsuba as mi

    deviations = []
    for view in np.radians(VIEWS):
        si = dr.zeros(mi.SurfaceInteraction3f, n)
        si.wi = mi.Vector3f(0, float(np.sin(view)), float(np.cos(view)))
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(3, n)
        _, weight = bsdf.sample(mi.BSDFContext(), si, sampler.next_1d(), sampler.next_2d())
        weight = np.array(weight).mean(axis=0)
        deviations.append(weight.std() / weight.mean())
    return float(np.mean(deviations))
