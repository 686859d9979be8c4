"""The figures of the page on analytic fits: every material of the given libraries, by every model.

``python docs/analytic_fits.py [LIB...]``; without a LIB the built-in one. ``--all`` prints each material too.
"""

import sys
import time
from collections.abc import Sequence

import numpy as np

from halfway import Library, open_library
from halfway.fit import MODELS, Fit, fit

N_WORST = 4


def main(arguments: Sequence[str]) -> None:
    """Fit, and print tables in Markdown."""
    everything = "--all" in arguments
    for where in [a for a in arguments if a != "--all"] or ["builtin:merl-abc"]:
        library = open_library(where)
        print(f"\n{library.name}: {len(library)} materials\n")
        print(
            "| model | dB: median | tenth lowest | lowest | albedo: median | highest | s | lowest four, dB |"
        )
        print("|---|---|---|---|---|---|---|---|")
        fits = {model: measure(library, model) for model in MODELS}
        if everything:
            print_all(fits)


def measure(library: Library, model: str) -> list[Fit]:
    """The fits of a library; prints a line of the table."""
    fits, seconds = [], []
    for name in library.names:
        brdf = library.brdf(name)
        start = time.process_time()
        fits.append(fit(brdf, model, name=name))
        seconds.append(time.process_time() - start)
    fits.sort(key=lambda found: found.picture.psnr)
    psnr = np.array([found.picture.psnr for found in fits])
    albedo = np.array([found.albedo_error for found in fits])
    worst = ", ".join(f"{found.name} {found.picture.psnr:.1f}" for found in fits[:N_WORST])
    print(
        f"| {model} | {np.median(psnr):.1f} | {psnr[min(9, len(psnr) - 1)]:.1f} | {psnr[0]:.1f} | "
        f"{np.median(albedo):.3f} | {albedo.max():.3f} | {np.median(seconds):.2f} | {worst} |",
        flush=True,
    )
    return fits


def print_all(fits: dict[str, list[Fit]]) -> None:
    """A line for each material: dB and albedo by every model."""
    print("\n| material | " + " | ".join(fits) + " |\n|---|" + "---|" * len(fits))
    by_name = [{found.name: found for found in found_all} for found_all in fits.values()]
    for name in sorted(by_name[0]):
        cells = [f"{f[name].picture.psnr:.1f} dB, {f[name].albedo_error:.3f}" for f in by_name]
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main(sys.argv[1:])
