"""The figures of the page on analytic fits: every material of the given libraries, by every model.

``python docs/analytic_fits.py [LIB...] [MODEL...]``; without a LIB the built-in one. ``--all`` prints each material too.
"""

import sys
import time
from collections.abc import Sequence

import numpy as np

from halfway import open_library
from halfway.fit import MODELS, Fit, fit

N_WORST = 4


def main(arguments: Sequence[str]) -> None:
    """Fit, and print tables in Markdown."""
    everything = "--all" in arguments
    models = [a for a in arguments if a in MODELS] or [*MODELS]
    for where in [a for a in arguments if a not in ("--all", *MODELS)] or ["builtin:merl-abc"]:
        library = open_library(where)
        fits: dict[str, list[Fit]] = {model: [] for model in models}
        seconds: dict[str, list[float]] = {model: [] for model in models}
        for name in library.names:
            brdf = library.brdf(name)
            for model in models:
                start = time.process_time()
                fits[model].append(fit(brdf, model, name=name))
                seconds[model].append(time.process_time() - start)
        print(f"\n{library.name}: {len(library)} materials\n")
        print(
            "| model | dB: median | tenth lowest | lowest | albedo: median | highest | s | lowest four, dB |"
        )
        print("|---|---|---|---|---|---|---|---|")
        for model in models:
            print_line(model, fits[model], seconds[model])
        for model in models:
            print_readings(fits[model])
        if everything:
            print_all(fits)


def print_line(model: str, fits: Sequence[Fit], seconds: Sequence[float]) -> None:
    """A line of the table of models."""
    fits = sorted(fits, key=lambda found: found.picture.psnr)
    psnr = np.array([found.picture.psnr for found in fits])
    albedo = np.array([found.albedo_error for found in fits])
    worst = ", ".join(f"{found.name} {found.picture.psnr:.1f}" for found in fits[:N_WORST])
    print(
        f"| {model} | {np.median(psnr):.1f} | {psnr[min(9, len(psnr) - 1)]:.1f} | {psnr[0]:.1f} | "
        f"{np.median(albedo):.3f} | {albedo.max():.3f} | {np.median(seconds):.2f} | {worst} |"
    )


def print_readings(fits: Sequence[Fit]) -> None:
    """What other programs make of the fits: the median and the tenth lowest."""
    for name in fits[0].readings:
        psnr = np.sort([found.readings[name].psnr for found in fits])
        print(
            f"\n{name}: {np.median(psnr):.1f} dB in the median, {psnr[min(9, len(psnr) - 1)]:.1f} the tenth lowest"
        )


def print_all(fits: dict[str, list[Fit]]) -> None:
    """A line for each material: dB and albedo by every model."""
    print("\n| material | " + " | ".join(fits) + " |\n|---|" + "---|" * len(fits))
    by_name = [{found.name: found for found in found_all} for found_all in fits.values()]
    for name in sorted(by_name[0]):
        cells = [f"{f[name].picture.psnr:.1f} dB, {f[name].albedo_error:.3f}" for f in by_name]
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main(sys.argv[1:])
