"""Pictures of a recovery, where it is sure and where not, and of a plan, as matplotlib figures."""

import io
from typing import TYPE_CHECKING

import numpy as np

from ..brdf import Brdf, TabularBrdf
from ..halfdiff import HalfDiff, from_half_diff, to_half_diff
from ..look import portrait, to_png
from ..measurements import Angles
from ..recovery import Completion, Plan, Recovery
from .figures import COLOURS, empty, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SLICE_DEGREES = (20, 60)
"""Angles of the light in whose plane of incidence values are drawn."""
_IN_PLANE = np.radians(5.0)
"""Measured directions as near as this to a slice are drawn in it."""
_WIDEST = np.log(4)
"""Of the map of uncertainty: from a quarter to four times."""


@styled
def recovered(recovery: Recovery, completion: Completion, mix: TabularBrdf) -> "Figure":
    """Spheres of the completion, the ends of its interval and the mix; two slices; and how sure each direction is."""
    figure = empty((12, 7))
    grid = figure.add_gridspec(2, 3, height_ratios=(1, 1.3))
    _spheres(figure.add_subplot(grid[0, :]), completion, mix)
    for i, degrees in enumerate(SLICE_DEGREES):
        _slice(figure.add_subplot(grid[1, i]), recovery, completion, mix, degrees)
    _map(figure, figure.add_subplot(grid[1, 2]), recovery, completion)
    return figure


@styled
def planned(plan: Plan) -> "Figure":
    """The pairs of directions over the hemisphere, numbered, and how much is unknown after each."""
    figure = empty((9, 4.4))
    _pairs(figure.add_subplot(1, 2, 1, projection="polar"), plan)
    right = figure.add_subplot(1, 2, 2)
    right.plot(np.append(plan.unknown, plan.left), ".-", color="#444")
    right.set(ylim=(0, None), xlabel="pairs measured", ylabel="natural logarithms")
    right.set_title("What is still unknown, root mean square")
    return figure


def _spheres(ax: "Axes", completion: Completion, mix: TabularBrdf) -> None:
    from PIL import Image

    tables = (completion.low, completion.table, completion.high, mix)
    strip = to_png([portrait(np.nan_to_num(each.values), each.grid) for each in tables])
    ax.imshow(np.asarray(Image.open(io.BytesIO(strip))))
    ax.set_axis_off()
    ax.set_title("at the least · completed · at the most · nearest mix", loc="center")


def _slice(
    ax: "Axes", recovery: Recovery, completion: Completion, mix: TabularBrdf, degrees: int
) -> None:
    """Values in the plane of incidence, with the light at some degrees, and what was measured there."""
    theta = np.radians(np.linspace(-85, 85, 341))
    wi, wo = Angles(
        np.full_like(theta, np.radians(degrees)),
        np.zeros_like(theta),
        theta,
        np.full_like(theta, np.pi),
    ).directions()
    values = [each.eval(wi, wo) for each in (*completion, mix)]
    for channel, (name, colour) in enumerate(COLOURS.items()):
        table, low, high, mixed = (np.maximum(v[:, channel], 1e-4) for v in values)
        ax.fill_between(np.degrees(theta), low, high, color=colour, alpha=0.15, lw=0)
        ax.semilogy(np.degrees(theta), table, color=colour, lw=1, label=name)
        ax.semilogy(np.degrees(theta), mixed, ":", color=colour, lw=1)
        at, measured = _near(recovery, np.radians(degrees), channel)
        ax.plot(np.degrees(at), np.maximum(measured, 1e-4), "o", color=colour, ms=4)
    ax.set(xlabel="viewer, degrees from the normal", title=f"Light at {degrees}°")
    ax.set_ylabel("f_r (1/sr); dotted: the mix")


def _near(recovery: Recovery, theta: float, channel: int) -> tuple[np.ndarray, np.ndarray]:
    """Measured pairs near a slice, either way round: the viewer's angle, negative on the light's side, and the value."""
    measured = recovery.measurements
    values = measured.values[:, channel]
    slices = []
    for light, viewer in ((measured.wi, measured.wo), (measured.wo, measured.wi)):
        a = Angles.of(light, viewer)
        turn = np.abs(np.angle(np.exp(1j * (np.asarray(a.phi_o) - np.asarray(a.phi_i)))))
        mirrored, same = np.abs(turn - np.pi) < _IN_PLANE, turn < _IN_PLANE
        steep = np.minimum(a.theta_i, a.theta_o) < _IN_PLANE / 2
        near = (np.abs(a.theta_i - theta) < _IN_PLANE) & (mirrored | same | steep)
        signed = np.where(same, -1, 1) * a.theta_o
        slices.append(np.stack([signed[near], values[near]]))
    at, value = np.concatenate(slices, axis=1)
    return at, value


def _map(figure: "Figure", ax: "Axes", recovery: Recovery, completion: Completion) -> None:
    """Half the interval, as a factor, over theta_h and theta_d; the pairs that were measured."""
    theta_h, theta_d = np.meshgrid(
        *np.radians([np.linspace(0, 85, 86) ** 2 / 85, np.linspace(0, 85, 86)])
    )
    right = np.full_like(theta_h, np.pi / 2)
    wi, wo = from_half_diff(HalfDiff(theta_h, np.zeros_like(theta_h), theta_d, right))
    low, high = (_lightness(each, wi, wo) for each in (completion.low, completion.high))
    shown = ax.pcolormesh(
        np.degrees(theta_h),
        np.degrees(theta_d),
        (high - low) / 2,
        vmin=0,
        vmax=_WIDEST,
        cmap="viridis",
    )
    bar = figure.colorbar(shown, ax=ax, ticks=np.log([1, 1.25, 1.5, 2, 3, 4]))
    bar.ax.set_yticklabels(["1", "1.25", "1.5", "2", "3", "4"])
    bar.set_label("give or take this factor")
    at = to_half_diff(recovery.measurements.wi, recovery.measurements.wo)
    ax.plot(np.degrees(at.theta_h), np.degrees(at.theta_d), "o", mfc="none", mec="#e33")
    ax.set(
        xlabel="theta_h (degrees)", ylabel="theta_d (degrees)", title="How sure; circles: measured"
    )


def _lightness(brdf: Brdf, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """Mean over channels of the logarithm; NaN below the horizon."""
    values = brdf.eval(wi, wo)
    lit = np.minimum(wi[..., 2], wo[..., 2]) > 0
    dark = 1e-3 / np.maximum(wi[..., 2] * wo[..., 2], 1e-3)
    return np.where(lit, np.log(values + dark[..., None]).mean(axis=-1), np.nan)


def _pairs(ax: "Axes", plan: Plan) -> None:
    angles = np.stack(Angles.of(plan.wi, plan.wo), axis=1)
    for i, (theta_i, phi_i, theta_o, phi_o) in enumerate(angles, 1):
        turned = phi_o - phi_i
        ax.plot([0, turned], np.degrees([theta_i, theta_o]), color="#bbb", lw=0.7)
        ax.plot(0, np.degrees(theta_i), "o", color="#d5962a", ms=5)
        ax.plot(turned, np.degrees(theta_o), "o", color="#2f6dc8", ms=5)
        ax.annotate(
            str(i), (turned, np.degrees(theta_o)), xytext=(3, 3), textcoords="offset points"
        )
    ax.set(rlim=(0, 90), rticks=[30, 60, 90])
    ax.set_title("Light (gold, turned to 0°) and viewer (blue)")
