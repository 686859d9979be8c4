"""Plots of results: a score over how many numbers or samples it took."""

import base64
import io
from collections.abc import Sequence
from typing import Any

from ..export import figures
from .results import Result
from .scores import MEASURES

MARKS = "osD^vP*X<>h"


def curves(results: Sequence[Result], measures: Sequence[str], setting: str) -> str:
    """The figure as an address that holds it."""
    import matplotlib as mpl

    with mpl.rc_context({"svg.fonttype": "none"}):
        file = io.BytesIO()
        figure(results, measures, setting).savefig(file, format="svg", metadata={"Date": None})
    return "data:image/svg+xml;base64," + base64.b64encode(file.getvalue()).decode()


@figures.styled
def figure(results: Sequence[Result], measures: Sequence[str], setting: str) -> Any:
    """One plot for each measure, a line for each method (a matplotlib figure)."""
    figure = figures.empty((10, 4.6))
    axes = figure.subplots(1, len(measures), squeeze=False)[0]
    for ax, measure in zip(axes, measures, strict=True):
        _draw(ax, results, measure)
        ax.set(xlabel=setting, title=MEASURES[measure].label.partition(",")[0])
        _scale(ax, sorted(_shared(results)), logarithmic=not MEASURES[measure].larger_is_better)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9)
    return figure


def _scale(ax: Any, settings: Sequence[int], *, logarithmic: bool) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    ax.set_xscale("log")
    ax.set_xticks(settings, [str(x) for x in settings], fontsize=8)
    ax.minorticks_off()
    if logarithmic:
        ax.set_yscale("log")
        ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        ax.yaxis.set_minor_formatter(NullFormatter())


def _shared(results: Sequence[Result]) -> set[int]:
    """The settings that every method was asked for, where it has a choice."""
    each = [r.method for r in results]
    return {r.setting for r in results if each.count(r.method) > 1} or {r.setting for r in results}


def _draw(ax: Any, results: Sequence[Result], measure: str) -> None:
    from matplotlib import colormaps

    palette = colormaps["tab20"]
    methods = dict.fromkeys(result.method for result in results)
    for mark, (i, method) in zip(MARKS * 3, enumerate(methods), strict=False):
        points = sorted((r for r in results if r.method == method), key=lambda r: r.setting)
        x, y = [r.setting for r in points], [r.scores[measure] for r in points]
        colour = palette(2 * i % 20 + i // 10)  # ten strong ones, then the pale ones of those
        (line,) = ax.plot(x, y, marker=mark, ms=5, lw=1.4, label=method, color=colour)
        drawn = [r for r in points if r.low]
        if drawn:
            low, high = (
                [end[measure] for end in ends]
                for ends in zip(*((r.low, r.high) for r in drawn), strict=True)
            )
            ax.fill_between([r.setting for r in drawn], low, high, color=line.get_color(), alpha=0.15, lw=0)  # fmt: skip
