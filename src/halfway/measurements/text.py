"""Measurements as text: CSV with named columns, and ASTM E1392.

CSV. The first line that does not begin with ``#`` names the columns, each with its unit in brackets; they are separated by commas, semicolons or tabs:

    theta_i [deg], phi_i [deg], theta_o [deg], phi_o [deg], r [1/sr], g [1/sr], b [1/sr], weight

    theta, phi     from the normal, and about it from the tangent; deg or rad. phi_i may be left out: 0. A negative theta is the other side of the normal
    values         as `sheet` has them; 1/sr, or factor, which is pi times that
    wavelength     nm
    weight         no unit; may be left out

ASTM E1392 (and E2387, which followed it). Lines of KEYWORD and text; after ``VARS`` and the names of the columns come the rows, separated by commas. The
first four columns are the angles of both directions in radians, the others values in 1/sr: R, G, B, one, or wavelengths such as ``550nm``.

"Standard Practice for Angle Resolved Optical Scatter Measurements on Specular or Diffuse Surfaces", ASTM E1392-96.
"""

import csv
import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..errors import FormatError, shown
from .sheet import ANGLES, GREY, RGB, Sheet

_HEADER = re.compile(r"(?P<name>[^\[(]+?)\s*(?:[\[(]\s*(?P<unit>[^\])]*?)\s*[\])])?\s*$")
_WAVELENGTH = re.compile(r"(\d+(?:\.\d+)?)\s*nm", re.IGNORECASE)
_NAMES = {
    "theta_r": "theta_o",
    "phi_r": "phi_o",
    "red": "r",
    "green": "g",
    "blue": "b",
    "brdf": GREY,
}
_ANGLE_UNITS = {
    "deg": np.pi / 180,
    "degrees": np.pi / 180,
    "°": np.pi / 180,
    "rad": 1.0,
    "radians": 1.0,
}
_VALUE_UNITS = {"1/sr": 1.0, "sr^-1": 1.0, "factor": 1 / np.pi}
_OTHER_UNITS = {"wavelength": {"nm": 1.0}, "weight": {"": 1.0}}
_SHOWN = 40
"""Letters of a cell that a message shows."""


class _Line(NamedTuple):
    number: int
    cells: list[str]


class _Header(NamedTuple):
    name: str
    scale: float
    wavelength: float | None = None


def read_csv(text: str, label: str) -> Sheet:
    """The numbers of a CSV file.

    Raises
    ------
    FormatError
        When a column or a unit is missing or unknown, or a cell holds no number; the message says which line and column.
    """
    lines = list(_lines(text, 0))
    if len(lines) < 2:
        raise FormatError(
            f"{label} has no measurements: expected a line of column names, and one of numbers or more."
        )
    headers = [_header(cell, label, lines[0].number) for cell in lines[0].cells]
    return _sheet(headers, lines[1:], label)


def read_astm(text: str, label: str) -> Sheet:
    """The numbers of an ASTM E1392 file.

    Raises
    ------
    FormatError
        As `read_csv`.
    """
    before, _, after = re.split(r"(?m)^(VARS)\b", text, maxsplit=1)
    n_before = before.count("\n")
    names, *rows = list(_lines(after, n_before)) or [_Line(n_before + 1, [])]
    wavelengths = [_WAVELENGTH.fullmatch(cell) for cell in names.cells[4:]]
    kinds = {1: (GREY,), 3: RGB}.get(len(wavelengths), ())
    values = [_Header(f"{m[1]} nm", 1.0, float(m[1])) for m in wavelengths if m]
    if len(values) != len(wavelengths):
        values = [_Header(kind, 1.0) for kind in kinds]
    if not values or not rows:
        raise FormatError(
            f"{label} line {names.number} names {len(names.cells)} columns, and {len(rows)} rows follow: expected four angles, then "
            "R, G, B, one value or wavelengths, and one row or more."
        )
    headers = [*(_Header(angle, 1.0) for angle in ANGLES), *values]
    return _sheet(headers, rows, label)


def _lines(text: str, n_before: int) -> Iterator[_Line]:
    """The lines that hold something, from 1 on, as cells."""
    delimiter = ""
    for number, line in enumerate(text.splitlines(), 1 + n_before):
        if line.strip() and not line.lstrip().startswith("#"):
            delimiter = delimiter or next((d for d in "\t;" if d in line), ",")
            row = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True))
            yield _Line(number, [cell.strip() for cell in row])


def _header(cell: str, label: str, line: int) -> _Header:
    """The column that a cell of the first line names."""
    match = _HEADER.match(cell)
    name, unit = (match["name"].lower(), (match["unit"] or "").lower()) if match else (cell, "")
    name = _NAMES.get(name, name)
    wavelength = _WAVELENGTH.fullmatch(name)
    if name in ANGLES:
        units = _ANGLE_UNITS
    elif name in (*RGB, GREY) or wavelength:
        units = _VALUE_UNITS
    elif name in _OTHER_UNITS:
        units = _OTHER_UNITS[name]
    else:
        raise FormatError(
            f"{label} line {line} names a column {shown(cell)[:_SHOWN]!r}: expected {', '.join(ANGLES)}, r, g, b, f_r, 550 nm, wavelength "
            "or weight, each with its unit, such as theta_i [deg]."
        )
    if unit not in units:
        said = f"in {unit!r}" if unit else "without a unit"
        raise FormatError(
            f"{label} line {line} names the column {name} {said}: expected {' or '.join(u or 'none' for u in units)}, such as "
            f"{name} [{next(iter(units))}]."
        )
    return _Header(name, units[unit], float(wavelength[1]) if wavelength else None)


def _sheet(headers: list[_Header], lines: list[_Line], label: str) -> Sheet:
    names = [header.name for header in headers]
    _complete(names, label)
    for line in lines:
        if len(line.cells) != len(headers):
            raise FormatError(
                f"{label} line {line.number} has {len(line.cells)} cells: expected {len(headers)}, as the columns are named."
            )
    cells = ([line.cells[i] for line in lines] for i in range(len(headers)))
    columns = {
        header.name: header.scale
        * np.array(
            [
                _number(cell, label, line, header.name)
                for cell, line in zip(column, lines, strict=True)
            ]
        )
        for header, column in zip(headers, cells, strict=True)
    }
    columns.setdefault("phi_i", np.zeros(len(lines)))
    spectrum = {
        header.wavelength: header.name for header in headers if header.wavelength is not None
    }
    return Sheet(label, columns, spectrum, lambda i, name: f"line {lines[i].number}, column {name}")


def _complete(names: list[str], label: str) -> None:
    """No column twice, and no angle missing but phi_i."""
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise FormatError(f"{label} names the column {twice[0]} twice: expected each once.")
    missing = [angle for angle in ANGLES if angle not in names and angle != "phi_i"]
    if missing:
        raise FormatError(
            f"{label} has no column {missing[0]}: expected {', '.join(ANGLES)} with their units."
        )


def _number(cell: str, label: str, line: _Line, name: str) -> float:
    try:
        return float(cell)
    except ValueError:
        raise FormatError(
            f"{label} has {shown(cell)[:_SHOWN]!r} at line {line.number}, column {name}: expected a number such as 0.25."
        ) from None
