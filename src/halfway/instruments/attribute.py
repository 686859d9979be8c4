"""Attributes: the numbers that people use of a material, as functions of its readings.

Each attribute v comes with the linear inequality that says on which side of a target t it is,

    v(f) <= t    where    c(t) . r(f) <= d(t)         v(f) = t    where    c(t) . r(f) = d(t)

in the readings r of f: what a linear programme takes, and as true of a ratio N/D <= t, which is N - t D <= 0, as of a sum.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Float64

from ..colour import LUMINANCE, from_hex, from_response, response, to_hex, to_relative_xyz
from ..errors import ControlError
from .functionals import INSTRUMENTS, PROFILE, PROFILE_NAMES

Coefficients = Float64[np.ndarray, "n_instruments 3"]
Reading = Float64[np.ndarray, "*k n_instruments 3"]
"""By instrument, in the order of `INSTRUMENTS`, and channel; NaN where none of its cells is measured."""
Numbers = Float64[np.ndarray | np.floating, "*k"]
"""One of each material."""
_POSITIONS = {name: i for i, name in enumerate(INSTRUMENTS)}


class Condition(NamedTuple):
    """``coefficients . readings <= constant``, or with the equals sign."""

    coefficients: Coefficients
    constant: float


@dataclass(frozen=True, kw_only=True)
class Attribute(ABC):
    """A number that people use of a material."""

    name: str
    label: str
    unit: str = ""
    formula: str
    source: str
    least: float = 0.0
    most: float = np.inf
    """Values that make sense are from ``least`` to ``most``."""
    close: float = 0.1
    """How near to a target is near enough, where it is sought by steps."""
    group: Literal["reflections", "colour"] = "reflections"
    """What it says of a material."""
    needs: str = ""
    """Another attribute that has to be given for this one to be linear."""

    @property
    def is_number(self) -> bool:
        """Whether it is one number, which may be more or less than another."""
        return True

    @property
    @abstractmethod
    def instruments(self) -> tuple[str, ...]:
        """Those whose readings it is a function of."""

    @abstractmethod
    def of(self, readings: Reading) -> Numbers:
        """The values, one of each material; NaN where there is none."""

    @abstractmethod
    def conditions(self, target: Any, given: Mapping[str, Any]) -> list[Condition]:
        """When the value is at most ``target``, where the attributes ``given`` have these values."""

    def parsed(self, target: Any) -> Any:
        """A target as a person writes it.

        Raises
        ------
        ControlError
            When it is no value of the attribute.
        """
        try:
            number = float(target)
        except (TypeError, ValueError):
            number = np.nan
        if not self.least <= number <= self.most or np.isinf(number):
            limits = (
                f"{self.least:g} to {self.most:g}"
                if np.isfinite(self.most)
                else f"{self.least:g} or more"
            )
            raise ControlError(f"{self.name} cannot be {target!r}: expected a number, {limits}.")
        return number

    def written(self, value: Any) -> str:
        """A value for people."""
        return "none" if np.isnan(value) else f"{value:.4g}"

    def to_json(self, value: Any) -> float | str | None:
        """A value for programs; None where there is none."""
        return None if np.isnan(value) else float(value)


@dataclass(frozen=True, kw_only=True)
class Sum(Attribute):
    """The luminance of one instrument's reading."""

    instrument: str

    @property
    def instruments(self) -> tuple[str, ...]:
        return (self.instrument,)

    def of(self, readings: Reading) -> Numbers:
        return _luminance(readings, self.instrument)

    def conditions(self, target: float, given: Mapping[str, Any]) -> list[Condition]:  # noqa: ARG002
        return [Condition(luminance_of({self.instrument: 1.0}), target)]


@dataclass(frozen=True, kw_only=True)
class Ratio(Attribute):
    """One sum of luminances over another, which is positive."""

    over: Mapping[str, float]
    under: Mapping[str, float]

    @property
    def instruments(self) -> tuple[str, ...]:
        return (*self.over, *self.under)

    def of(self, readings: Reading) -> Numbers:
        over, under = (
            sum(weight * _luminance(readings, name) for name, weight in each.items())
            for each in (self.over, self.under)
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(under > 0, over / under, np.nan)

    def conditions(self, target: float, given: Mapping[str, Any]) -> list[Condition]:  # noqa: ARG002
        return [Condition(luminance_of(self.over) - target * luminance_of(self.under), 0.0)]


@dataclass(frozen=True, kw_only=True)
class Lab(Attribute):
    """A coordinate of CIELAB, 0 to 2, of the colour at 45:0. Once L* is given, a* says what X is and b* what Z is."""

    coordinate: int

    @property
    def instruments(self) -> tuple[str, ...]:
        return ("colour",)

    def of(self, readings: Reading) -> Numbers:
        x, y, z = np.moveaxis(
            response(to_relative_xyz(readings[..., _POSITIONS["colour"], :])), -1, 0
        )
        return (116 * y - 16, 500 * (x - y), 200 * (y - z))[self.coordinate]

    def conditions(self, target: float, given: Mapping[str, Any]) -> list[Condition]:
        y = (float(given.get(self.needs, target)) + 16) / 116
        # b* falls where Z grows.
        sign = -1 if self.coordinate == 2 else 1
        f = (y, target / 500 + y, y - target / 200)[self.coordinate]
        xyz = to_relative_xyz(np.eye(3)).T
        row = xyz[(1, 0, 2)[self.coordinate]]
        constant = from_response(np.array(f)).item()
        return [Condition(sign * _only("colour", row), sign * constant)]


@dataclass(frozen=True, kw_only=True)
class Width(Attribute):
    """Degrees from the normal within which half of the highlight is: half of the energy that exceeds what is at 30 degrees.

        E(t) = int from 0 to t of (f - f(30)) sin(theta_h) cos(theta_h) dtheta_h        E(width) = E(30) / 2

    by the trapezium rule on the profile; E is linear between its nodes. Of the distribution of Trowbridge and Reitz (GGX)
    with roughness alpha the width is atan(alpha).
    """

    @property
    def instruments(self) -> tuple[str, ...]:
        return PROFILE_NAMES

    def of(self, readings: Reading) -> Numbers:
        profile = readings[..., [_POSITIONS[name] for name in PROFILE_NAMES], :]
        energy = np.einsum("ji,...ic,c->...j", _ENERGY, profile, LUMINANCE)
        half = energy[..., -1] / 2
        j = np.maximum((energy >= half[..., None]).argmax(axis=-1), 1)
        before, after = (
            np.take_along_axis(energy, i[..., None], axis=-1)[..., 0] for i in (j - 1, j)
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (half - before) / (after - before)
        angle = PROFILE[j - 1] + share * (PROFILE[j] - PROFILE[j - 1])
        return np.where(half > 0, np.degrees(angle), np.nan)

    def conditions(self, target: float, given: Mapping[str, Any]) -> list[Condition]:  # noqa: ARG002
        j = int(np.clip(np.searchsorted(PROFILE, np.radians(target)), 1, len(PROFILE) - 1))
        share = (np.radians(target) - PROFILE[j - 1]) / (PROFILE[j] - PROFILE[j - 1])
        within = (1 - share) * _ENERGY[j - 1] + share * _ENERGY[j]
        halves = zip(PROFILE_NAMES, _ENERGY[-1] / 2 - within, strict=True)
        return [Condition(luminance_of(dict(halves)), 0.0)]


def _energy() -> Float64[np.ndarray, "n_profile n_profile"]:
    """E at each node of the profile, in terms of the profile."""
    measure = np.sin(PROFILE) * np.cos(PROFILE)
    halves = np.diff(PROFILE)[:, None] / 2
    steps = halves * (np.eye(len(PROFILE))[1:] + np.eye(len(PROFILE))[:-1]) * measure
    energy = np.zeros((len(PROFILE), len(PROFILE)))
    energy[1:] = steps.cumsum(axis=0)
    energy[:, -1] -= energy.sum(axis=1)
    return energy


_ENERGY = _energy()


@dataclass(frozen=True, kw_only=True)
class BodyColour(Attribute):
    """The colour beside the highlight, in linear sRGB; three conditions, one of each channel."""

    @property
    def is_number(self) -> bool:
        return False

    @property
    def instruments(self) -> tuple[str, ...]:
        return ("body",)

    def of(self, readings: Reading) -> Float64[np.ndarray, "*k 3"]:
        return readings[..., _POSITIONS["body"], :]

    def conditions(
        self,
        target: Float[np.ndarray, " 3"],
        given: Mapping[str, Any],  # noqa: ARG002
    ) -> list[Condition]:
        return [
            Condition(_only("body", row), float(t))
            for row, t in zip(np.eye(3), target, strict=True)
        ]

    def parsed(self, target: Any) -> Float64[np.ndarray, " 3"]:
        colour = from_hex(target) if isinstance(target, str) else np.asarray(target, np.float64)
        if colour is None or colour.shape != (3,) or not ((colour >= 0) & (colour <= 1)).all():
            raise ControlError(
                f"{self.name} cannot be {target!r}: expected a colour such as #7a2a3a, or three linear values from 0 to 1."
            )
        return colour

    def written(self, value: Any) -> str:
        return to_hex(value) if np.isfinite(value).all() else "none"

    def to_json(self, value: Any) -> str | None:
        return to_hex(value) if np.isfinite(value).all() else None


def luminance_of(instruments: Mapping[str, float]) -> Coefficients:
    """The coefficients of a sum of luminances."""
    return np.sum([_only(name, weight * LUMINANCE) for name, weight in instruments.items()], axis=0)


def _only(instrument: str, row: Float64[np.ndarray, " 3"]) -> Coefficients:
    coefficients = np.zeros((len(INSTRUMENTS), 3))
    coefficients[_POSITIONS[instrument]] = row
    return coefficients


def _luminance(readings: Reading, instrument: str) -> Numbers:
    return readings[..., _POSITIONS[instrument], :] @ LUMINANCE
