"""The shifted-gamma-distribution model (SGD).

    f_r = (rhoD + rhoS D(theta_h) F(theta_d) G1(theta_i) G1(theta_o) / (cos_i cos_o)) / pi

    D  = K exp(-x) / (pi x^p cos^4 theta_h)              x = alpha + tan^2 theta_h / alpha
    F  = F0 - F1 cos theta_d + (1 - F0) (1 - cos theta_d)^5
    G1 = 1 + Lambda (1 - exp(c max(0, theta - theta0)^k)), clamped to [0, 1]

Source: M. M. Bagher, C. Soler, N. Holzschuch, "Accurate fitting of measured reflectances using a Shifted Gamma
micro-facet distribution", Computer Graphics Forum 31(4) (EGSR), 2012, section 3.
"""

from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from .._types import Angle
from ..brdf import IsotropicModel
from .grazing import GRAZING_DEGREES, held

# exp(600) is finite, and times any Lambda above 1e-260 it takes G1 far below its clamp at 0.
_LOG_LARGEST = np.log(600)


@dataclass(frozen=True, eq=False)
class SgdModel(IsotropicModel):
    """Eleven parameters for each channel, every one a float64 array of shape (3,) (linear RGB).

    Held constant past 80 degrees: the cosines ``cos_i`` and ``cos_o``, in G1 and in the denominator, are never taken
    below cos(80 degrees), because the published fits say nothing beyond (see `halfway.models.grazing`). The fitted F
    falls a little below 0 in places; it is clamped there, so that no value is negative.

    The published c spans 1e-8 to 1e109 and k reaches 856, so it is kept as its logarithm, ``log_c``.
    """

    rhoD: np.ndarray
    rhoS: np.ndarray
    alpha: np.ndarray
    p: np.ndarray
    F0: np.ndarray
    F1: np.ndarray
    K: np.ndarray
    Lambda: np.ndarray
    log_c: np.ndarray
    k: np.ndarray
    theta0: np.ndarray

    formula: ClassVar[str] = f"SGD, held past {GRAZING_DEGREES:g} degrees"

    def __post_init__(self) -> None:
        for field in fields(self):
            value = np.array(getattr(self, field.name), np.float64).reshape(3)
            value.flags.writeable = False
            object.__setattr__(self, field.name, value)

    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        del phi_d  # it acts through the two cosines
        cos_i, cos_o = held(cos_i), held(cos_o)
        # G1 is flat near the normal, so the digits that arccos loses there do not matter.
        theta_i, theta_o, foreshortening = np.arccos(cos_i), np.arccos(cos_o), cos_i * cos_o
        return np.stack(
            [
                self.rhoD[channel] / np.pi
                + self._glossy(theta_h, np.cos(theta_d), channel)
                * (self._G1(theta_i, channel) * self._G1(theta_o, channel) / foreshortening)
                for channel in range(3)
            ]
        )

    def _glossy(self, theta_h: Angle, cos_d: Angle, channel: int) -> Angle:
        """The part ``rhoS D F / pi`` of one channel."""
        alpha, F0 = self.alpha[channel], self.F0[channel]
        x = alpha + np.tan(theta_h) ** 2 / alpha
        D = self.K[channel] * np.exp(-x) / (np.pi * x ** self.p[channel] * np.cos(theta_h) ** 4)
        F = F0 - self.F1[channel] * cos_d + (1 - F0) * (1 - cos_d) ** 5
        return self.rhoS[channel] / np.pi * D * np.maximum(F, 0)

    def _G1(self, theta: Angle, channel: int) -> Angle:
        past = np.maximum(theta - self.theta0[channel], np.finfo(float).tiny)
        log_exponent = self.log_c[channel] + self.k[channel] * np.log(past)
        growth = np.expm1(np.exp(np.minimum(log_exponent, _LOG_LARGEST)))
        return np.clip(1 - self.Lambda[channel] * growth, 0, 1)
