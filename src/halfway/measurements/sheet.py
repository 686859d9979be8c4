"""What every file of measurements comes to: a sheet of numbers, and where in the file each stands.

A row is a pair of directions, or one at one wavelength. Its values are colours, one grey, or a spectrum:

    r, g, b                     linear RGB
    f_r                         one value for all three channels
    450 nm, 550 nm, 650 nm      a spectrum along the row, as many wavelengths as there are
    wavelength, f_r             a spectrum down the rows that share their directions

Spectra become RGB by the CIE 1931 observer under D65 (`halfway.formats.spectra`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int

from ..errors import FormatError
from ..formats import spectra
from .measurements import Angles, Measurements

Column = Float64[np.ndarray, " n"]
ANGLES = ("theta_i", "phi_i", "theta_o", "phi_o")
RGB = ("r", "g", "b")
GREY = "f_r"
_SAME_DIRECTION = 6
"""Decimals of radians in which directions are told apart."""
_AGREE = 1.1
"""Factor within which values at the same directions may differ."""
_KINDS = "r, g and b, or f_r, or wavelengths such as 550 nm, or wavelength with f_r"


@dataclass(frozen=True)
class Sheet:
    """Numbers by the name of their column; angles in radians, values in 1/sr, wavelengths in nm."""

    label: str
    """The file, as messages call it."""
    columns: Mapping[str, Column]
    spectrum: Mapping[float, str]
    """Names of the columns of a spectrum along the rows, by wavelength."""
    at: Callable[[int, str], str]
    """Where the number of a row and a column stands: "line 5, column r"."""

    def measurements(self, name: str) -> Measurements:
        """The measurements, once all numbers are checked.

        Raises
        ------
        FormatError
            When an angle is below the horizon, a value is negative, two at the same directions disagree, or the columns are no colours.
        """
        for angle in ("theta_i", "theta_o"):
            theta = np.degrees(self.columns[angle])
            self._require(np.abs(theta) < 90, angle, theta, "less than 90 degrees from the normal")
        names = self._values()
        for column in names:
            values = self.columns[column]
            self._require(values >= 0, column, values, "no negative value")
        weights = self.columns.get("weight", np.ones(len(self.columns["theta_i"])))
        self._require(weights > 0, "weight", weights, "more than 0")
        first, of_row = self._directions()
        self._agree(names, of_row)
        angles = Angles(*(self.columns[angle] for angle in ANGLES))
        if "wavelength" in self.columns:
            colours = np.stack([self._colour(of_row == i) for i in range(len(first))])
            wi, wo = Angles(*(self.columns[angle][first] for angle in ANGLES)).directions()
            return Measurements(wi, wo, colours, weights[first], name)
        values = np.stack([self.columns[column] for column in names], axis=1)
        wi, wo = angles.directions()
        return Measurements(wi, wo, self._rgb(values), weights, name)

    def _values(self) -> tuple[str, ...]:
        """The columns of values."""
        missing = [name for name in RGB if name not in self.columns]
        if 0 < len(missing) < len(RGB):
            raise FormatError(
                f"{self.label} has no column {missing[0]}: expected r, g and b, or f_r where there is one value."
            )
        there = [
            names
            for names in (RGB, (GREY,), tuple(self.spectrum.values()))
            if names and all(name in self.columns for name in names)
        ]
        if len(there) != 1:
            raise FormatError(
                f"{self.label} has {'no' if not there else 'more than one'} kind of values: expected {_KINDS}."
            )
        return there[0]

    def _rgb(self, values: Float64[np.ndarray, "n k"]) -> Float64[np.ndarray, "n 3"]:
        if not self.spectrum:
            return np.broadcast_to(values, (len(values), 3)).copy()
        return _colours(np.array(list(self.spectrum)), values)

    def _colour(self, rows: np.ndarray) -> Float64[np.ndarray, " 3"]:
        """Of a spectrum down some rows; at one wavelength all channels are alike."""
        values = self.columns[GREY][rows][None]
        return _colours(self.columns["wavelength"][rows], values)[0]

    def _directions(self) -> tuple[Int[np.ndarray, " n_pairs"], Int[np.ndarray, " n"]]:
        """The first row of each pair of directions, and which pair each row is of."""
        angles = np.stack([self.columns[angle] for angle in ANGLES], axis=1)
        rounded = np.round(angles, _SAME_DIRECTION)
        _, first, of_row = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
        return first, of_row.reshape(-1)

    def _agree(self, names: tuple[str, ...], of_row: Int[np.ndarray, " n"]) -> None:
        """Values at the same directions, and wavelength, are nearly the same."""
        wavelength = self.columns.get("wavelength", np.zeros(len(of_row)))
        for name in names:
            values = self.columns[name]
            order = np.lexsort((values, wavelength, of_row))
            same = (np.diff(of_row[order]) == 0) & (np.diff(wavelength[order]) == 0)
            apart = same & (values[order][1:] > _AGREE * values[order][:-1] + 1e-12)
            if apart.any():
                i = int(np.argmax(apart))
                one, other = sorted(order[i : i + 2].tolist())
                raise FormatError(
                    f"{self.label} has {values[one]:g} at {self.at(one, name)} and {values[other]:g} at "
                    f"{self.at(other, name)}, for the same directions: expected values within 10 %. Remove the wrong one."
                )

    def _require(self, sound: np.ndarray, column: str, values: Column, expected: str) -> None:
        sound = sound & np.isfinite(values)
        if not sound.all():
            i = int(np.argmin(sound))
            raise FormatError(
                f"{self.label} has {values[i]:g} at {self.at(i, column)}: expected {expected}."
            )


def _colours(
    wavelengths: Float64[np.ndarray, " k"], values: Float64[np.ndarray, "n k"]
) -> Float64[np.ndarray, "n 3"]:
    """Linear RGB of spectra; what falls outside the gamut is brought to its edge."""
    unique, of_each = np.unique(wavelengths, return_inverse=True)
    counts = np.bincount(of_each)
    mean = np.stack([np.bincount(of_each, row) / counts for row in values])
    return np.maximum(mean @ spectra.rgb_weights(unique).T, 0)
