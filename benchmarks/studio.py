"""One teapot under the studio that wears any of Mitsuba's materials, and the materials that a table is compared with.

A GGX lobe over Lambert as a model, to make a table of, as ``blendbsdf`` of ``diffuse`` and ``roughconductor``, and roughly as
``principled``; and any table as a ``.bsdf`` file in ``measured``.
"""

import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from halfway.brdf import IsotropicModel, TabularBrdf
from halfway.formats import write_rgl
from halfway.render import Renderer

ALPHA = 0.2
DIFFUSE = (0.5, 0.3, 0.2)
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


class Studio:
    """Pictures of BSDFs; the scene of each is loaded once."""

    def __init__(self, size: int) -> None:
        self._renderer = Renderer("teapot", size=(size, size))

    def wearing(self, bsdf: Any) -> Any:
        """The scene in which the teapot wears a BSDF."""
        from halfway.render.stage import _sensor

        stage = self._renderer._stage
        sensor = _sensor(self._renderer.scene.camera, self._renderer.size, stage._window())
        return stage._load([bsdf], sensor, ground=False)[0]

    def render(self, scene: Any, spp: int, seed: int) -> np.ndarray:
        import mitsuba as mi

        integrator = mi.load_dict({"type": "direct", "hide_emitters": True})
        return np.array(mi.render(scene, integrator=integrator, spp=spp, seed=mi.UInt32(seed)))

    def error(self, scene: Any, spp: int, *, n: int = 4) -> float:
        """Mean squared error of a picture of so many samples, from ``n`` of them and one of 64 times as many."""
        best = np.mean([self.render(scene, 16 * spp, 100 + seed) for seed in range(4)], axis=0)
        return float(
            np.mean([(self.render(scene, spp, seed) - best)[..., :3] ** 2 for seed in range(n)])
        )

    def seconds(self, scene: Any, spp: int, *, clock=time.process_time, rounds: int = 3) -> float:
        """The least time of a picture, by the clock of the CPU or another."""
        self.render(scene, spp, 0)
        taken = []
        for seed in range(rounds):
            start = clock()
            self.render(scene, spp, seed)
            taken.append(clock() - start)
        return min(taken)


def table_bsdf(table: TabularBrdf) -> Any:
    """A table as `halfway_table`."""
    import mitsuba as mi

    from halfway.render.bsdf import TableBsdf

    return TableBsdf(mi.Properties(), table)


def measured_bsdf(table: TabularBrdf) -> Any:
    """The table's ``.bsdf`` file in Mitsuba's ``measured``."""
    import mitsuba as mi

    with TemporaryDirectory() as folder:
        path = Path(folder) / "table.bsdf"
        write_rgl(path, table)
        return mi.load_dict({"type": "measured", "filename": str(path)})
