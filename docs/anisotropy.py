"""The figures and pictures of the page on anisotropic materials.

``python docs/anisotropy.py grid`` draws the error of a table against its size, ``spheres`` pictures some of the materials, ``files``
measures what a file of each format becomes, ``mitsuba`` what stock Mitsuba shows of a ``.bsdf`` file, ``library LIB`` how the spaces of
a library of them do.
"""

import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from halfway import Brdf, Grid, open_library, tabulate
from halfway.brdf import lit_sphere, quality
from halfway.cli.console import cache_folder
from halfway.export import figures
from halfway.formats import read_rgl, write_rgl
from halfway.formats.rgl_writer import N_ANISOTROPIC, RESOLUTIONS
from halfway.judge import Bench, evaluate, leave_one_out, sample_pairs, uniform
from halfway.look import portrait, to_png
from halfway.models import builtin
from halfway.models.anisotropic import Lobe, Microfacets
from halfway.models.brushed import refractive_index
from halfway.render import Renderer
from halfway.space import make_space
from halfway.tasks import Work

IMAGES = Path(__file__).parent / "images"
USUAL = {"n_theta_h": 64, "n_phi_h": 180, "n_theta_d": 24, "n_phi_d": 20}
"""Of `Grid.anisotropic`, in a whole turn."""
TRIED = {
    "n_theta_h": (16, 32, 48, 90),
    "n_phi_h": (36, 72, 120, 240),
    "n_theta_d": (6, 12, 16, 36),
    "n_phi_d": (5, 10, 14, 36),
}
SHOWN = (
    "brushed-steel", "turned-steel", "crosshatched-steel", "brushed-gold", "anodised-blue", "vinyl-record",
    "hairline-plastic-red", "rolled-brass", "varnished-plywood", "satin-purple", "shot-silk", "denim",
)  # fmt: skip
N_PAIRS = 60


def materials() -> dict[str, Brdf]:
    """What the grids are tried on."""
    n, k = refractive_index("steel")
    slopes = ((0.05, 0.5), (0.05, 0.15), (0.1, 0.4), (0.2, 0.4))
    steels = {f"steel {x:g} x {y:g}": Microfacets((Lobe(x, y, n, k),)) for x, y in slopes}
    others = builtin("anisotropic").models
    return {**steels, "hairline plastic": others["hairline-plastic-red"], "denim": others["denim"]}


def grid() -> None:
    """The error of tables with one size after the other changed, on a lit sphere."""
    tried = materials()
    expected = {name: lit_sphere(brdf) for name, brdf in tried.items()}
    print("| cells in a whole turn | MB |", " | ".join(tried), "|")
    print("|---|---|" + "---|" * len(tried))
    rows: dict[tuple[str, int], dict[str, float]] = {}
    for axis, sizes in {"": (0,), **TRIED}.items():
        for size in sizes:
            sizes_of = {**USUAL, axis: size} if axis else USUAL
            half = Grid.anisotropic(**{**sizes_of, "n_phi_h": sizes_of["n_phi_h"] // 2}, period=np.pi)  # fmt: skip
            found = {
                name: quality(lit_sphere(tabulate(brdf, half)), expected[name]).psnr
                for name, brdf in tried.items()
            }
            rows[axis, size] = found
            print(
                f"| {' x '.join(map(str, sizes_of.values()))} | {24 * half.size / 1e6:.0f} |",
                " | ".join(f"{psnr:.1f}" for psnr in found.values()),
                "|",
                flush=True,
            )
    draw(rows)


def draw(rows: Mapping[tuple[str, int], Mapping[str, float]]) -> None:
    """One plot for each axis, one line for each material."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(figures.STYLE):
        figure = Figure(figsize=(10, 3), layout="constrained")
        for ax, axis in zip(figure.subplots(1, 4, sharey=True), TRIED, strict=True):
            sizes = sorted({USUAL[axis], *TRIED[axis]})
            for name in rows["", 0]:
                psnr = [rows[("", 0) if n == USUAL[axis] else (axis, n)][name] for n in sizes]
                ax.plot(sizes, psnr, "o-", ms=3, label=name)
            ax.axvline(USUAL[axis], color="#999999", lw=0.8)
            ax.set(xscale="log", xlabel=f"cells in {axis.removeprefix('n_')}")
            ax.set_xticks(sizes, [str(n) for n in sizes])
            ax.minorticks_off()
        figure.axes[0].set_ylabel("dB of the lit sphere")
        figure.axes[0].legend(fontsize=7)
        figure.savefig(IMAGES / "anisotropic-grid.svg", metadata={"Date": None})


def spheres() -> None:
    """A strip of portraits."""
    from PIL import Image

    half = Grid.anisotropic(48, 60, 16, 12, period=np.pi)
    library = open_library("builtin:anisotropic", grid=half)
    pictures = [portrait(library.row(library.index(name)), half) for name in SHOWN]
    with tempfile.TemporaryDirectory() as folder:
        rows: list[Image.Image] = []
        for start in (0, 6):
            file = Path(folder, "row.png")
            file.write_bytes(to_png(pictures[start : start + 6]))
            rows.append(Image.open(file).convert("RGBA"))
    whole = Image.new("RGBA", (rows[0].width, sum(row.height for row in rows) + 6))
    whole.paste(rows[0], (0, 0))
    whole.paste(rows[1], (0, rows[0].height + 6))
    whole.save(IMAGES / "anisotropic.webp", quality=90)


def files() -> None:
    """What a `.bsdf` file and a UTIA grid keep of some materials, on a lit sphere."""
    sys.path.append(str(Path(__file__).parents[1] / "tests"))
    from gonio_files import csail, utia

    from halfway.formats import read_brdf

    print("| material | .bsdf, dB | size | UTIA's grid, dB | MIT CSAIL's, dB |")
    print("|---|---|---|---|---|")
    models = builtin("anisotropic").models
    for name in ("brushed-steel", "turned-steel", "satin-steel", "hairline-plastic-red", "denim"):
        brdf = models[name]
        expected = lit_sphere(brdf)
        with tempfile.TemporaryDirectory() as folder:
            written = write_rgl(Path(folder, "x.bsdf"), brdf)
            assert not read_rgl(written.path).is_isotropic
            Path(folder, "x.bin").write_bytes(utia(brdf))
            Path(folder, "x.dat").write_bytes(csail(brdf, (45, 45, 90, 90), half=True))
            others = [
                quality(lit_sphere(read_brdf(Path(folder, f"x.{suffix}"))), expected).psnr
                for suffix in ("bin", "dat")
            ]
        size = "{} x {}²".format(*written.resolution)
        print(f"| {name} | {written.quality.psnr:.1f} | {size} | {others[0]:.1f} | {others[1]:.1f} |", flush=True)  # fmt: skip


def mitsuba() -> None:
    """Mitsuba's rough conductor: its table, written as files of several sizes, in its own reader, by pictures of a lit sphere."""
    sys.path.append(str(Path(__file__).parents[1] / "tests"))
    from roughconductor import anisotropic, plugin

    renderer = Renderer("sphere", size=(256, 256), spp=64)
    print("| slopes | directions, values | MB | dB |\n|---|---|---|---|")
    for alphas in ((0.05, 0.3), (0.2, 0.4)):
        table = anisotropic(*alphas)
        for size in RESOLUTIONS[:N_ANISOTROPIC]:
            with tempfile.TemporaryDirectory() as folder:
                path = write_rgl(Path(folder, "x.bsdf"), table, resolution=size).path
                worn = {"type": "measured", "filename": str(path)}
                found, expected = (
                    np.clip(renderer.picture(each), 0, 1) for each in (worn, plugin(*alphas))
                )
                psnr = -10 * np.log10(np.mean((found - expected) ** 2))
                sizes = "{} x {}²".format(*size)
                print(
                    f"| {alphas} | {sizes} | {path.stat().st_size / 1e6:.0f} | {psnr:.1f} |",
                    flush=True,
                )


def library(where: str) -> None:
    """Leaving one out, and the detours of routes, by space."""
    opened, work = open_library(where), Work(cache=cache_folder())
    bench = Bench.fit(opened, work=work)
    print("| space | left out, log metric: mean | seen: mean | worst | detour, median | 90th percentile |")  # fmt: skip
    print("|---|---|---|---|---|---|")
    for name in ("paper", "linear", "anchored"):
        space = make_space(name, opened, work=work)
        detour = evaluate(
            space, bench, sample_pairs(len(opened), N_PAIRS), paces={"uniform": uniform}
        ).to_json()["detour"]
        errors = leave_one_out(space, bench, work=work).to_json() if space.charts else None
        left = (
            f"{errors['log']['mean']:.4f} | {errors['seen']['mean']:.2f} | {errors['seen']['worst']} {errors['seen']['max']:.1f}"
            if errors
            else "- | - | -"
        )
        print(f"| {name} | {left} | {detour['median']:.3f} | {detour['90th percentile']:.3f} |", flush=True)  # fmt: skip


WORK: Mapping[str, Callable[..., None]] = {
    "grid": grid,
    "spheres": spheres,
    "files": files,
    "mitsuba": mitsuba,
    "library": library,
}

if __name__ == "__main__":
    WORK[sys.argv[1]](*sys.argv[2:])
