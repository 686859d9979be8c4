"""Densities of normals: what an RGL file is built around, taken from a BRDF.

    D(m)         mean of f_r over theta_d and phi_d, weighted by sqrt(cos_i cos_o): highlight and floor as f_r has them
    sigma(i)     = integral of D(m) max(0, i . m) dm
    vndf(m; i)   ~ D(m) max(0, i . m), as a density over u = (u_theta, u_phi), with theta_m = (pi/2) u_theta^2, phi_m = pi (2 u_phi - 1)

D and sigma of an isotropic material are the same in two rows of phi; of others they are tabulated along it, and vndf finely.

A file holds the right values at its nodes whatever D and vndf are; where f_r is nearly proportional to D they are nearly
even in between, and vndf spreads the nodes. So D keeps the floor under the highlight, which a microfacet model would take
away, and vndf is broader than the visible normals: by 3 to 10 dB, on every material tried.
"""

from dataclasses import dataclass

import numpy as np

from ..brdf import Brdf
from ..halfdiff import HalfDiff, from_half_diff
from .rgl_warp import Interpolant, slices

N_THETA = 128
"""Nodes along u_theta, of the density of normals and of its visible part."""
N_PHI = 32
"""Nodes along u_phi of the visible part, which varies with phi as a cosine does."""
N_PHI_TURNED = 129
"""The same, and of the density, where it depends on phi itself: narrow at large theta_m."""
N_PHI_AREA = 33

_THETA_D = np.radians(np.arange(2.5, 60, 5))
_PHI_D = np.pi * (np.arange(8) + 0.5) / 8
_LEAST_COSINE = 0.05
_LEAST_DENSITY = 1e-6  # of the largest: a density of 0 could not be divided by


@dataclass(frozen=True, eq=False)
class Normals:
    """D and sigma at the nodes of u_phi and u_theta, shape (n_phi, N_THETA)."""

    density: np.ndarray
    area: np.ndarray
    n_phi: int
    """Nodes along u_phi of the visible part."""

    @classmethod
    def of(cls, brdf: Brdf) -> "Normals":
        """The normals that a BRDF's highlight stands for; an even density where it reflects nothing."""
        n_phi, n_visible, n_area = (
            (2, N_PHI, 2) if brdf.is_isotropic else (N_PHI_TURNED, N_PHI_TURNED, N_PHI_AREA)
        )
        phi_h = [0.0] if brdf.is_isotropic else _phi(n_phi).tolist()
        density = np.stack([_mean_over_differences(brdf, phi) for phi in phi_h])
        density = np.maximum(density, _LEAST_DENSITY * density.max())
        density = density if density.max() > 0 else np.ones_like(density)
        # The projected area of the surface from straight above is 1.
        over_phi = density.mean(axis=0) if brdf.is_isotropic else density[:-1].mean(axis=0)
        density = density / np.sum(_solid_angles() * over_phi * np.cos(_theta(_nodes())))
        density = np.tile(density, (n_phi // len(density), 1))
        return cls(density, _projected_area(density, n_area), n_visible)

    def density_at(self, u_theta: np.ndarray, u_phi: np.ndarray) -> np.ndarray:
        """D as the readers interpolate it."""
        return _interpolated(self.density, u_theta, u_phi)

    def area_at(self, theta_i: float, phi_i: float) -> float:
        """Sigma as the readers interpolate it."""
        u_theta, u_phi = np.sqrt([theta_i * (2 / np.pi)]), np.array([phi_i / (2 * np.pi) + 0.5])
        return float(_interpolated(self.area, u_theta, u_phi)[0])

    def visible(self, theta_i: np.ndarray, phi_i: float) -> np.ndarray:
        """The density of a file's nodes over u, seen from each ``theta_i``, shape (n, n_phi, N_THETA); each of mean 1.

        A third as the normals are visible, two thirds as the square root of that: a floor of half the nodes or so for
        what lies between the highlight and the horizon, where a grazing view leaves hardly any.
        """
        u = _nodes()
        phi = _phi(self.n_phi)[:, None] - phi_i
        cosines = _cosines(theta_i[:, None, None], _theta(u), phi)
        density = self.density if len(self.density) == self.n_phi else self.density[:1]
        visible = density * np.maximum(cosines, 0) * u * np.sin(_theta(u))
        spread = np.sqrt(visible)
        return (_of_mean_1(visible) + 2 * _of_mean_1(spread)).astype(np.float32) / 3


def _of_mean_1(values: np.ndarray) -> np.ndarray:
    return values / values.mean(axis=(1, 2), keepdims=True)


def _nodes() -> np.ndarray:
    return np.linspace(0, 1, N_THETA)


def _phi(n: int) -> np.ndarray:
    """The azimuths of nodes of u_phi."""
    return np.pi * np.linspace(-1, 1, n)


def _interpolated(values: np.ndarray, u_theta: np.ndarray, u_phi: np.ndarray) -> np.ndarray:
    nodes = values.astype(np.float32)[None, ..., None]
    return Interpolant(nodes).at(u_theta, u_phi, slices((), ()))[..., 0]


def _theta(u_theta: np.ndarray) -> np.ndarray:
    return np.pi / 2 * u_theta**2


def _cosines(theta_i: np.ndarray, theta_m: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Cosines between directions that are ``phi`` apart in azimuth."""
    return np.cos(theta_i) * np.cos(theta_m) + np.sin(theta_i) * np.sin(theta_m) * np.cos(phi)


def _mean_over_differences(brdf: Brdf, phi_h: float) -> np.ndarray:
    """Mean of f_r at each node of theta_h; past the last node that can be seen, the value there."""
    theta_h = _theta(_nodes())[:, None, None]
    azimuth = np.full((1, 1, 1), phi_h)
    wi, wo = from_half_diff(HalfDiff(theta_h, azimuth, _THETA_D[:, None], _PHI_D))
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


def _projected_area(density: np.ndarray, n_phi: int) -> np.ndarray:
    """Sigma at ``n_phi`` nodes of u_phi."""
    theta = _theta(_nodes())
    if len(density) == 2:
        phi = 2 * np.pi * (np.arange(64) + 0.5) / 64
        cosines = _cosines(theta[:, None, None], theta[:, None], phi)
        area = np.maximum(cosines, 0).mean(axis=2) @ (_solid_angles() * density[0])
        return np.tile(area, (n_phi, 1))
    phi_m, weight = (
        _phi(len(density))[:-1, None],
        _solid_angles() * density[:-1] / (len(density) - 1),
    )
    rows = [
        np.maximum(_cosines(theta[:, None, None], theta, phi_m - phi_i), 0).reshape(N_THETA, -1)
        @ weight.ravel()
        for phi_i in _phi(n_phi)
    ]
    return np.stack(rows)
