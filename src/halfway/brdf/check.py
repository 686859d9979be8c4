"""Is a BRDF physically sound? The validity card; `repair` mends what is not.

The laws, and how each is measured:

    finite         no sample is infinite
    non-negative   no value is below 0
    reciprocal     f_r(wi, wo) = f_r(wo, wi), up to `RECIPROCITY_TOLERANCE` of the mean value
    passive        no direction's albedo is above 1, up to `ALBEDO_TOLERANCE`, the error of its integral
    whole          what is unmeasured is below the horizon, in all channels alike, up to `MASK_TOLERANCE` of the cells; or nothing
                   is. A table that breaks this has holes, or is on another grid than it says (see `layout`)

The first four survive mixing: a mix of sound materials is sound. So does the last, where all have the same holes.
"""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from .._types import Directions, Mask, Table, Values
from ..colour import LUMINANCE
from ..halfdiff import Grid, from_half_diff
from .albedo_operator import albedos
from .brdf import Brdf
from .gloss import Profile
from .layout import MASK_TOLERANCE, horizon, layout_of
from .quadrature import spread_angles
from .table import TabularBrdf, tabulate

RECIPROCITY_TOLERANCE = 0.01
ALBEDO_TOLERANCE = 0.005

STEEP_DEGREES = np.arange(0.0, 81, 5)
GRAZING_DEGREES = np.array([82.5, 85.0, 87.5, 89.0])

_MIRROR = np.array([1.0, -1.0, 1.0])
_N_PAIRS = 4096
_GOLDEN_ANGLE = np.pi * (3 - np.sqrt(5))
_STRIDE = 7  # of the cells whose median is taken; no divisor of an axis of the MERL grid
_LEAST_CONTRAST = 1.1  # of a highlight to the floor around it


@dataclass(frozen=True)
class ValidityCard:
    """What can be said of a BRDF without knowing the material."""

    name: str
    n_infinite: int
    """Samples that are infinite."""
    minimum: float
    """Of the measured samples, in 1/sr; NaN where there is none."""
    unmeasured: float
    """Share of the grid's cells."""
    n_holes: int
    """Unmeasured cells with both directions above the horizon."""
    n_below_horizon: int
    """Measured cells with a direction below the horizon."""
    reciprocity_error: float
    """Mean of |f_r(wi, wo) - f_r(wo, wi)| over the mean of f_r, both times cos_i cos_o."""
    bilateral_error: float
    """The same for a pair and its mirror image. No law: a brushed or woven material may tell them apart."""
    anisotropy: float
    """How much the values vary as the surface turns about its normal (`Brdf.anisotropy`); 0 if isotropic."""
    max_albedo: float
    """Largest of the channels and azimuths, for light from 0 to 80 degrees."""
    max_albedo_degrees: float
    max_albedo_grazing: float
    """The same from 80 to 90 degrees, where measurements are least certain."""
    highlight_degrees: float | None
    """theta_h of the brightest value near normal incidence, in the mean over azimuths; None without a highlight."""
    highlight_width_degrees: float | None
    """From there to half of the height above the floor."""
    dynamic_range: float
    """Largest over median luminance."""
    mask_error: float
    """Share of the cells that are wholly above the horizon and unmeasured, or wholly below it and measured; 0 where none is
    unmeasured."""
    lies_as: str
    """Of which other grid, or in which other order, its cells are, by what is unmeasured or comes again; empty if of its own."""
    channels: tuple[float, float, float]
    """Share of the cells that are measured in red, green and blue."""
    differing: float
    """Share of the cells that are measured in some channels and not in others."""
    broken: tuple[str, ...] = ()
    """The laws it breaks, each as the end of a sentence with numbers."""
    notes: tuple[str, ...] = ()
    """What breaks no law and is worth knowing, in the same form."""

    @property
    def mask_is_the_grids(self) -> bool:
        """Whether the unmeasured cells are those with a direction below the horizon, and no others."""
        return self.n_holes == self.n_below_horizon == 0

    @property
    def ok(self) -> bool:
        """Whether no law is broken."""
        return not self.broken

    @property
    def summary(self) -> str:
        """One line: the laws it breaks, or what is worth knowing of a sound one."""
        if self.broken:
            return "; ".join(self.broken)
        width = self.highlight_width_degrees
        peak = "" if width is None else f", highlight {width:.2g} degrees wide"
        turns = f", anisotropic by {self.anisotropy:.0%}" if self.anisotropy else ""
        return (
            f"reflects at most {self.max_albedo:.3f} (grazing {self.max_albedo_grazing:.3f}), "
            f"{self.unmeasured:.1%} unmeasured, dynamic range {self.dynamic_range:.3g}{peak}{turns}"
            + "".join(f"; {note}" for note in self.notes)
        )

    def as_json(self) -> dict[str, Any]:
        """The card for a program to read; what is infinite or not a number becomes None."""
        card = {
            name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in asdict(self).items()
        }
        lists = {"channels": self.channels, "broken": self.broken, "notes": self.notes}
        more = {key: list(value) for key, value in lists.items()}
        return {"ok": self.ok, **card, **more, "mask_is_the_grids": self.mask_is_the_grids}


def check(brdf: Brdf, *, grid: Grid | None = None) -> ValidityCard:
    """The validity card of a BRDF; one that is no table is looked at on ``grid`` and at pairs in between.

    By default that is the MERL grid, or `Grid.anisotropic` for what depends on phi_h.
    """
    table = brdf if isinstance(brdf, TabularBrdf) else tabulate(brdf, grid or brdf.own_grid)
    by_channel = ~np.isnan(table.values)
    measured = np.asarray(by_channel.all(axis=0))
    mask = table.grid.mask()
    wi, wo = _pairs(brdf)
    with np.errstate(invalid="ignore", over="ignore"):
        # What is exchanged between two directions, so that grazing pairs count for what they carry.
        exchanged = wi[:, 2:] * wo[:, 2:]
        at_pairs, swapped, mirrored = (
            brdf.eval(*pair) * exchanged
            for pair in ((wi, wo), (wo, wi), (wi * _MIRROR, wo * _MIRROR))
        )
        albedo = albedos(table, np.radians([*STEEP_DEGREES, *GRAZING_DEGREES])).max(axis=1)
    steep, grazing = np.split(albedo, [len(STEEP_DEGREES)])
    worst = int(steep.argmax())
    peak, width = _highlight(brdf)
    card = ValidityCard(
        name=str(getattr(brdf, "name", "")),
        n_infinite=int(np.isinf(table.values).sum()),
        minimum=_least(table.values, at_pairs / exchanged),
        unmeasured=float(1 - measured.mean()),
        n_holes=int((mask & ~measured).sum()),
        n_below_horizon=int((measured & ~mask).sum()),
        reciprocity_error=_relative_difference(swapped, at_pairs),
        bilateral_error=_relative_difference(mirrored, at_pairs),
        anisotropy=brdf.anisotropy(),
        max_albedo=float(steep[worst]),
        max_albedo_degrees=float(STEEP_DEGREES[worst]),
        max_albedo_grazing=float(grazing.max()),
        highlight_degrees=peak,
        highlight_width_degrees=width,
        dynamic_range=_dynamic_range(table.values),
        mask_error=_mask_error(measured, table.grid),
        lies_as=_other_layout(table),
        channels=tuple(by_channel.reshape(3, -1).mean(axis=1).tolist()),
        differing=float((by_channel.any(axis=0) & ~measured).mean()),
    )
    return replace(card, broken=tuple(_broken(card)), notes=tuple(_notes(card)))


def _mask_error(measured: Mask, grid: Grid) -> float:
    if measured.all():
        return 0.0
    above, below = horizon(grid)
    return float(((above & ~measured) | (below & measured)).mean())


def _other_layout(table: TabularBrdf) -> str:
    layout = layout_of(table.values, table.grid)
    return "" if layout.is_plain and layout.grid == table.grid else str(layout)


def _broken(card: ValidityCard) -> Iterator[str]:
    if math.isnan(card.minimum):
        yield "nothing is measured"
        return
    if card.n_infinite:
        yield f"{card.n_infinite:,} samples are infinite"
    if card.differing > MASK_TOLERANCE:
        yield _differing(card)
    if card.mask_error > MASK_TOLERANCE:
        yield " and ".join(_misplaced(card))
    if card.lies_as:
        yield f"its cells are those of another grid: {card.lies_as}"
    if card.minimum < 0:
        yield f"goes down to {card.minimum:.3g} /sr"
    if card.reciprocity_error > RECIPROCITY_TOLERANCE:
        yield f"changes by {card.reciprocity_error:.1%} of its mean when light and viewer are swapped"
    if card.n_infinite:
        return  # and so is every integral
    if card.max_albedo > 1 + ALBEDO_TOLERANCE:
        yield f"reflects {card.max_albedo:.3g} times the light from {card.max_albedo_degrees:.0f} degrees"
    if card.max_albedo_grazing > 1 + ALBEDO_TOLERANCE:
        yield f"reflects {card.max_albedo_grazing:.3g} times the light from above 80 degrees"


def _notes(card: ValidityCard) -> Iterator[str]:
    if math.isnan(card.minimum):
        return
    if 0 < card.differing <= MASK_TOLERANCE:
        yield _differing(card)
    if card.mask_error <= MASK_TOLERANCE:
        yield from _misplaced(card)


def _differing(card: ValidityCard) -> str:
    red, green, blue = (f"{share:.1%}" for share in card.channels)
    return (
        f"{100 * card.differing:.2g}% of the cells are measured in some channels only "
        f"(red {red}, green {green}, blue {blue})"
    )


def _misplaced(card: ValidityCard) -> Iterator[str]:
    if card.n_holes:
        yield f"{card.n_holes:,} cells above the horizon are unmeasured"
    if card.n_below_horizon:
        yield f"{card.n_below_horizon:,} cells below the horizon are measured"


def _pairs(brdf: Brdf) -> tuple[Directions, Directions]:
    """Pairs above the horizon, at all azimuths if that matters."""
    angles = spread_angles(_N_PAIRS)
    if not brdf.is_isotropic:
        angles = angles._replace(phi_h=np.arange(_N_PAIRS) * _GOLDEN_ANGLE)
    wi, wo = from_half_diff(angles)
    lit = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    return wi[lit], wo[lit]


def _relative_difference(a: Values, b: Values) -> float:
    known = np.isfinite(a) & np.isfinite(b)
    scale = np.abs(b[known]).sum()
    return float(np.abs(a[known] - b[known]).sum() / scale) if scale > 0 else 0.0


def _least(*samples: np.ndarray) -> float:
    """The smallest that is a number; NaN without one."""
    return float(np.fmin(*(np.fmin.reduce(values, axis=None) for values in samples)))


def _highlight(brdf: Brdf) -> tuple[float | None, float | None]:
    """theta_h in degrees of the brightest value near normal incidence, and on to half its height; None without one."""
    profile = Profile.of(brdf)
    heights = profile.luminance
    if not heights.size or heights.max() <= _LEAST_CONTRAST * max(heights.min(), 0):
        return None, None
    width = profile.half_width()
    peak = float(np.degrees(profile.theta_h[heights.argmax()]))
    return peak, None if width is None else float(np.degrees(width))


def _dynamic_range(values: Table) -> float:
    """Largest over median luminance of the finite samples; 1 where all is black."""
    with np.errstate(invalid="ignore"):
        luminance = LUMINANCE.astype(np.float32) @ values.reshape(3, -1)
    some = luminance[::_STRIDE]
    median = float(np.median(some[np.isfinite(some)])) if np.isfinite(some).any() else 0.0
    return (
        float(np.max(luminance, where=np.isfinite(luminance), initial=0)) / median
        if median > 0
        else 1.0
    )
