"""Size against error of compact libraries: the table and the figure of the page on them.

``python docs/compact.py merl_nbrdf.zip`` or ``python docs/compact.py builtin:merl-abc``; takes 2 GB of temporary files.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from halfway import build_library
from halfway.colour import to_srgb
from halfway.components import compact_library
from halfway.export import figures
from halfway.library import Coding, CompactLibrary, Library
from halfway.look import Looks, appearance, ciede2000_difference, flip, shown
from halfway.tasks import Work

CURVES = {
    "log, shared, int8": (Coding("log", True, "int8"), (5, 15, 36, 72, 108)),
    "linear, each channel, float32 (raw PCA)": (Coding("linear", False, "float32"), (5, 15, 36)),
    "linear, shared, int8": (Coding("linear", True, "int8"), (36, 108)),
    "log, each channel, int8": (Coding("log", False, "int8"), (12, 36)),
    "log, shared, float16": (Coding("log", True, "float16"), (36,)),
}
OUTPUT = Path(__file__).parent / "images" / "compact-libraries.svg"


def main(where: str) -> None:
    """Make every library of `CURVES`, measure it, print the table, and write the figure for the neural fits."""
    with tempfile.TemporaryDirectory() as folder:
        tables = build_library([where], Path(folder) / "tables.brdflib").library
        images = Looks.fit(tables)
        print("| components | k | MB | relative error | log-relative | PSNR | CIEDE2000 | FLIP |")
        print("|---|---|---|---|---|---|---|---|")
        rows: dict[str, list[tuple[float, float, float]]] = {}
        for name, (coding, ks) in CURVES.items():
            for k in ks:
                made = compact_library(
                    tables,
                    Path(folder) / "a.brdfc",
                    n_components=k,
                    coding=coding,
                    work=Work(cache=Path(folder)),
                )
                seen = pictures_apart(images, made)
                error = made.header.error
                rows.setdefault(name, []).append(
                    (made.n_bytes / 1e6, error["mean_relative_error"], seen["psnr"][0])
                )
                print(row(name, k, made, seen), flush=True)
        print_break_even(tables)
    if where.endswith(".zip"):
        draw(rows)


def pictures_apart(images: Looks, made: Library) -> dict[str, tuple[float, float]]:
    """Median and worst of each image metric over the materials, on a lit sphere."""
    a, b = images.images, Looks.fit(made).images
    squared = np.square(encoded(a) - encoded(b)).mean(axis=(1, 2))
    psnr = -10 * np.log10(np.maximum(squared, 1e-12))
    colour = ciede2000_difference(appearance(a), appearance(b))
    eye = np.array([flip(square(images, x), square(images, y)) for x, y in zip(a, b, strict=True)])
    return {
        "psnr": (float(np.median(psnr)), float(psnr.min())),
        "ciede2000": (float(np.median(colour)), float(colour.max())),
        "flip": (float(np.median(eye)), float(eye.max())),
    }


def encoded(rgb: np.ndarray) -> np.ndarray:
    """What a display shows of linear values, as its code values."""
    return to_srgb(shown(rgb))


def square(images: Looks, pixels: np.ndarray) -> np.ndarray:
    """The picture of pixels on the sphere, 0 beside it."""
    picture = np.zeros((*images.scene.mask().shape, 3), np.float32)
    picture[images.scene.mask()] = pixels
    return picture


def row(name: str, k: int, made: CompactLibrary, seen: dict[str, tuple[float, float]]) -> str:
    """A row of the table: medians, and the worst in brackets."""
    error = made.header.error
    (psnr, low), (colour, high), (eye, far) = seen["psnr"], seen["ciede2000"], seen["flip"]
    return (
        f"| {name} | {k} | {made.n_bytes / 1e6:.1f} | {error['mean_relative_error']:.4f} | "
        f"{error['log_relative']:.4f} | {psnr:.1f} ({low:.1f}) dB | {colour:.2f} ({high:.2f}) | "
        f"{eye:.4f} ({far:.4f}) |"
    )


def print_break_even(tables: Library) -> None:
    """From how many materials on components take less room than tables, both before any packing."""
    n_cells = int((~np.isnan(tables.row(0)[0])).sum())
    table = 12 * n_cells
    print(f"\nthe measured cells of one material: {table / 1e6:.2f} MB in float32")
    for name, (coding, _) in CURVES.items():
        size = {"int8": 1, "float16": 2, "float32": 4}[coding.precision]
        n_bytes = coding.n_bases * n_cells * (36 * size + 4)
        print(f"{name}, k = 36: {n_bytes / 1e6:.0f} MB, that of {n_bytes / table:.1f} tables")


def draw(rows: dict[str, list[tuple[float, float, float]]]) -> None:
    """Error and picture against size, one curve per coding."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(figures.STYLE):
        figure = Figure(figsize=(9, 4.2), layout="constrained")
        left, right = figure.subplots(1, 2)
        for name, measured in rows.items():
            size, relative, psnr = zip(*measured, strict=True)
            left.plot(size, relative, "o-", label=name)
            right.plot(size, psnr, "o-", label=name)
        left.set(
            xscale="log", yscale="log", xlabel="file (MB)", ylabel="mean relative error (Table I)"
        )
        right.set(xscale="log", xlabel="file (MB)", ylabel="PSNR of a lit sphere, median (dB)")
        for ax in (left, right):
            ax.set_xticks([5, 10, 20, 50, 100, 200, 400], [5, 10, 20, 50, 100, 200, 400])
            ax.minorticks_off()
        figure.legend(*right.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        figure.savefig(OUTPUT, metadata={"Date": None})


if __name__ == "__main__":
    main(sys.argv[1])
