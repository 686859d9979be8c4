"""The table against Mitsuba's own analytic materials, in one run: cost, noise, and time to the same error.

The same material three times, a GGX lobe over Lambert: as a table, as ``blendbsdf`` of ``diffuse`` and
``roughconductor``, and roughly as ``principled``. Teapot, environment light, direct, 64 samples a pixel. Reported beside the
CPU time, as ratios to the blend:

    deviation    standard deviation of the sample weights over their mean, averaged over five view angles
    error        CPU time x mean squared error: time to the same error
"""

import time
from collections.abc import Iterator

import numpy as np
import pytest

from halfway.brdf import IsotropicModel, tabulate
from halfway.halfdiff import MERL
from halfway.render import Renderer

ALPHA = 0.2
DIFFUSE = (0.5, 0.3, 0.2)
SIZE = 512
SPP = 64
VIEWS = (0, 20, 45, 70, 85)
BLEND = {
    "type": "blendbsdf",
    "weight": 0.5,
    "diffuse": {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(DIFFUSE)}},
    "lobe": {"type": "roughconductor", "alpha": ALPHA, "distribution": "ggx", "material": "none"},
}
PRINCIPLED = {
    "type": "principled",
    "base_color": {"type": "rgb", "value": list(DIFFUSE)},
    "roughness": ALPHA**0.5,
    "metallic": 0.5,
}


class Blend(IsotropicModel):
    """What `BLEND` is: half Lambert, half a GGX mirror (Walter et al., EGSR 2007, equations 20, 33, 34)."""

    formula = "blend"

    def at(self, theta_h, theta_d, phi_d, cos_i, cos_o):  # noqa: ARG002
        a2 = ALPHA**2
        D = a2 / (np.pi * (np.cos(theta_h) ** 2 * (a2 - 1) + 1) ** 2)
        lobe = D * _g1(cos_i, a2) * _g1(cos_o, a2) / (4 * cos_i * cos_o)
        return 0.5 * (np.array(DIFFUSE).reshape(3, *[1] * np.ndim(lobe)) / np.pi + lobe)


def _g1(c, a2):
    return 2 * c / (c + np.sqrt(a2 + (1 - a2) * c * c))


@pytest.fixture(scope="module")
def studio() -> "Studio":
    return Studio()


class Studio:
    """One teapot that wears any BSDF."""

    def __init__(self) -> None:
        self.table = tabulate(Blend(), MERL)
        self._stages = {
            size: Renderer("teapot", size=(size, size), spp=SPP)._stage
            for size in (SIZE, SIZE // 4)
        }

    def wearing(self, bsdf, size: int = SIZE):
        return self._stages[size]._load([bsdf], ground=False)[0]

    def render(self, scene, spp: int, seed: int) -> np.ndarray:
        import mitsuba as mi

        integrator = mi.load_dict({"type": "direct", "hide_emitters": True})
        return np.array(mi.render(scene, integrator=integrator, spp=spp, seed=mi.UInt32(seed)))


@pytest.fixture(scope="module")
def ratios() -> Iterator[dict[str, dict[str, float]]]:
    measured: dict[str, dict[str, float]] = {}
    yield measured
    print("\n\nratio to the blend      time  deviation  error")
    for name, values in measured.items():
        shares = [values[k] / measured["blend"][k] for k in ("time", "deviation", "error")]
        print(f"{name:20s}  {shares[0]:6.2f}  {shares[1]:9.2f}  {shares[2]:5.2f}")


@pytest.mark.parametrize("name", ["blend", "principled", "table"])
@pytest.mark.benchmark(group="teapot, 512 x 512, 64 spp", timer=time.process_time)
def test_teapot(benchmark, studio, ratios, name):
    import mitsuba as mi

    bsdf = _bsdf(studio, name, mi)
    scene = studio.wearing(bsdf)
    benchmark.pedantic(studio.render, (scene, SPP, 1), rounds=3, warmup_rounds=1)
    small = studio.wearing(bsdf, SIZE // 4)
    difference = studio.render(small, SPP, 1) - studio.render(small, 16 * SPP, 2)
    mean_squared = np.mean(difference[..., :3] ** 2)
    seconds = benchmark.stats["min"]
    ratios[name] = {
        "time": seconds,
        "deviation": _deviation(bsdf, mi),
        "error": seconds * mean_squared,
    }


def _bsdf(studio: Studio, name: str, mi):
    from halfway.render.bsdf import TableBsdf

    match name:
        case "blend":
            return mi.load_dict(BLEND)
        case "principled":
            return mi.load_dict(PRINCIPLED)
        case _:
            return TableBsdf(mi.Properties(), studio.table)


def _deviation(bsdf, mi, n: int = 200_000) -> float:
    import drjit as dr

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
