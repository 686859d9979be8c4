"""Writing of RGL `.bsdf` files from any BRDF.

A reader takes the half vector m to the point s of the unit square and shows (see `rgl`)

    f_r cos(theta_o) = rgb(s) D(m) / (4 sigma(i))

so ``rgb = f_r cos(theta_o) 4 sigma(i) / D(m)`` at the half vector of each node makes the file right there, and D (see
`rgl_normals`) decides how the nodes are spread. Where a node's direction is below the horizon or unmeasured, rgb
continues the nearest value, so that interpolation up to the edge stays clean. `luminance` steers the readers' importance
sampling: what is reflected per area of s, nearly 0 below the horizon.

An anisotropic material takes fixed directions at several azimuths. One that looks the same after half a turn needs half of them,
and one that is its own mirror image as well a quarter: the readers fold the rest into

    phi_i   [-pi, pi], [-pi, 0] or [-pi, -pi/2]

Source: J. Dupuy, W. Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG
37(6), 2018, section 4; the readers (Mitsuba's `measured`, pbrt-v4's `MeasuredBxDF`) for what a file must hold.
"""

from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..brdf import Brdf, Quality, lit_sphere, quadrature, quality
from ..colour import LUMINANCE
from ..halfdiff import from_half_diff, from_polar, reflect, turn
from .rgl_normals import Normals
from .rgl_reader import from_fields
from .rgl_warp import Interpolant, Warp, slices
from .spectra import WAVELENGTHS, smooth_primaries
from .tensor_file import write_tensor_file

_GRAZING = np.pi / 2 - 1e-3
_LEAST_COSINE = 1e-4
_LEAST_LIGHT = (
    1e-4  # of the mean: beside a bright node, what is interpolated must be sampled now and then
)


N_PHI_I = 4
"""Intervals of phi_i in each quarter of a turn: what is left beside D changes slowly."""
_MIRROR = np.array([1.0, -1.0, 1.0])
_ALIKE = 1e-3  # of the mean: two materials that differ by less are one


class Resolution(NamedTuple):
    """How finely a file samples a material."""

    n_theta_i: int
    """Fixed directions, evenly spaced from the normal to the horizon."""
    size: int
    """Nodes along each side of the unit square of the other direction."""


RESOLUTIONS = tuple(Resolution(n, 2 * n) for n in (16, 32, 48, 64))
"""0.5, 2.6, 8 and 18 MB; of an anisotropic material 7, 21 and 52 MB, or four times that where no part of a turn is as another.
Four to six times as much with spectra."""

N_ANISOTROPIC = 3
"""So many of them are tried for an anisotropic material."""
MIN_PSNR = 50.0


@dataclass(frozen=True)
class Written:
    """What was written, and how well it stands for the BRDF."""

    path: Path
    resolution: Resolution
    quality: Quality


def write_rgl(
    path: str | Path,
    brdf: Brdf,
    *,
    spectral: bool = False,
    resolution: Resolution | None = None,
    min_psnr: float = MIN_PSNR,
    description: str = "",
) -> Written:
    """Write a BRDF as a `.bsdf` file, whole or not at all.

    Parameters
    ----------
    path : path
        Mitsuba and pbrt take any name.
    brdf : Brdf
        Isotropic or not.
    spectral : bool
        False: ``rgb``, for Mitsuba's rgb variants. True: ``spectra`` and ``wavelengths`` (smooth upsampling, see
        `spectra.smooth_primaries`), for pbrt-v4 and Mitsuba's spectral variants. No reader takes both in one file.
    resolution : Resolution, optional
        By default the first of `RESOLUTIONS` whose picture is within ``min_psnr``, or the last.
    min_psnr : float
        In dB, of the lit sphere of `rgl_quality`.
    description : str
        What readers show of the file.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    path = Path(path)
    description = description or str(getattr(brdf, "name", ""))
    expected = lit_sphere(brdf)
    normals = Normals.of(brdf)
    fields, used, reached = {}, RESOLUTIONS[0], Quality(0.0, 1.0)
    # Files of several azimuths are large; what the last size brings is not seen.
    usual = RESOLUTIONS if brdf.is_isotropic else RESOLUTIONS[:N_ANISOTROPIC]
    for used in [resolution] if resolution else usual:
        fields = _fields(brdf, normals, used, description)
        reached = quality(lit_sphere(from_fields(fields, path.name)), expected)
        if reached.psnr >= min_psnr:
            break
    write_tensor_file(path, _with_spectra(fields) if spectral else fields)
    return Written(path, used, reached)


def _fields(
    brdf: Brdf, normals: Normals, resolution: Resolution, description: str
) -> dict[str, np.ndarray]:
    theta_i, phi_i = np.linspace(0, np.pi / 2, resolution.n_theta_i), _azimuths(brdf)
    vndf = np.stack([normals.visible(theta_i, phi) for phi in phi_i])
    warp = Warp.of(vndf.reshape(-1, *vndf.shape[2:]))
    parts = [
        _slice(brdf, normals, warp, i, (min(theta, _GRAZING), phi), resolution.size)
        for i, (phi, theta) in enumerate(product(phi_i, theta_i))
    ]
    rgb, luminance = (
        np.stack(part).astype(np.float32).reshape(*vndf.shape[:2], *part[0].shape)
        for part in zip(*parts, strict=True)
    )
    return {
        "description": np.frombuffer(description.encode() or b" ", np.uint8),
        "phi_i": phi_i.astype(np.float32),
        "theta_i": theta_i.astype(np.float32),
        "ndf": normals.density.astype(np.float32),
        "sigma": normals.area.astype(np.float32),
        "vndf": vndf,
        "luminance": luminance,
        "rgb": np.ascontiguousarray(np.moveaxis(rgb, -1, 2)),
        "jacobian": np.ones(1, np.uint8),
    }


def _azimuths(brdf: Brdf) -> np.ndarray:
    """phi_i of the fixed directions: one for an isotropic material."""
    if brdf.is_isotropic:
        return np.zeros(1)
    n_parts = _n_parts(brdf)
    return np.linspace(-np.pi, 2 * np.pi / n_parts - np.pi, 4 * N_PHI_I // n_parts + 1)


def _n_parts(brdf: Brdf) -> int:
    """Into how many parts of a turn, each like the first, the readers can fold an anisotropic material: 1, 2 or 4."""
    angles = quadrature.spread_angles(1000)
    wi, wo = from_half_diff(angles._replace(phi_h=np.arange(1000) * 2.4))  # about the golden angle
    exchanged = np.maximum(wi[:, 2:] * wo[:, 2:], 0)
    values, turned, mirrored = (
        np.nan_to_num(brdf.eval(*pair)) * exchanged
        for pair in ((wi, wo), (turn(wi, np.pi), turn(wo, np.pi)), (wi * _MIRROR, wo * _MIRROR))
    )
    alike = [np.abs(other - values).sum() <= _ALIKE * values.sum() for other in (turned, mirrored)]
    return 4 if all(alike) else 2 if alike[0] else 1


def _slice(
    brdf: Brdf, normals: Normals, warp: Warp, i_slice: int, of: tuple[float, float], size: int
) -> tuple[np.ndarray, np.ndarray]:
    """``rgb``, shape (size, size, 3), and ``luminance``, shape (size, size), seen from one fixed direction, (theta_i, phi_i)."""
    side = np.linspace(0, 1, size)
    s_phi, s_theta = (s.ravel() for s in np.meshgrid(side, side, indexing="ij"))
    u_theta, u_phi = warp.sample(s_theta, s_phi, i_slice)
    theta_i, phi_i = of
    i = from_polar(np.array(theta_i), np.array(phi_i))
    m = from_polar(np.pi / 2 * u_theta**2, np.pi * (2 * u_phi - 1))
    o = reflect(i, m, m @ i)
    values = brdf.eval(o, np.broadcast_to(i, o.shape))
    known = (o[:, 2] > _LEAST_COSINE) & (m @ i > 0) & np.isfinite(values).all(axis=1)
    scale = o[:, 2] * 4 * normals.area_at(theta_i, phi_i) / normals.density_at(u_theta, u_phi)
    rgb = np.where(known[:, None], np.maximum(values, 0) * scale[:, None], 0)
    rgb = _continued(rgb.reshape(size, size, 3), known.reshape(size, size))
    crowding = Interpolant(warp.density[i_slice, ..., None][None]).at(
        u_theta, u_phi, slices((), ())
    )
    area = (
        normals.density_at(u_theta, u_phi)
        * np.maximum(m @ i, 0)
        * u_theta
        * np.hypot(m[:, 0], m[:, 1])
    )
    area = np.divide(area, crowding[:, 0], out=np.zeros_like(area), where=crowding[:, 0] > 0)
    # f_r cos(theta_o) times the area of directions that a piece of the unit square stands for
    light = np.where(o[:, 2] > 0, area, 0).reshape(size, size) * (rgb @ LUMINANCE)
    # The smallest summand keeps the density of a black material positive.
    return rgb, light + _LEAST_LIGHT * light.mean() + 1e-30


def _continued(values: np.ndarray, known: np.ndarray) -> np.ndarray:
    """The nearest known value where there is none."""
    if known.all() or not known.any():
        return values
    from scipy.ndimage import distance_transform_edt

    nearest = distance_transform_edt(~known, return_distances=False, return_indices=True)
    return values[tuple(np.asarray(nearest))]


def _with_spectra(fields: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    primaries = smooth_primaries(WAVELENGTHS).astype(np.float32)
    rest = {name: values for name, values in fields.items() if name != "rgb"}
    spectra = np.einsum("lc,ptcxy->ptlxy", primaries, fields["rgb"])
    return {**rest, "wavelengths": WAVELENGTHS.astype(np.float32), "spectra": spectra}
