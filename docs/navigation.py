"""Realism against detour, over the options ``--detour`` and ``-k``: the figure and the tables of the page on navigation.

``python docs/navigation.py merl_nbrdf.zip``
"""

import sys
from pathlib import Path

import numpy as np

from halfway import Pca, open_library
from halfway.cli.console import cache_folder
from halfway.export.figures import STYLE
from halfway.judge import Bench, evaluate, sample_pairs
from halfway.judge.evaluation import uniform
from halfway.space import LinearSpace, PaperSpace, make_space
from halfway.tasks import Work

DETOURS = (1.0, 1.02, 1.05, 1.1, 1.2, 1.5, np.inf)
COMPONENTS = (1, 2, 4, 6, 8)
"""Numbers of joint scores in place of 3, without a bound on the detour."""
N_PAIRS = 200
OUTPUT = Path(__file__).parent / "images" / "realism-and-detour.svg"


def main(where: str) -> None:
    """Measure every option on the same pairs; print the table and write the figure."""
    library = open_library(where)
    cache = cache_folder()
    bench = Bench.fit(library, work=Work(cache=cache))
    spaces = {
        f"anchored, {d:g}": make_space("anchored", library, detour=d, work=Work(cache=cache))
        for d in DETOURS
    }
    for k in COMPONENTS:
        made = make_space(
            "anchored", library, n_components=k, detour=np.inf, work=Work(cache=cache)
        )
        spaces[f"{k} scores and body colour, inf"] = made
    spaces["linear"] = LinearSpace.of(library)
    spaces["paper"] = PaperSpace.fit(library, Pca.fit(library, work=Work(cache=cache)))
    rows: dict[str, tuple[float, float]] = {}
    print(
        "| space | detour, median | 90th percentile | max | realism, by cell | by solid angle | seen | others |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for name, space in spaces.items():
        found = evaluate(
            space, bench, sample_pairs(len(library), N_PAIRS), paces={"uniform": uniform}
        ).to_json()
        detour, realism = found["detour"], found["realism"]
        rows[name] = detour["90th percentile"], realism["log by cell"]["median"]
        print(
            f"| {name} | {detour['median']:.3f} | {detour['90th percentile']:.3f} | {detour['max']:.2f} | "
            f"{realism['log by cell']['median']:.4f} | {realism['log']['median']:.4f} | "
            f"{realism['seen']['median']:.2f} | {found['others']['median']:.2f} |",
            flush=True,
        )
    draw(rows)


def draw(rows: dict[str, tuple[float, float]]) -> None:
    """One point per option; the anchored ones are a curve."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6, 4), layout="constrained")
        ax = figure.subplots()
        curve = [place for name, place in rows.items() if name.startswith("anchored")]
        ax.plot(*zip(*curve, strict=True), "o-", color="#2f6dc8", label="anchored, by --detour")
        for name, place in rows.items():
            if not name.startswith("anchored"):
                ax.plot(*place, "s", label=name)
                continue
            ax.annotate(
                name.removeprefix("anchored, "),
                place,
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
