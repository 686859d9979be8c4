"""From where the azimuth of a half vector counts when a table is sampled, and which views its density is tabulated for.

    isotropic      highlights turn with the view:  views by theta_o;           phi from the view, its two sides alike
    anisotropic    they stay with the tangent:     views by theta_o and phi_o; phi from the tangent, a whole turn

Columns are what lies between two neighbouring azimuths that have a density; a position of 2.5 is in the middle of column 2.
"""

import math
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from ..halfdiff import Axis

View = tuple[Any, Any]
"""Its index, and the weight of its density."""


class AboutView:
    """The azimuths of isotropic tables."""

    n_thetas = 24
    """Views from the normal to the steepest."""
    of_views = np.zeros(1)
    """Azimuths of the views at each theta_o."""
    n_columns = 16
    """Over half a turn."""
    step = math.pi / n_columns
    nodes = step * np.arange(n_columns + 1.0)
    """The azimuths between columns."""
    sides = np.array([1.0, -1.0])
    """Of the plane of incidence, whose densities are averaged."""

    def around(self, _: Any, thetas: list[View]) -> list[View]:
        """The views about ``wo``, by those about its theta_o."""
        return thetas

    def to_column(self, wo: Any, H: Any) -> Any:
        """Positions in [0, n_columns] of half vectors of any length."""
        turn = dr.atan2(wo.x * H.y - wo.y * H.x, wo.x * H.x + wo.y * H.y)
        return dr.abs(turn) * (1 / self.step)

    def to_side(self, sample: Any) -> tuple[Any, Any]:
        """A number in [0, 1) that is left of ``sample`` after it chose the side, and the side by its sign."""
        side = 2 * sample - 1
        return dr.abs(side), side

    def to_azimuth(self, wo: Any, position: Any, side: Any) -> tuple[Any, Any]:
        """Cosine and sine of the azimuth at a position in the frame of the surface."""
        sin_phi, cos_phi = dr.sincos(dr.mulsign(position * self.step, side))
        across = dr.sqrt(dr.square(wo.x) + dr.square(wo.y))
        cos_o = dr.select(across > 0, wo.x / across, 1)
        sin_o = dr.select(across > 0, wo.y / across, 0)
        return cos_o * cos_phi - sin_o * sin_phi, sin_o * cos_phi + cos_o * sin_phi


class AboutTangent:
    """The azimuths of tables with an axis of phi_h, whose cell centres are among the nodes."""

    LEAST_COLUMNS = 32
    N_TURNS = 16

    n_thetas = 16
    of_views = 2 * np.pi * np.arange(N_TURNS) / N_TURNS
    sides = np.array([1.0])

    def __init__(self, axis: Axis) -> None:
        n_cells = axis.size * round(2 * math.pi / axis.stop)
        self.n_columns = n_cells * math.ceil(self.LEAST_COLUMNS / n_cells)
        self.step = 2 * math.pi / self.n_columns
        self._first = float(axis.to_angle(np.array(0.5)))
        self.nodes = self._first + self.step * np.arange(self.n_columns + 1.0)

    def around(self, wo: Any, thetas: list[View]) -> list[View]:
        """The views about ``wo``, by those about its theta_o."""
        turn = dr.atan2(wo.y, wo.x) * (1 / (2 * math.pi))
        position = self.N_TURNS * (turn - dr.floor(turn))
        lower = dr.minimum(mi.UInt32(position), self.N_TURNS - 1)
        upper = dr.select(lower + 1 < self.N_TURNS, lower + 1, 0)
        fraction = position - mi.Float(lower)
        return [
            (theta * self.N_TURNS + turn, weight * share)
            for theta, weight in thetas
            for turn, share in ((lower, 1 - fraction), (upper, fraction))
        ]

    def to_column(self, _: Any, H: Any) -> Any:
        """Positions in [0, n_columns] of half vectors of any length."""
        turn = (dr.atan2(H.y, H.x) - self._first) * (1 / (2 * math.pi))
        return self.n_columns * (turn - dr.floor(turn))

    def to_side(self, sample: Any) -> tuple[Any, Any]:
        """The sample itself, for there is one side."""
        return sample, None

    def to_azimuth(self, _: Any, position: Any, side: Any) -> tuple[Any, Any]:  # noqa: ARG002
        """Cosine and sine of the azimuth at a position in the frame of the surface."""
        sin_phi, cos_phi = dr.sincos(self._first + position * self.step)
        return cos_phi, sin_phi
