"""The paper's Figures 2 and 3, and spaces compared, as matplotlib figures."""

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec

import numpy as np

from ..components import Pca
from ..files import replacing
from ..locations import Location
from ..space import Triangulation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

P = ParamSpec("P")

COLOURS = {"red": "#c8442f", "green": "#3d8a4e", "blue": "#2f6dc8"}
STYLE: Any = {
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 11,
    "axes.titlelocation": "left",
    "legend.frameon": False,
    "svg.hashsalt": "halfway",
}
ZOOM = 5, 95
"""Percentiles of the scores that the lower row of the scatter spans."""


def styled(draw: Callable[P, "Figure"]) -> Callable[P, "Figure"]:
    """``draw`` in the style of all figures."""

    @wraps(draw)
    def in_style(*args: P.args, **kwargs: P.kwargs) -> "Figure":
        import matplotlib as mpl

        with mpl.rc_context(STYLE):
            return draw(*args, **kwargs)

    return in_style


def empty(size: tuple[float, float]) -> "Figure":
    """A figure to draw on, of so many inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=size, layout="constrained")


@styled
def eigenvalues(pca: Pca, label: str) -> "Figure":
    """Eigenvalues of the covariance (eq. 3) per channel, and the share of variance beyond k components (Fig. 3)."""
    figure = empty((10, 3.8))
    left, right = figure.subplots(1, 2)
    for values, (name, colour) in zip(pca.eigenvalues, COLOURS.items(), strict=True):
        # The last eigenvalue of centred data is 0 but for rounding.
        shown = values[:-1]
        left.semilogy(
            np.arange(1, len(shown) + 1), shown, ".-", color=colour, label=name, ms=4, lw=1
        )
        beyond = np.append(shown[::-1].cumsum()[::-1][1:], 0) / shown.sum()
        right.semilogy(np.arange(1, len(shown)), beyond[:-1], ".-", color=colour, ms=4, lw=1)
    left.set(xlabel="component", ylabel="eigenvalue (1/sr²)", title="Eigenvalues of the covariance")
    right.set(
        xlabel="components kept", ylabel="share of variance left", title="What k components leave"
    )
    left.legend()
    _caption(figure, f"{label}: {len(pca.names)} materials")
    return figure


@styled
def triangulation(pca: Pca, label: str) -> "Figure":
    """The first two scores of each channel and their Delaunay triangulation (Fig. 2).

    A few mirror-like materials have scores far from the others'; the lower row shows where most are.
    """
    figure = empty((12, 7.6))
    rows = figure.subplots(2, 3)
    colours = list(COLOURS.items())
    for points, whole, zoomed, (name, colour) in zip(pca.scores(2), *rows, colours, strict=True):
        simplices = Triangulation.of(points).simplices
        for ax in (whole, zoomed):
            if simplices.shape[1] == 3:
                ax.triplot(*points.T, simplices, color=colour, lw=0.5, alpha=0.6)
            ax.plot(*points.T, "o", color=colour, ms=3)
            ax.ticklabel_format(style="sci", scilimits=(-2, 3))
        whole.set_title(name)
        (left, bottom), (right, top) = np.percentile(points, ZOOM, axis=0)
        margins = 0.15 * (right - left), 0.15 * (top - bottom)
        zoomed.set(
            xlim=(left - margins[0], right + margins[0]),
            ylim=(bottom - margins[1], top + margins[1]),
        )
        zoomed.set_xlabel("score 1 (1/sr)")
    for ax, what in zip(
        rows[:, 0], ("all materials", f"percentiles {ZOOM[0]} to {ZOOM[1]}"), strict=True
    ):
        ax.set_ylabel(f"score 2 (1/sr), {what}")
    _caption(
        figure,
        f"{label}: {len(pca.names)} materials, Delaunay triangulation of two scores per channel",
    )
    return figure


@styled
def spaces(measured: Sequence[Mapping[str, Any]], label: str) -> "Figure":
    """Detour against realism of each space, median and 90th percentile: left is direct, low is real."""
    figure = empty((6, 4.2))
    ax = figure.subplots()
    for space in measured:
        detour, realism = space["detour"], space["realism"]["log by cell"]
        x, y = (np.array([of["median"], of["90th percentile"]]) for of in (detour, realism))
        ax.plot(x, y, "-", lw=1, alpha=0.5, color="#555")
        ax.plot(x[:1], y[:1], "o", label=f"{space['space']}, {space['blend']}")
    ax.set(
        xscale="log",
        xlabel="detour (median, to the 90th percentile)",
        ylabel="difference from the nearest material",
    )
    ax.legend()
    _caption(figure, f"{label}: {measured[0]['n_pairs']} pairs, mixes at t = 1/2")
    return figure


def write(stem: Location, figure: "Figure") -> None:
    """Write a figure as ``stem.png`` and ``stem.svg``."""
    for suffix in (".png", ".svg"):
        save(stem.with_suffix(suffix), figure)


def save(path: Location, figure: "Figure") -> None:
    """Write a figure as its suffix says: .png, .svg, .pdf, .webp; without one as .png."""
    kind = path.suffix.lstrip(".").lower() or "png"
    with replacing(path) as temporary:
        metadata = {"Date": None} if kind == "svg" else None
        figure.savefig(temporary, dpi=160, format=kind, metadata=metadata)


def _caption(figure: "Figure", text: str) -> None:
    figure.suptitle(text, x=0.01, ha="left", fontsize=9, color="#555")
