"""Colour of spectra: reflectance at some wavelengths to linear RGB, and back.

    X_k = integral of r(lambda) S(lambda) c_k(lambda) / integral of S(lambda) c_Y(lambda)      c = x-bar, y-bar, z-bar
    RGB = M (X, Y, Z)

The observer c is the CIE 1931 standard observer (2 degrees), the illuminant S is D65, M leads to the primaries of
sRGB (ITU-R BT.709), whose white is D65: a reflectance of 1 at all wavelengths is (1, 1, 1) exactly, because the
weights are scaled to make it so. The reflectance is taken linear between its wavelengths and constant beyond them.

Sources: CIE 015:2018, Colorimetry, tables of the 1931 observer and of D65 (here every 10 nm; in
between, a cubic spline through the observer and lines through D65, whose table is meant so);
IEC 61966-2-1:1999 for the primaries.
"""

import numpy as np

ILLUMINANT = "D65"

WAVELENGTHS = np.arange(380.0, 781, 20)
"""nm, where a spectrum made of RGB is sampled."""

# nm, S, x-bar, y-bar, z-bar
_CIE: np.ndarray = np.array([
    [380, 49.9755, 0.001368, 0.000039, 0.006450],
    [390, 54.6482, 0.004243, 0.000120, 0.020050],
    [400, 82.7549, 0.014310, 0.000396, 0.067850],
    [410, 91.4860, 0.043510, 0.001210, 0.207400],
    [420, 93.4318, 0.134380, 0.004000, 0.645600],
    [430, 86.6823, 0.283900, 0.011600, 1.385600],
    [440, 104.865, 0.348280, 0.023000, 1.747060],
    [450, 117.008, 0.336200, 0.038000, 1.772110],
    [460, 117.812, 0.290800, 0.060000, 1.669200],
    [470, 114.861, 0.195360, 0.090980, 1.287640],
    [480, 115.923, 0.095640, 0.139020, 0.812950],
    [490, 108.811, 0.032010, 0.208020, 0.465180],
    [500, 109.354, 0.004900, 0.323000, 0.272000],
    [510, 107.802, 0.009300, 0.503000, 0.158200],
    [520, 104.790, 0.063270, 0.710000, 0.078250],
    [530, 107.689, 0.165500, 0.862000, 0.042160],
    [540, 104.405, 0.290400, 0.954000, 0.020300],
    [550, 104.046, 0.433450, 0.994950, 0.008750],
    [560, 100.000, 0.594500, 0.995000, 0.003900],
    [570, 96.3342, 0.762100, 0.952000, 0.002100],
    [580, 95.7880, 0.916300, 0.870000, 0.001650],
    [590, 88.6856, 1.026300, 0.757000, 0.001100],
    [600, 90.0062, 1.062200, 0.631000, 0.000800],
    [610, 89.5991, 1.002600, 0.503000, 0.000340],
    [620, 87.6987, 0.854450, 0.381000, 0.000190],
    [630, 83.2886, 0.642400, 0.265000, 0.000050],
    [640, 83.6992, 0.447900, 0.175000, 0.000020],
    [650, 80.0268, 0.283500, 0.107000, 0.000000],
    [660, 80.2146, 0.164900, 0.061000, 0.000000],
    [670, 82.2778, 0.087400, 0.032000, 0.000000],
    [680, 78.2842, 0.046770, 0.017000, 0.000000],
    [690, 69.7213, 0.022700, 0.008210, 0.000000],
    [700, 71.6091, 0.011359, 0.004102, 0.000000],
    [710, 74.3490, 0.005790, 0.002091, 0.000000],
    [720, 61.6040, 0.002899, 0.001047, 0.000000],
    [730, 69.8856, 0.001440, 0.000520, 0.000000],
    [740, 75.0870, 0.000690, 0.000249, 0.000000],
    [750, 63.5927, 0.000332, 0.000120, 0.000000],
    [760, 46.4182, 0.000166, 0.000060, 0.000000],
    [770, 66.8054, 0.000083, 0.000030, 0.000000],
    [780, 63.3828, 0.000042, 0.000015, 0.000000],
])  # fmt: skip

_XYZ_TO_RGB = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)

_STRICTNESS = 1e3
"""Weight of what the primaries must fulfil against their smoothness."""


def rgb_weights(wavelengths: np.ndarray) -> np.ndarray:
    """The matrix, shape (3, n), that takes reflectances at ascending ``wavelengths`` (nm) to linear RGB."""
    # Here, because scipy takes long to load and most files hold RGB.
    from scipy.interpolate import CubicSpline

    steps = np.arange(_CIE[0, 0], _CIE[-1, 0] + 1)
    illuminant = np.interp(steps, _CIE[:, 0], _CIE[:, 1])
    observer = CubicSpline(_CIE[:, 0], _CIE[:, 2:])(steps)
    # What lies between two wavelengths counts for both, by its distance. No matrix: a file may list any number.
    n = len(wavelengths)
    position = np.interp(steps, wavelengths, np.arange(n))
    below = position.astype(np.intp)
    share = (position - below)[:, None]
    xyz = np.zeros((n, 3))
    np.add.at(xyz, below, (1 - share) * illuminant[:, None] * observer)
    np.add.at(xyz, np.minimum(below + 1, n - 1), share * illuminant[:, None] * observer)
    weights = _XYZ_TO_RGB @ xyz.T
    return weights / weights.sum(axis=1, keepdims=True)


def smooth_primaries(wavelengths: np.ndarray) -> np.ndarray:
    """The reflectances at ``wavelengths`` (nm) of the RGB primaries, shape (n, 3): smooth, in [0, 1], summing to 1.

    ``primaries @ rgb`` is a spectrum of that colour: `rgb_weights` leads back to it, and a mix of colours has the mix
    of their spectra. Among all such primaries these change least from one wavelength to the next (least squares).

    Source: I. Mallett, C. Yuksel, "Spectral Primary Decomposition for Rendering with sRGB Reflectance", EGSR 2019.
    """
    from scipy.optimize import lsq_linear

    n = len(wavelengths)
    weights = rgb_weights(wavelengths)
    changes = np.kron(np.eye(3), np.diff(np.eye(n), axis=0))
    colours = np.kron(np.eye(3), weights)
    sums = np.kron(np.ones((1, 3)), np.eye(n))
    constraints, targets = np.vstack([colours, sums]), np.append(np.eye(3), np.ones(n))
    solution = lsq_linear(
        np.vstack([changes, _STRICTNESS * constraints]),
        np.append(np.zeros(len(changes)), _STRICTNESS * targets),
        bounds=(0, 1),
        method="bvls",
    )
    primaries = solution.x.reshape(3, n).T
    # What the penalty left over; since weights and primaries sum to 1, the sums stay as they are.
    return np.clip(primaries @ np.linalg.inv(weights @ primaries), 0, 1)
