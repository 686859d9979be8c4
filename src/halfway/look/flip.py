"""LDR-FLIP: how different two pictures look to someone who flips between them.

    FLIP = c^(1 - e)        per pixel, of the difference of colours c and of features e, both in [0, 1]

c      in YCxCz what the eye cannot resolve at `PIXELS_PER_DEGREE` is filtered away; then the HyAB distance in CIELAB, its a* and b*
       scaled by lightness (Hunt), to the power `Q_C`, compressed towards that of green and blue, the largest there is
e      edges and points of lightness (first and second derivatives of a Gaussian as wide as the eye finds them), the larger difference,
       to the power `Q_F`

Reference: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: A Difference Evaluator for
Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2) (HPG), 2020, sections 4.1 to 4.3.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from jaxtyping import Float64

from ..colour import to_lab, to_relative_xyz
from .appearance import shown

PIXELS_PER_DEGREE = 67.0
"""Of a display of .7 m and 3840 pixels, seen from .7 m."""
Q_C, Q_F = 0.7, 0.5
P_C, P_T = 0.4, 0.95
FEATURE_WIDTH = 0.082
"""In degrees."""
_CONTRAST: Sequence[Sequence[tuple[float, float]]] = (
    [(1.0, 0.0047)],
    [(1.0, 0.0053)],
    [(34.1, 0.04), (13.5, 0.025)],
)
"""Of Y, Cx, Cz: amplitudes and squared widths of the Gaussians that contrast sensitivity is a sum of."""

Image = Float64[np.ndarray, "height width 3"]
Plane = Float64[np.ndarray, "height width"]
Kernel = Float64[np.ndarray, "n n"]


def flip(a: np.ndarray, b: np.ndarray) -> float:
    """Mean FLIP of two linear pictures, as a display shows them, in [0, 1]."""
    coded = [_opponent(shown(np.asarray(x, np.float64))) for x in (a, b)]
    colours = _colour_difference(*map(_resolved, coded))
    features = _feature_difference(*((x[..., 0] + 16) / 116 for x in coded))
    return float((colours ** (1 - features)).mean())


def _opponent(rgb: Image) -> Image:
    """YCxCz of linear RGB: CIELAB without its cube root."""
    x, y, z = np.moveaxis(to_relative_xyz(rgb), -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def _linear(opponent: Image) -> Image:
    y = (opponent[..., 0] + 16) / 116
    xyz = np.stack([y + opponent[..., 1] / 500, y, y - opponent[..., 2] / 200], axis=-1)
    return xyz @ np.linalg.inv(to_relative_xyz(np.eye(3)))


def _resolved(opponent: Image) -> Image:
    """CIELAB of what the eye resolves, with colours as strong as their lightness lets them look."""
    planes = [_convolved(opponent[..., i], kernel) for i, kernel in enumerate(_blurs())]
    lab = to_lab(np.clip(_linear(np.stack(planes, axis=-1)), 0, 1))
    return _hunt(lab)


def _hunt(lab: Float64[np.ndarray, "... 3"]) -> Float64[np.ndarray, "... 3"]:
    strength = lab[..., :1] / 100
    return np.concatenate([lab[..., :1], lab[..., 1:] * strength], axis=-1)


def _hyab(
    a: Float64[np.ndarray, "... 3"], b: Float64[np.ndarray, "... 3"]
) -> Float64[np.ndarray, "..."]:
    across = np.asarray(np.linalg.norm(a[..., 1:] - b[..., 1:], axis=-1))
    return np.asarray(np.abs(a[..., 0] - b[..., 0]) + across)


def _colour_difference(a: Image, b: Image) -> Plane:
    green, blue = _hunt(to_lab(np.eye(3)[1:]))
    largest = float(_hyab(green, blue)) ** Q_C
    difference, knee = _hyab(a, b) ** Q_C, P_C * largest
    beyond = P_T + (difference - knee) / (largest - knee) * (1 - P_T)
    return np.where(difference < knee, P_T / knee * difference, beyond)


def _feature_difference(a: Plane, b: Plane) -> Plane:
    edges, points = (
        np.abs(_strength(a, kernel) - _strength(b, kernel)) for kernel in _feature_kernels()
    )
    return (np.maximum(edges, points) / np.sqrt(2)) ** Q_F


def _strength(lightness: Plane, kernel: Kernel) -> Plane:
    return np.hypot(_convolved(lightness, kernel), _convolved(lightness, kernel.T))


def _convolved(plane: Plane, kernel: Kernel) -> Plane:
    # As scipy.signal.fftconvolve does, which takes a second to load; what wraps around is cut off.
    n = len(kernel)
    padded = np.pad(plane, n // 2, mode="edge")
    product = np.fft.rfft2(padded) * np.fft.rfft2(kernel[::-1, ::-1], padded.shape)
    return np.fft.irfft2(product, padded.shape)[n - 1 :, n - 1 :]


@lru_cache(maxsize=1)
def _blurs() -> list[Kernel]:
    """Of Y, Cx, Cz."""
    widest = max(b for gaussians in _CONTRAST for _, b in gaussians)
    radius = int(np.ceil(3 * np.sqrt(widest / (2 * np.pi**2)) * PIXELS_PER_DEGREE))
    squares = _squares(radius) / PIXELS_PER_DEGREE**2
    sums = (
        np.sum([a * np.sqrt(np.pi / b) * np.exp(-(np.pi**2) * squares / b) for a, b in gaussians], axis=0)
        for gaussians in _CONTRAST
    )  # fmt: skip
    return [kernel / kernel.sum() for kernel in sums]


@lru_cache(maxsize=1)
def _feature_kernels() -> list[Kernel]:
    """Of edges and of points, along x; what is positive sums to 1, and what is negative to -1."""
    width = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE
    radius = int(np.ceil(3 * width))
    x = np.arange(-radius, radius + 1.0)
    gaussian = np.exp(-_squares(radius) / (2 * width**2))
    kernels = (-x * gaussian, (x**2 / width**2 - 1) * gaussian)
    return [
        np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())
        for kernel in kernels
    ]


def _squares(radius: int) -> Kernel:
    x = np.arange(-radius, radius + 1.0)
    return x**2 + x[:, None] ** 2
