"""Measurements as JSON: the universal BRDF data format of the European metrology institutes, version 1.0.

    {"metadata": {...}, "data": {"theta_i": {"unit": "deg", "values": [...]}, ..., "BRDF": {"unit": "1/sr", "values": [...]}}}

One number per point in each of ``theta_i``, ``phi_i``, ``theta_r``, ``phi_r`` and ``BRDF``; a spectrum has ``wavelength_i`` too. ``uBRDF``, the uncertainty,
gives weights: the inverse square of the relative one. ``polarization_i`` and ``polarization_r`` may say that light was unpolarised.

BiRD project (EMPIR 16NRM08), https://github.com/BiRD-project/BiRD_view, BRDF_JSON_schema.
"""

import json
from typing import Any

import numpy as np

from ..errors import FormatError, shown
from .sheet import GREY, Column, Sheet

_UNITS = {
    "deg": np.pi / 180,
    "°": np.pi / 180,
    "rad": 1.0,
    "1/sr": 1.0,
    "sr^-1": 1.0,
    "nm": 1.0,
    "μm": 1e3,
}
_COLUMNS = {
    "theta_i": ("theta_i", ("deg", "°", "rad")),
    "phi_i": ("phi_i", ("deg", "°", "rad")),
    "theta_r": ("theta_o", ("deg", "°", "rad")),
    "phi_r": ("phi_o", ("deg", "°", "rad")),
    "BRDF": (GREY, ("1/sr", "sr^-1")),
}
_WAVELENGTH = {"wavelength_i": ("wavelength", ("nm", "μm"))}
_UNPOLARISED: tuple[Any, ...] = ("u", "unpolarized", "unpolarised", [1, 0, 0, 0])


def read_brdf_json(text: str, label: str) -> Sheet:
    """The numbers of a BRDF JSON file; a `FormatError` where something is missing, in another unit or length, or light was polarised."""
    try:
        data = json.loads(text)["data"]
        n = len(data["BRDF"]["values"])
    except json.JSONDecodeError as error:
        raise FormatError(
            f"{label} is damaged at line {error.lineno}, column {error.colno} ({error.msg}): expected JSON. Compare it with the original."
        ) from None
    except (KeyError, TypeError):
        raise FormatError(
            f'{label} has no measurements: expected {{"data": {{"BRDF": {{"values": [...]}}}}}}.'
        ) from None
    for key in ("polarization_i", "polarization_r"):
        _require_unpolarised(data.get(key), key, label)
    names = _COLUMNS | (_WAVELENGTH if "wavelength_i" in data else {})
    columns = {name: _column(data, key, units, n, label) for key, (name, units) in names.items()}
    if "uBRDF" in data:
        columns["weight"] = _weights(data, columns[GREY], label)
    keys = {name: key for key, (name, _) in names.items()} | {"weight": "uBRDF"}
    return Sheet(label, columns, {}, lambda i, name: f"data.{keys[name]}.values[{i}]")


def _column(data: Any, key: str, units: tuple[str, ...], n: int, label: str) -> Column:
    variable = data.get(key) or {}
    unit, values = variable.get("unit"), variable.get("values", [])
    if unit not in units:
        raise FormatError(f"{label} has data.{key}.unit {unit!r}: expected {' or '.join(units)}.")
    try:
        numbers = np.array(values, np.float64)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.shape != (n,):
        raise FormatError(
            f"{label} has {len(values)} data.{key}.values: expected {n} numbers, one for each of the BRDF."
        )
    return numbers * _UNITS.get(unit, 1.0)


def _weights(data: Any, values: Column, label: str) -> Column:
    uncertainty = _column(data, "uBRDF", ("1/sr", "sr^-1", "%"), len(values), label)
    relative = (
        uncertainty / 100
        if data["uBRDF"]["unit"] == "%"
        else uncertainty / np.maximum(values, 1e-9)
    )
    with np.errstate(divide="ignore"):
        return relative**-2.0


def _require_unpolarised(variable: Any, key: str, label: str) -> None:
    states = (variable or {}).get("values", [])
    polarised = [i for i, state in enumerate(states) if state not in _UNPOLARISED]
    if polarised:
        i, different = polarised[0], len({str(state) for state in states})
        said = f"{different} states of polarisation" if different > 1 else "polarised light"
        raise FormatError(
            f"{label} has {said}, {shown(str(states[i]))} at data.{key}.values[{i}]: expected unpolarised light. "
            "Average the states at each pair of directions first."
        )
