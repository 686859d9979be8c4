"""Realism against detour, over the options ``--detour`` and ``-k``: the figure and the tables of the page on navigation.

``python docs/navigation.py LIB``, with LIB of the neural fits on 90 x 30 x 36 cells.
"""

import sys
from pathlib import Path

import numpy as np

from halfway import open_library
from halfway.cli.console import cache_folder
from halfway.export import figures
from halfway.judge import Bench, evaluate, sample_pairs, uniform
from halfway.space import make_space
from halfway.tasks import Work

DETOURS = (1.0, 1.02, 1.05, 1.1, 1.2, 1.5, np.inf)
COMPONENTS = (1, 2, 3, 4, 6)
"""Numbers of joint scores, without a bound on the detour."""
N_PAIRS = 60
OUTPUT = Path(__file__).parent / "images" / "realism-and-detour.svg"


def main(where: str) -> None:
    """Measure every option on the same pairs; print the table and write the figure."""
    library = open_library(where)
    work = Work(cache=cache_folder())
    bench = Bench.fit(library, work=work)
    spaces = {
        f"anchored, {d:g}": make_space("anchored", library, detour=d, work=work) for d in DETOURS
    }
    for k in COMPONENTS:
        free = make_space("anchored", library, n_components=k, detour=np.inf, work=work)
        spaces[f"{k} scores and body colour, inf"] = free
    spaces |= {name: make_space(name, library, work=work) for name in ("linear", "paper")}
    rows: dict[str, tuple[float, float]] = {}
    print(
        "| space | detour, median | 90th percentile | max | realism, by cell | by solid angle | seen | others |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for name, space in spaces.items():
        measures = evaluate(
            space, bench, sample_pairs(len(library), N_PAIRS), paces={"uniform": uniform}
        ).to_json()
        detour, realism = measures["detour"], measures["realism"]
        rows[name] = detour["90th percentile"], realism["log by cell"]["median"]
        print(
            f"| {name} | {detour['median']:.3f} | {detour['90th percentile']:.3f} | {detour['max']:.2f} | "
            f"{realism['log by cell']['median']:.4f} | {realism['log']['median']:.4f} | "
            f"{realism['seen']['median']:.2f} | {measures['others']['median']:.2f} |",
            flush=True,
        )
    draw(rows)


def draw(rows: dict[str, tuple[float, float]]) -> None:
    """One point per option; the anchored ones are a curve."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(figures.STYLE):
        figure = Figure(figsize=(6, 4), layout="constrained")
        ax = figure.subplots()
        curve = [point for name, point in rows.items() if name.startswith("anchored")]
        ax.plot(*zip(*curve, strict=True), "o-", color="#2f6dc8", label="anchored, by --detour")
        for name, point in rows.items():
            if not name.startswith("anchored"):
                ax.plot(*point, "s", label=name)
                continue
            ax.annotate(
                name.removeprefix("anchored, "),
                point,
                xytext=(-4, -12) if name.endswith(("1.1", "1.5")) else (6, 4),
                textcoords="offset points",
                fontsize=8,
            )
        ax.set(
            xscale="log",
            xlabel="detour, 90th percentile",
            ylabel="log difference from the nearest material, median",
        )
        ax.legend()
        figure.savefig(OUTPUT, metadata={"Date": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
