"""RGL materials: the `.bsdf` files of the material database of EPFL's Realistic Graphics Lab.

A measurement fixes one direction, ``i``, and moves the other, ``o``; m is the half vector. In the files' coordinates

    u_theta(theta) = sqrt(2 theta / pi)         u_phi(phi) = (phi + pi) / (2 pi)
    s = invert(vndf(.; phi_i, theta_i), u(m))   the point that the density of visible normals takes to m
    f_r cos(theta_o) = rgb(s; phi_i, theta_i) D(m) / (4 sigma(i))

where D is the density of normals (`ndf`) and sigma(i) the area of the microsurface seen from i. An isotropic file
has one phi_i and takes phi_m relative to it.

A renderer that traces rays from the camera puts the viewer in the place of ``i``, and so does `RglBrdf.eval`: it is
what Mitsuba's `measured` shows (pbrt-v4 takes the light for the fixed direction in `f`, the viewer in `Sample_f`).
Where a measurement is not reciprocal, a table takes the mean of both orders (`halfway.brdf.Measurement`).

Source: J. Dupuy, W. Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG
37(6), 2018; the names of the fields and their order are those of the readers (Mitsuba's `measured`,
rgl-epfl/brdf-loader).
"""

import hashlib
import math
from dataclasses import dataclass

import numpy as np

from .._types import Directions, Values
from ..brdf import Measurement
from ..halfdiff import above_horizon, to_polar
from .rgl_warp import Interpolant, Warp, slices


@dataclass(frozen=True, eq=False)
class RglBrdf(Measurement):
    """A material of the RGL database; made by `rgl_reader.read_rgl`."""

    name: str
    description: str
    """What the measurers say it is."""
    source: str
    """Where the colours come from: the file's own RGB, or its spectra and how they were converted."""
    phi_i: np.ndarray
    theta_i: np.ndarray
    """The fixed directions of the measurement, in radians, ascending."""
    ndf: Interpolant
    sigma: Interpolant
    vndf: Warp
    rgb: Interpolant
    has_jacobian: bool
    """Whether `rgb` is divided by D / (4 sigma), as in all files of the database."""

    @property
    def is_isotropic(self) -> bool:
        """Whether turning the surface about its normal changes nothing."""
        return len(self.phi_i) <= 2

    @property
    def about(self) -> str:
        kind = "isotropic" if self.is_isotropic else f"anisotropic by {self.anisotropy():.0%}"
        size = f"{len(self.theta_i)} x {len(self.phi_i)} directions"
        description = "".join(c for c in self.description if c.isprintable()).strip()
        return ", ".join(
            filter(None, [f"an RGL material ({kind})", size, self.source, description])
        )

    def eval(self, wi: Directions, wo: Directions) -> Values:
        """f_r in 1/sr, shape (..., 3): 0 below the horizon; negative where the measured colour is out of gamut."""
        return above_horizon(lambda wi, wo: self._at(wo, wi).T, wi, wo)

    def fingerprint(self) -> bytes:
        arrays = (
            self.phi_i,
            self.theta_i,
            self.ndf.nodes,
            self.sigma.nodes,
            self.vndf.density,
            self.rgb.nodes,
        )
        digest = hashlib.sha256(bytes([self.has_jacobian]))
        for array in arrays:
            digest.update(repr(array.shape).encode())
            digest.update(np.ascontiguousarray(array).data)
        return digest.digest()

    def _at(self, i: Directions, o: Directions) -> np.ndarray:
        i, o = self._folded(i, o)
        theta_i, phi_i = map(np.asarray, to_polar(i))
        theta_m, phi_m = map(np.asarray, to_polar(i + o))
        u_m = _u_theta(theta_m), _u_phi(phi_m - phi_i if self.is_isotropic else phi_m)
        where = slices((self.phi_i, self.theta_i), (phi_i, theta_i))
        values = self.rgb.at(*self.vndf.invert(*u_m, where), where)
        if self.has_jacobian:
            everywhere = slices((), ())
            sigma = self.sigma.at(_u_theta(theta_i), _u_phi(phi_i), everywhere)
            scale = self.ndf.at(*u_m, everywhere)
            values *= np.divide(scale, 4 * sigma, out=np.zeros_like(scale), where=sigma > 0)
        return values / o[:, 2:]

    def _folded(self, i: Directions, o: Directions) -> tuple[Directions, Directions]:
        """The pair turned or mirrored into the part of the circle that the file covers."""
        if self.is_isotropic:
            return i, o
        n_parts = round(2 * math.pi / float(self.phi_i[-1] - self.phi_i[0]))
        if n_parts < 2:
            return i, o
        # A material with one mirror plane and a half turn is stored for a quarter, one with a half turn for a half.
        flip_y = np.where(i[:, 1] < 0, 1.0, -1.0)
        flip_x = np.where(i[:, 0] < 0, 1.0, -1.0) if n_parts == 4 else flip_y
        flip = np.stack([flip_x, flip_y, np.ones_like(flip_y)], axis=-1)
        return flip * i, flip * o


def _u_theta(theta: np.ndarray) -> np.ndarray:
    return np.sqrt(theta * (2 / np.pi))


def _u_phi(phi: np.ndarray) -> np.ndarray:
    return (phi + np.pi) / (2 * np.pi) % 1
