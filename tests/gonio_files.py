"""UTIA and MIT CSAIL files made of a BRDF, as their readers lay them out."""

import numpy as np

from halfway.brdf import Brdf


def utia_directions():
    """Of the rows or columns of a UTIA file: theta and phi in degrees, and unit vectors."""
    theta, phi = np.meshgrid(np.arange(6) * 15.0, np.arange(48) * 7.5, indexing="ij")
    return vectors(np.radians(theta.ravel()), np.radians(phi.ravel()))


def vectors(theta, phi):
    """Unit vectors."""
    sin = np.sin(theta)
    return np.stack([sin * np.cos(phi), sin * np.sin(phi), np.cos(theta)], axis=-1)


def utia(brdf: Brdf) -> bytes:
    """The file."""
    v = utia_directions()
    values = brdf.eval(v[:, None], v[None])
    return np.moveaxis(values, -1, 0).astype("<f8").tobytes()


def csail_pairs(sizes, *, half):
    """The pairs of directions of a file of these sizes, each of shape (*sizes, 3)."""
    stops = (np.pi / 2, np.pi / 2, np.pi if half else 2 * np.pi, 2 * np.pi)
    middles = [(np.arange(n) + 0.5) * stop / n for n, stop in zip(sizes, stops, strict=True)]
    theta_i, theta_o, phi_d, phi_i = np.meshgrid(*middles, indexing="ij")
    return vectors(theta_i, phi_i), vectors(theta_o, phi_i + phi_d)


def csail(brdf: Brdf, sizes=(4, 5, 6, 8), *, half=False) -> bytes:
    """The file, with its first sample unmeasured."""
    values = np.moveaxis(brdf.eval(*csail_pairs(sizes, half=half)), -1, 0).astype("<f4")
    values[:, 0, 0, 0, 0] = -1
    header = np.zeros(16, "<i4")
    header[:4], header[6], header[9], header[10] = sizes, 1, half, 3
    return header.tobytes() + values.tobytes()
