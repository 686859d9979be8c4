"""Cameras, windows, passes, the denoiser, and what the doctor says."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from halfway.brdf import TabularBrdf
from halfway.errors import RenderError
from halfway.halfdiff import Grid
from halfway.render import QUALITY, Renderer, doctor
from halfway.render.camera import camera_to_world, window
from halfway.render.denoise import denoised
from halfway.render.exposure import PASS_SAMPLES, Exposure, Layer
from halfway.render.scenes import SCENES, Camera
from halfway.render.variant import Llvm, aborting, find_llvm, require_tables

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
    flat = np.full_like(radiance, 0.5)
    layer = Layer(radiance, np.ones((64, 64, 1), np.float32), flat, flat)
    quiet = denoised(layer)
    assert quiet.shape == radiance.shape
    assert_allclose(quiet.mean(), radiance.mean(), rtol=0.03)
    assert quiet.std() < 0.2 * radiance.std()


def test_a_missing_denoiser_says_what_to_install(monkeypatch):
    monkeypatch.setattr("halfway.render.denoise.find_spec", lambda name: None)  # noqa: ARG005
    with pytest.raises(RenderError, match="pip install mitsuba-oidn"):
        Renderer("sphere", denoise=True)
    assert Renderer("sphere", size=(8, 8), spp=1).backdrop.shape == (8, 8, 3)


def test_qualities_are_options_of_a_renderer():
    for options in QUALITY.values():
        Renderer("sphere", size=(8, 8), **options)


def test_the_doctor_names_everything_and_what_its_absence_costs():
    findings = doctor()
    assert [f.what for f in findings] == ["Mitsuba", "LLVM", "variant", "denoiser", "video writer"]
    assert all(f.cost for f in findings)
    assert findings[2].found == "llvm_ad_rgb"


@pytest.mark.parametrize("variant", ["scalar_rgb", "scalar_spectral", "llvm_ad_spectral_polarized"])
def test_variants_that_cannot_look_up_tables_are_refused(variant):
    with pytest.raises(RenderError, match=variant):
        require_tables(variant)


@pytest.mark.parametrize(("version", "aborts"), [(15, True), (16, True), (19, False), (23, False)])
def test_an_llvm_that_aborts_is_seen_among_what_is_loaded(version, aborts):
    """So that Mitsuba, imported before, gets an error and not a process that dies at the first render."""
    line = f"7f00-7f01 r-xp 00000000 00:00 1    /usr/lib/x86_64-linux-gnu/libLLVM-{version}.so.1"
    found = aborting(["7f00-7f01 rw-p 00000000 00:00 0 ", line])
    assert (found is not None) == aborts


def test_an_llvm_that_aborts_is_not_chosen(tmp_path):
    assert not Llvm(Path("libLLVM-15.so"), 15, "system").works
    assert not Llvm(Path("libLLVM.so"), None, "system").works
    assert Llvm(Path("libLLVM-19.so"), 19, "system").works
    assert Llvm(tmp_path, 15, "set by the user").works


@pytest.mark.skipif(sys.platform != "linux", reason="the LLVM of the environment is for Linux")
def test_the_llvm_of_the_environment_is_found(monkeypatch):
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH", raising=False)
    llvm = find_llvm()
    assert llvm is not None
    assert llvm.path.is_file()
    assert llvm.version is not None
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", "/somewhere/libLLVM-20.so")
    chosen = find_llvm()
    assert chosen is not None
    assert (str(chosen.path), chosen.version) == ("/somewhere/libLLVM-20.so", 20)


def test_without_llvm_a_file_stands_for_the_table(tmp_path):
    """In a process of its own, as a variant is set once. A Lambertian sphere looks the same either way."""
    trial = f"""
import numpy as np
from halfway.render import Renderer, variant
variant.find_llvm = lambda: None
from halfway.brdf import TabularBrdf
from halfway.halfdiff import Grid
grid = Grid.merl(4, 4, 8)
renderer = Renderer("sphere", size=(24, 24), spp=4)
picture = renderer.picture(TabularBrdf(np.full((3, *grid.shape), 0.2, np.float32), grid))
import mitsuba
print(mitsuba.variant(), renderer.exact)
np.save({str(tmp_path / "picture.npy")!r}, picture)
"""
    done = subprocess.run([sys.executable, "-c", trial], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["scalar_rgb", "False"]
    exact = Renderer("sphere", size=(24, 24), spp=4)
    assert exact.exact
    inside = (
        slice(6, 18),
        slice(6, 18),
    )  # at the edge pixels are only partly covered, by other samples
    picture = np.load(tmp_path / "picture.npy")
    assert_allclose(picture[inside], exact.picture(GREY)[inside], atol=0.05)
