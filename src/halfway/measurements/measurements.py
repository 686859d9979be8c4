"""Measurements: what an instrument gave of one material, direction by direction. No table yet.

    wi, wo     unit vectors to the light and to the viewer: normal +z, tangent +x
    values     f_r in 1/sr, without the cosine, linear RGB
    weights    how much each counts beside the others

`read_measurements` tells the kind of a file by its content: CSV or ASTM E1392 (`text`), the metrology institutes' JSON (`brdf_json`).
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Angle, Directions, Values
from ..errors import FormatError
from ..halfdiff import from_polar, to_polar

_LENGTH_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False)
class Measurements:
    """Values of one material at n pairs of directions.

    Parameters
    ----------
    wi, wo : float array, shape (n, 3)
        Above the horizon; scaled to unit length.
    values : float array, shape (n, 3)
        f_r in 1/sr, linear RGB; finite and not negative.
    weights : float array, shape (n,)
        Positive. Without them all count alike.
    name : str
        What the material is called.

    Raises
    ------
    FormatError
        When they are none, or are not as above; the message says which, counted from 1.

    Examples
    --------
    >>> import numpy as np
    >>> from halfway import Measurements
    >>> up = np.array([[0.0, 0.0, 1.0]])
    >>> Measurements(up, up, np.full((1, 3), 0.2))
    Measurements('', 1 pairs of directions)
    """

    wi: Directions
    wo: Directions
    values: Values
    weights: Float64[np.ndarray, " n"] = field(default_factory=lambda: np.empty(0))
    name: str = ""

    def __post_init__(self) -> None:
        values = np.asarray(self.values, np.float64)
        n = len(values)
        weights = np.asarray(self.weights, np.float64) if len(self.weights) else np.ones(n)
        wi, wo = (np.asarray(v, np.float64) for v in (self.wi, self.wo))
        if not n or not wi.shape == wo.shape == values.shape == (n, 3) or weights.shape != (n,):
            raise FormatError(
                f"measurements {self.name!r} have shapes {wi.shape}, {wo.shape}, {values.shape}, {weights.shape}: "
                "expected (n, 3) three times and (n,), with n from 1 on."
            )
        _require(
            np.asarray((np.isfinite(values) & (values >= 0)).all(axis=1)),
            values,
            "f_r",
            "at least 0",
        )
        _require(np.asarray(np.isfinite(weights) & (weights > 0)), weights, "weight", "more than 0")
        for v, which in ((wi, "wi"), (wo, "wo")):
            length = np.linalg.norm(v, axis=1)
            _require(np.abs(length - 1) < _LENGTH_TOLERANCE, v, which, "a unit vector")
            _require(v[:, 2] > 0, v, which, "a direction above the horizon")
            object.__setattr__(self, which, v / length[:, None])
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "weights", weights)

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        return f"Measurements({self.name!r}, {len(self)} pairs of directions)"


class Angles(NamedTuple):
    """Of both directions, in radians: from the normal, and about it from the tangent."""

    theta_i: Angle
    phi_i: Angle
    theta_o: Angle
    phi_o: Angle

    @classmethod
    def of(cls, wi: Directions, wo: Directions) -> "Angles":
        """The angles of pairs of unit vectors."""
        return cls(*to_polar(wi), *to_polar(wo))

    def directions(self) -> tuple[Directions, Directions]:
        """The pairs ``(wi, wo)``, each of shape (n, 3)."""
        return from_polar(self.theta_i, self.phi_i), from_polar(self.theta_o, self.phi_o)


def _require(sound: np.ndarray, values: np.ndarray, what: str, expected: str) -> None:
    """Say which is the first that is not sound."""
    if not sound.all():
        i = int(np.argmin(sound))
        raise FormatError(
            f"measurement {i + 1} of {len(sound)} has {what} {values[i].tolist()}: expected {expected}."
        )
