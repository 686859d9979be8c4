"""Rendering on a graphics card: is it chosen, is it right, and what does it take.

``python benchmarks/gpu.py`` prints what `halfway doctor` finds, the largest difference of values that the BSDF looks up from
those of the table, and milliseconds: of a picture as a table, as Mitsuba's own blend and as its ``measured``, and of a new table. An
anisotropic table is made of Mitsuba's rough conductor, and its picture compared with that plugin's.
Where there is no card it runs on the CPU, smaller (``--size 96``).
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from bench_render import BLEND, Blend

from halfway.brdf import TabularBrdf, tabulate
from halfway.formats import write_rgl
from halfway.halfdiff import MERL
from halfway.library import open_library
from halfway.render import Renderer, doctor

sys.path.append(str(Path(__file__).parents[1] / "tests"))
N_PAIRS = 1 << 20
ROUNDS = 7


def main() -> None:
    """Measure, and print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--spp", type=int, default=64)
    given = parser.parse_args()
    for finding in doctor():
        print(f"{finding.what:14} {finding.found or 'missing: ' + finding.cost}")
    renderer = Renderer("teapot", size=(given.size, given.size), spp=given.spp)
    import mitsuba as mi

    print(f"variant        {mi.variant()}")
    library = open_library("builtin:merl-abc")
    print(f"values         {_largest_difference(library.brdf('gold-paint'), mi):.1e} relative")
    table = tabulate(Blend(), MERL)
    what = f"{given.size} x {given.size}, {given.spp} spp"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "blend.bsdf"
        write_rgl(file, table)
        materials = {
            "table": table,
            "blend": BLEND,
            "measured": {"type": "measured", "filename": str(file)},
        }
        for name, material in materials.items():
            taken = _milliseconds(lambda material=material: renderer.picture(material))
            print(f"{name:14} {taken:.1f} ms a picture, {what}")
    names = iter(library.names)
    tables = [library.brdf(next(names)) for _ in range(ROUNDS + 2)]
    others = iter(tables)
    print(
        f"new table      {_milliseconds(lambda: renderer.picture(next(others))):.1f} ms, its picture included"
    )
    _anisotropic(Renderer("sphere", size=(given.size, given.size), spp=given.spp), what)


def _anisotropic(renderer: Renderer, what: str) -> None:
    """How near and how fast a table of a brushed conductor is, beside the plugin that it is made of."""
    from roughconductor import anisotropic, plugin

    alphas = 0.05, 0.3
    table = anisotropic(*alphas)
    shown, expected = (np.clip(renderer.picture(each), 0, 1) for each in (table, plugin(*alphas)))
    error = -10 * np.log10(np.mean((shown - expected) ** 2))
    print(
        f"anisotropic    {error:.1f} dB from Mitsuba's roughconductor, alpha {alphas[0]} x {alphas[1]}"
    )
    for name, material in {"anisotropic": table, "its plugin": plugin(*alphas)}.items():
        taken = _milliseconds(lambda material=material: renderer.picture(material))
        print(f"{name:14} {taken:.1f} ms a picture of a sphere, {what}")


def _largest_difference(table: TabularBrdf, mi) -> float:
    """Of the BSDF's values from the table's, on random pairs of directions, relative to the mean value."""
    from halfway.render.bsdf import TableBsdf

    rng = np.random.default_rng(0)
    wi, wo = (_hemisphere(rng.random((N_PAIRS, 2))) for _ in range(2))
    import drjit as dr

    si = dr.zeros(mi.SurfaceInteraction3f, N_PAIRS)
    si.wi = mi.Vector3f(np.ascontiguousarray(wo.T, np.float32))
    to_light = mi.Vector3f(np.ascontiguousarray(wi.T, np.float32))
    bsdf = TableBsdf(mi.Properties(), table)
    values = np.array(bsdf.eval(mi.BSDFContext(), si, to_light)).T / wi[:, 2:]
    expected = np.nan_to_num(table.eval(wi, wo))
    return float(np.abs(values - expected).max() / expected.mean())


def _hemisphere(u: np.ndarray) -> np.ndarray:
    # Away from the horizon, where 32 bits tell above from below another way than 64.
    z = 0.05 + 0.95 * u[:, 0]
    r, phi = np.sqrt(1 - z * z), 2 * np.pi * u[:, 1]
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)


def _milliseconds(f: Callable[[], object]) -> float:
    """The median of some rounds after two that compile."""
    times = []
    for _ in range(ROUNDS + 2):
        start = time.perf_counter()
        f()
        times.append(1000 * (time.perf_counter() - start))
    return float(np.median(times[2:]))


if __name__ == "__main__":
    main()
