"""Cameras, windows, passes, the denoiser."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from halfway.brdf import TabularBrdf
from halfway.errors import RenderError
from halfway.halfdiff import Grid
from halfway.render import Renderer
from halfway.render.camera import COARSE, Window, camera_to_world, coarse, refined, window
from halfway.render.denoise import denoised
from halfway.render.exposure import PASS_SAMPLES, Exposure, Layer
from halfway.render.scenes import SCENES, Camera

GRID = Grid.merl(4, 4, 8)
GREY = TabularBrdf(np.full((3, *GRID.shape), 0.2, np.float32), GRID)
CAMERA = Camera((0.0, -10.0, 0.0), (0.0, 0.0, 0.0), 2 * np.degrees(np.arctan(0.1)))


def test_the_camera_looks_at_its_target_with_z_up():
    matrix = camera_to_world(SCENES["teapot"].camera)
    assert_allclose(matrix[:3, :3].T @ matrix[:3, :3], np.eye(3), atol=1e-12)
    assert matrix[0, 0] < 0  # its x is the left of the picture
    assert matrix[2, 1] > 0
    assert_allclose(matrix[:3, 3], SCENES["teapot"].camera.at)


def test_the_window_of_known_points():
    """At distance 10 this camera must see a square of side 2."""
    points = np.array([[-0.5, 0, -0.25], [0.5, 0, 0.25]])
    assert window(CAMERA, (200, 100), points, margin=0) == (75, 37, 50, 26)
    assert window(CAMERA, (100, 200), points, margin=0) == (25, 87, 50, 26)


def test_a_window_stays_in_the_frame_and_is_never_empty():
    far = np.array([[50.0, 0, 0], [60.0, 0, 0]])
    x, y, width, height = window(CAMERA, (64, 64), far)
    assert width > 0 < height
    assert x + width <= 64 >= y + height
    behind = np.array([[0, -20.0, 0], [0, 0, 0]])
    assert window(CAMERA, (64, 48), behind) == (0, 0, 64, 48)


@given(spp=st.integers(1, 65536), n_pixels=st.integers(1, 8192**2), seed=st.integers(0, 2**32 - 1))
def test_passes_take_as_many_samples_as_asked_and_fit_in_memory(spp, n_pixels, seed):
    passes = Exposure(spp, seed).passes(n_pixels)
    assert spp <= passes.spp * len(passes.seeds)
    # One sample a pixel is the least; rounding up to a grid adds less than one row of it.
    side = int(passes.spp**0.5)
    assert (passes.spp - side - 1) * n_pixels <= PASS_SAMPLES or passes.spp == 1
    assert passes.seeds[0] == seed
    assert len(set(passes.seeds)) == len(passes.seeds)


def test_a_picture_in_passes_is_the_picture(monkeypatch):
    whole = Renderer("sphere", size=(24, 24), spp=64).picture(GREY)
    monkeypatch.setattr("halfway.render.exposure.PASS_SAMPLES", 24 * 24 * 16)
    done: list[tuple[int, int]] = []
    renderer = Renderer("sphere", size=(24, 24), spp=64)
    parts = renderer.picture(GREY, progress=lambda i, n: done.append((i, n)))
    assert done[-1] == (len(done), len(done))
    assert len(done) > 1
    assert_allclose(parts.mean(), whole.mean(), rtol=0.01)


def test_denoising_takes_the_noise_and_leaves_the_light():
    pytest.importorskip("mitsuba_oidn", reason="the denoiser has no wheel for this platform")
    noise = np.random.default_rng(0).gamma(4, 0.25, (64, 64, 1)).astype(np.float32)
    radiance = np.repeat(noise, 3, axis=-1)
    quiet = denoised(radiance)
    assert quiet.shape == radiance.shape
    assert_allclose(quiet.mean(), radiance.mean(), rtol=0.03)
    assert quiet.std() < 0.2 * radiance.std()


def test_a_layer_covers_what_is_behind_it_in_its_window():
    light = np.full((2, 2, 3), 0.6, np.float32)
    layer = Layer(Window(1, 0, 2, 2), light, np.full((2, 2, 1), 0.25, np.float32))
    picture = layer.over(np.full((3, 4, 3), 0.8, np.float32))
    assert_allclose(picture[:2, 1:3], 0.6 + 0.75 * 0.8)
    assert_allclose(picture[2], 0.8)
    assert_allclose(picture[:, [0, 3]], 0.8)


@pytest.mark.parametrize("size", [(64, 48), (63, 47), (5, 4)])
def test_a_coarse_picture_grows_about_its_middle(size):
    """A ramp of one unit a pixel, 0 in the middle, is that ramp again, but for the border that nothing lies beyond."""
    width, height = coarse(size)
    x = COARSE * (np.arange(width) - (width - 1) / 2)
    ramp = np.broadcast_to(x[None, :, None], (height, width, 3)).astype(np.float32)
    fine = refined(ramp, size)
    assert fine.shape == (size[1], size[0], 3)
    expected = np.arange(size[0]) - (size[0] - 1) / 2
    assert_allclose(fine[0, 1:-1, 0], expected[1:-1], atol=1e-5)
    assert refined(fine, size) is fine


def test_a_missing_denoiser_says_what_to_install(monkeypatch):
    monkeypatch.setattr("halfway.render.denoise.find_spec", lambda name: None)  # noqa: ARG005
    with pytest.raises(RenderError, match="pip install mitsuba-oidn"):
        Renderer("sphere", denoise=True)
    assert Renderer("sphere", size=(8, 8), spp=1).backdrop.shape == (8, 8, 3)
