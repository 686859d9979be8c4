"""Colour of spectra: white is white, the primaries are in their places, Mitsuba's observer and illuminant agree."""

import tracemalloc

import numpy as np
from numpy.testing import assert_allclose

from halfway.formats.spectra import WAVELENGTHS, rgb_weights, smooth_primaries


def test_a_white_spectrum_is_white():
    assert_allclose(rgb_weights(np.linspace(360, 1000, 40)).sum(axis=1), 1, rtol=1e-12)


def test_reflectances_are_linear_between_wavelengths_and_constant_beyond():
    """Each weight is what a hat function of height 1 reflects."""
    wavelengths = np.array([420.0, 500, 530, 700])
    fine = np.arange(380.0, 781)
    hats = np.stack([np.interp(fine, wavelengths, row) for row in np.eye(4)])
    assert_allclose(rgb_weights(wavelengths), rgb_weights(fine) @ hats.T, atol=1e-12)


def test_many_wavelengths_take_little_memory():
    tracemalloc.start()
    weights = rgb_weights(np.linspace(300, 900, 20_000))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert weights.shape == (3, 20_000)
    assert most < 10_000_000


def test_spectral_colours_point_to_their_primaries():
    red, green, blue = rgb_weights(np.array([450.0, 540.0, 620.0])).T[::-1]
    assert [red.argmax(), green.argmax(), blue.argmax()] == [0, 1, 2]


def test_the_weights_are_those_of_the_observer_under_d65(mitsuba_spectral):
    """Mitsuba holds both tables every 5 nm, ours every 10: smooth spectra agree to a thousandth."""
    mi = mitsuba_spectral
    nm = np.arange(360, 831.0)
    observer = np.array([list(mi.cie1931_xyz(w)) for w in nm])
    weight = observer * np.array([mi.cie_d65(w) for w in nm])[:, None]
    primaries = (
        np.array(mi.xyz_to_srgb(mi.Color3f(1, 0, 0))),
        np.array(mi.xyz_to_srgb(mi.Color3f(0, 1, 0))),
        np.array(mi.xyz_to_srgb(mi.Color3f(0, 0, 1))),
    )
    wavelengths = np.arange(380, 781, 20.0)
    reflectance = 0.5 + 0.4 * np.sin(wavelengths / 60)
    expected = (
        np.stack(primaries, axis=1).reshape(3, 3)
        @ (np.interp(nm, wavelengths, reflectance) @ weight)
        / weight[:, 1].sum()
    )
    assert_allclose(rgb_weights(wavelengths) @ reflectance, expected, atol=1e-3)


def test_smooth_primaries_are_reflectances_that_sum_to_1():
    primaries = smooth_primaries(WAVELENGTHS)
    assert primaries.min() >= 0
    assert_allclose(primaries.sum(axis=1), 1, atol=1e-5)
    assert_allclose(rgb_weights(WAVELENGTHS) @ primaries, np.eye(3), atol=1e-4)
