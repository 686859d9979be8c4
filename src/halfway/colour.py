"""Colour, once: the display's transfer function, luminance, CIELAB and CIEDE2000, all of linear sRGB values (D65).

References: IEC 61966-2-1 (sRGB); CIE 15 (CIELAB); G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 Color-Difference Formula:
Implementation Notes, Supplementary Test Data, and Mathematical Observations", Color Research and Application 30(1), 2005.
"""

from string import hexdigits

import numpy as np
from jaxtyping import Float

from ._ciede2000 import differences

Rgb = Float[np.ndarray, "... 3"]
"""Linear sRGB; 1 is the display's white."""
Lab = Float[np.ndarray, "... 3"]
"""L* in [0, 100], a*, b*."""

_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
LUMINANCE = _TO_XYZ[1]
"""What R, G and B add to the luminance Y."""
# White is the display's own, so that equal R, G, B have a* = b* = 0.
_TO_RELATIVE_XYZ = _TO_XYZ / _TO_XYZ.sum(axis=1, keepdims=True)
_F_TO_LAB = np.array([[0.0, 500.0, 0.0], [116.0, -500.0, 200.0], [0.0, 0.0, -200.0]])


def to_srgb(linear: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """The display's code values, in [0, 1], of linear values clipped to [0, 1]: the sRGB transfer function."""
    v = np.clip(linear, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


def from_srgb(coded: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """Linear values of the display's code values in [0, 1]: the inverse of `to_srgb`."""
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def to_hex(linear: Rgb) -> str:
    """One colour as it is written for a display, ``#7a2a3a``; clipped to what that shows."""
    return "#" + "".join(f"{code:02x}" for code in np.round(255 * to_srgb(linear)).astype(int))


def from_hex(text: str) -> Rgb | None:
    """Linear values of a colour written as ``#7a2a3a`` or ``7a2a3a``; None where it is none."""
    digits = text.removeprefix("#")
    if len(digits) != 6 or not set(digits) <= set(hexdigits):
        return None
    return from_srgb(np.array(list(bytes.fromhex(digits))) / 255)


def to_relative_xyz(rgb: Rgb) -> Float[np.ndarray, "... 3"]:
    """X, Y and Z over those of the display's white."""
    return rgb @ _TO_RELATIVE_XYZ.T.astype(rgb.dtype)


def response(ratio: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """The f of CIELAB: a cube root with a straight foot, of X/Xn, Y/Yn or Z/Zn."""
    delta = 6 / 29
    return np.where(ratio > delta**3, np.cbrt(ratio), ratio / (3 * delta**2) + 4 / 29)


def from_response(f: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """The inverse of `response`."""
    delta = 6 / 29
    return np.where(f > delta, f**3, 3 * delta**2 * (f - 4 / 29))


def to_lab(rgb: Rgb) -> Lab:
    """CIELAB of linear sRGB values in [0, 1], in their dtype: (0, 0, 0) is black, (100, 0, 0) the display's white."""
    f = response(to_relative_xyz(rgb))
    lab = f.astype(rgb.dtype) @ _F_TO_LAB.astype(rgb.dtype)
    lab[..., 0] -= 16
    return lab


def ciede2000(a: Lab, b: Lab) -> Float[np.ndarray, "..."]:
    """Delta E_00 of pairs of colours, with kL = kC = kH = 1."""
    a, b = np.broadcast_arrays(a, b)
    first, second = (np.asarray(x, np.float64).reshape(-1, 3) for x in (a, b))
    return differences(first, second).reshape(a.shape[:-1])
