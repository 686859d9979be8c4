"""Densities of normals: what an RGL file is built around, taken from a BRDF.

    D(theta_h)   mean of f_r over theta_d and phi_d, weighted by sqrt(cos_i cos_o): highlight and floor as f_r has them
    sigma(i)     = integral of D(m) max(0, i . m) dm
    vndf(m; i)   ~ D(m) max(0, i . m), as a density over u = (u_theta, u_phi), with theta_m = (pi/2) u_theta^2

A file holds the right values at its nodes whatever D and vndf are; where f_r is nearly proportional to D they are nearly
even in between, and vndf spreads the nodes. So D keeps the floor under the highlight, which a microfacet model would take
away, and vndf is broader than the visible normals: by 3 to 10 dB, on every material tried.
"""

from dataclasses import dataclass

import numpy as np

from ..brdf import Brdf
from ..halfdiff import HalfDiff, from_half_diff

N_THETA = 128
"""Nodes along u_theta, of the density of normals and of its visible part."""
N_PHI = 32
"""Nodes along u_phi of the visible part, which varies with phi as a cosine does."""

_THETA_D = np.radians(np.arange(2.5, 60, 5))
_PHI_D = np.pi * (np.arange(8) + 0.5) / 8
_LEAST_COSINE = 0.05
_LEAST_DENSITY = 1e-6  # of the largest: a density of 0 could not be divided by


@dataclass(frozen=True, eq=False)
class Normals:
    """D and sigma at the nodes of u_theta, shape (N_THETA,)."""

    density: np.ndarray
    area: np.ndarray

    @classmethod
    def of(cls, brdf: Brdf) -> "Normals":
        """The normals that a BRDF's highlight stands for; an even density where it reflects nothing."""
        density = _mean_over_differences(brdf)
        density = np.maximum(density, _LEAST_DENSITY * density.max())
        density = density if density.max() > 0 else np.ones_like(density)
        theta = _theta(_nodes())
        # The projected area of the surface from straight above is 1.
        density = density / np.sum(_solid_angles() * density * np.cos(theta))
        return cls(density, _projected_area(density))

    def density_at(self, u_theta: np.ndarray) -> np.ndarray:
        """D as the readers interpolate it."""
        return np.interp(u_theta, _nodes(), self.density.astype(np.float32))

    def area_at(self, theta_i: float) -> float:
        """Sigma as the readers interpolate it."""
        u = np.sqrt(theta_i * (2 / np.pi))
        return float(np.interp(u, _nodes(), self.area.astype(np.float32)))

    def visible(self, theta_i: np.ndarray) -> np.ndarray:
        """The density of a file's nodes over u, seen from each ``theta_i``, shape (n, N_PHI, N_THETA); each of mean 1.

        A third as the normals are visible, two thirds as the square root of that: a floor of half the nodes or so for
        what lies between the highlight and the horizon, where a grazing view leaves hardly any.
        """
        u = _nodes()
        phi = np.pi * np.linspace(-1, 1, N_PHI)[:, None]
        cosines = _cosines(theta_i[:, None, None], _theta(u), phi)
        visible = self.density * np.maximum(cosines, 0) * u * np.sin(_theta(u))
        spread = np.sqrt(visible)
        return (_of_mean_1(visible) + 2 * _of_mean_1(spread)).astype(np.float32) / 3


def _of_mean_1(values: np.ndarray) -> np.ndarray:
    return values / values.mean(axis=(1, 2), keepdims=True)


def _nodes() -> np.ndarray:
    return np.linspace(0, 1, N_THETA)


def _theta(u_theta: np.ndarray) -> np.ndarray:
    return np.pi / 2 * u_theta**2


def _cosines(theta_i: np.ndarray, theta_m: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Cosines between directions that are ``phi`` apart in azimuth."""
    return np.cos(theta_i) * np.cos(theta_m) + np.sin(theta_i) * np.sin(theta_m) * np.cos(phi)


def _mean_over_differences(brdf: Brdf) -> np.ndarray:
    """Mean of f_r at each node of theta_h; past the last node that can be seen, the value there."""
    theta_h = _theta(_nodes())[:, None, None]
    zero = np.zeros((1, 1, 1))
    wi, wo = from_half_diff(HalfDiff(theta_h, zero, _THETA_D[:, None], _PHI_D))
    cos_i, cos_o = wi[..., 2], wo[..., 2]
    values = brdf.eval(wi, wo).mean(axis=-1)
    seen = (np.minimum(cos_i, cos_o) > _LEAST_COSINE) & np.isfinite(values)
    weights = np.where(seen, np.sqrt(np.abs(cos_i * cos_o)), 0)
    total = np.sum(np.where(seen, np.maximum(values, 0), 0) * weights, axis=(1, 2))
    known = np.flatnonzero(weights.sum(axis=(1, 2)))
    if not len(known):
        return np.zeros(N_THETA)
    mean = total[known] / weights.sum(axis=(1, 2))[known]
    return np.interp(_nodes(), _nodes()[known], mean)


def _solid_angles() -> np.ndarray:
    """Solid angle of the band around each node: 2 pi sin(theta) dtheta, trapezoidal in u_theta."""
    u = _nodes()
    width = np.full(N_THETA, 1 / (N_THETA - 1))
    width[[0, -1]] /= 2
    return 2 * np.pi * np.sin(_theta(u)) * np.pi * u * width


def _projected_area(density: np.ndarray) -> np.ndarray:
    phi = 2 * np.pi * (np.arange(64) + 0.5) / 64
    theta = _theta(_nodes())
    cosines = _cosines(theta[:, None, None], theta[:, None], phi)
    return np.maximum(cosines, 0).mean(axis=2) @ (_solid_angles() * density)
