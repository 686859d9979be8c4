"""What instruments read off a table: linear functionals, each of one channel.

    gloss20, 60, 85        100 int int f cos_i cos_o dwi dwo / int F(cos_i) cos_i dwi       [1, 2]
    haze                   the same at 20 degrees, by two receptors beside the mirror image [3]
    image30, beside30      f where light from 30 degrees is mirrored, and .3 degrees beside [3]
    albedo0, ..., albedo   share of the light from one direction, or from everywhere evenly, that is reflected
    colour                 pi f, light from 45 degrees, seen along the normal               [4]
    body                   pi times the mean beside the highlight, `halfway.look.body_colours`
    profile_j              the mean of f at a theta_h, over phi_d, where theta_d = 20 degrees

A gloss meter pictures a source into the window of a receptor. wi runs over the directions of the source, wo over the
receptor's, and F is the Fresnel term of black glass, whose flat surface pictures the whole source into the receptor: it
reads 100. Windows in degrees, along the plane of incidence x across [1, table 1; 2, table 1]:

                source        receptor
    20          .75 x 2.5     1.80 x 3.6
    60          .75 x 2.5     4.4 x 11.7
    85          .75 x 2.5     4.0 x 6.0
    haze        .75 x 2.5     1.80 x 3.6, twice, with the middle 1.9 from the mirror direction

Illuminant and observer come in as CIE Y of linear sRGB, under D65; the standards say CIE C, which is near to it.

[1] ISO 2813:2014, Paints and varnishes - Determination of gloss value at 20, 60 and 85 degrees.
[2] ASTM D523, Standard Test Method for Specular Gloss; its apertures are studied in H. K. Hammond, I. Nimeroff,
"Measurement of Sixty-Degree Specular Gloss", Journal of Research of the NBS 44, 1950.
[3] ASTM E430, Standard Test Methods for Measurement of Gloss of High-Gloss Surfaces by Abridged Goniophotometry: method B
(haze at 18.1 and 21.9 degrees), and method A (distinctness of image). A table says nothing finer than its cells, so the
latter is read at directions, without windows.
[4] CIE 15, geometry 45:0; an isotropic material reads the same by a ring of light.
"""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from .._types import Angle, Mask
from ..brdf import fresnel, quadrature
from ..halfdiff import Grid, HalfDiff, from_half_diff
from ..look import body_mask

BLACK_GLASS = 1.567
"""Refractive index of the glass that reads 100, at the sodium line."""
SOURCE = (0.75, 2.5)
RECEPTORS = {20: (1.80, 3.6), 60: (4.4, 11.7), 85: (4.0, 6.0)}
HAZE_BESIDE = 1.9
IMAGE_BESIDE = 0.3
PROFILE = np.radians(30) * (np.arange(64) / 63) ** 2
"""theta_h of the profile, as closely spaced near the mirror direction as a MERL table is."""
PROFILE_THETA_D = np.radians(20)
N_PHI_D = 8
N_EVERYWHERE = 16
"""Directions of an even light, by Gauss and Legendre in sin^2."""


def _gloss(
    degrees: int, grid: Grid, measured: Mask, beside: tuple[float, ...] = (0.0,)
) -> quadrature.Functional:
    rules = [
        quadrature.Windows.at(np.radians(degrees), SOURCE, RECEPTORS[degrees], beside=b)
        for b in beside
    ]
    wi, wo, weights = (np.concatenate(part) for part in zip(*(r[:3] for r in rules), strict=True))
    glass = rules[0].wi_weights @ fresnel(rules[0].cos_i, BLACK_GLASS)
    return quadrature.Functional.integral(grid, measured, wi, wo, 100 / glass * weights)


def _at(
    theta_i: float, theta_o: list[float], scale: float, grid: Grid, measured: Mask
) -> quadrature.Functional:
    """``scale`` times the mean of f for light from one angle, towards others on the far side; in degrees."""
    wi, wo = (
        np.stack([sign * np.sin(t), 0 * t, np.cos(t)], axis=-1)
        for sign, t in ((1, np.radians([theta_i] * len(theta_o))), (-1, np.radians(theta_o)))
    )
    weights = np.full(len(theta_o), scale / len(theta_o))
    return quadrature.Functional.integral(grid, measured, wi, wo, weights)


def _albedo(degrees: float, grid: Grid, measured: Mask) -> quadrature.Functional:
    return quadrature.Functional.albedo(grid, measured, np.radians(degrees))


def _everywhere(grid: Grid, measured: Mask) -> quadrature.Functional:
    """Of an even light: the mean of the directional albedo over sin^2."""
    x, weights = np.polynomial.legendre.leggauss(N_EVERYWHERE)
    rows = [
        quadrature.Functional.albedo(grid, measured, theta)
        for theta in np.arcsin(np.sqrt((x + 1) / 2))
    ]
    sums = np.zeros(grid.size)
    for row, weight in zip(rows, weights / 2, strict=True):
        sums[row.cells] += weight * row.weights
    cells = np.flatnonzero(sums)
    return quadrature.Functional(cells, sums[cells])


def _body(grid: Grid, measured: Mask) -> quadrature.Functional:
    mean = quadrature.Functional.mean(np.flatnonzero(body_mask(grid) & measured))
    return quadrature.Functional(mean.cells, np.pi * mean.weights)


def _profile(theta_h: Angle, grid: Grid, measured: Mask) -> quadrature.Functional:
    phi_d = (np.arange(N_PHI_D) + 0.5) * np.pi / N_PHI_D
    angles = HalfDiff(theta_h, np.zeros(1), np.full(1, PROFILE_THETA_D), phi_d)
    wi, wo = from_half_diff(angles)
    return quadrature.Functional.integral(grid, measured, wi, wo, np.full(N_PHI_D, 1 / N_PHI_D))


PROFILE_NAMES = tuple(f"profile_{j}" for j in range(len(PROFILE)))
INSTRUMENTS: Mapping[str, Callable[[Grid, Mask], quadrature.Functional]] = {
    "gloss20": partial(_gloss, 20),
    "gloss60": partial(_gloss, 60),
    "gloss85": partial(_gloss, 85),
    "haze": partial(_gloss, 20, beside=(HAZE_BESIDE, -HAZE_BESIDE)),
    "image30": partial(_at, 30, [30], 1.0),
    "beside30": partial(_at, 30, [30 - IMAGE_BESIDE, 30 + IMAGE_BESIDE], 1.0),
    "albedo0": partial(_albedo, 0),
    "albedo20": partial(_albedo, 20),
    "albedo45": partial(_albedo, 45),
    "albedo60": partial(_albedo, 60),
    "albedo85": partial(_albedo, 85),
    "albedo": _everywhere,
    "colour": partial(_at, 45, [0], np.pi),
    "body": _body,
    **{
        name: partial(_profile, theta_h)
        for name, theta_h in zip(PROFILE_NAMES, PROFILE, strict=True)
    },
}
"""Name to functional of tables whose measured cells are given."""
VERSION = 1
"""Of what they read: part of a cache's key."""


def functionals(grid: Grid, measured: Mask) -> list[quadrature.Functional]:
    """What each of `INSTRUMENTS` reads, of tables whose measured cells are ``measured``; the light's azimuth is 0."""
    return [instrument(grid, measured) for instrument in INSTRUMENTS.values()]
