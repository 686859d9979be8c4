"""Anisotropic tables as Mitsuba BSDFs, against Mitsuba's own rough conductor, of which they are made."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from roughconductor import anisotropic, dr, f_r, mi, plugin, table

from halfway.brdf import TabularBrdf, directional_albedo
from halfway.errors import RenderError
from halfway.formats import write_rgl
from halfway.formats.rgl_writer import RESOLUTIONS
from halfway.halfdiff import Grid
from halfway.render import Renderer, studio
from halfway.render.bsdf import TableBsdf

ROUGHNESSES = [(0.05, 0.3), (0.2, 0.4)]
VIEWS = [(0, 0), (30, 0), (30, 50), (60, 120), (75, 250)]
"""theta_o and phi_o in degrees."""


def in_mitsuba(brdf: TabularBrdf, turn_degrees: float = 0.0) -> TableBsdf:
    props = mi.Properties()
    props["turn"] = turn_degrees
    return TableBsdf(props, brdf)


@cache
def conductor(alphas: tuple[float, float], turn_degrees: float) -> TableBsdf:
    return in_mitsuba(anisotropic(*alphas), turn_degrees)


def direction(view: tuple[float, float]) -> np.ndarray:
    theta, phi = np.radians(view)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def seen_from(view: tuple[float, float], n: int = 1):
    si = dr.zeros(mi.SurfaceInteraction3f, n)
    si.wi = mi.Vector3f(direction(view).tolist())
    return si


def pairs(n: int) -> tuple[np.ndarray, np.ndarray]:
    v = np.random.default_rng(1).normal(size=(2, n, 3))
    v[..., 2] = np.abs(v[..., 2]) + 1e-3
    wi, wo = v / np.linalg.norm(v, axis=-1, keepdims=True)
    return wi, wo


def psnr(found: np.ndarray, expected: np.ndarray) -> float:
    """In decibels, of linear pictures with white at 1."""
    found, expected = (np.clip(picture, 0, 1) for picture in (found, expected))
    return -10 * np.log10(np.mean((found - expected) ** 2))


def about_normal(v: np.ndarray, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return v @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


@pytest.mark.parametrize("period", [2 * np.pi, np.pi])
def test_values_are_those_of_the_table_and_nothing_unmeasured_blends_in(period):
    grid = Grid.anisotropic(5, 6, 4, 6, period=period)
    rng = np.random.default_rng(3)
    values = 1 + rng.random((3, *grid.shape)).astype(np.float32)
    values[:, rng.random(grid.shape) < 0.3] = np.nan
    brdf = TabularBrdf(values, grid)
    wi, wo = pairs(20_000)
    expected = np.nan_to_num(brdf.eval(wi, wo))
    # Positions are known to some 1e-6 cells; a cell that stands alone takes over within as little of its corner.
    error = np.abs(f_r(in_mitsuba(brdf), wi, wo) - expected)
    assert np.quantile(error, 0.999) < 1e-4


def test_a_table_says_that_it_is_anisotropic():
    flat = TabularBrdf(np.ones((3, 2, 2, 2), np.float32), Grid.merl(2, 2, 2))
    lifted = TabularBrdf(np.ones((3, 2, 2, 2, 2), np.float32), Grid.anisotropic(2, 2, 2, 2))
    flags = [in_mitsuba(brdf).flags() for brdf in (flat, lifted)]
    assert [mi.has_flag(flag, mi.BSDFFlags.Anisotropic) for flag in flags] == [False, True]


def test_values_in_a_dict_make_an_anisotropic_table():
    grid = Grid.anisotropic(4, 6, 3, 4)
    values = np.random.default_rng(0).random((3, *grid.shape)).astype(np.float32)
    tensor = mi.TensorXf(values)
    bsdf = mi.load_dict({"type": "halfway_table", "values": tensor, "turn": 20.0})
    wi, wo = pairs(100)
    expected = f_r(in_mitsuba(TabularBrdf(values, grid), 20.0), wi, wo)
    assert_allclose(f_r(bsdf, wi, wo), expected, rtol=1e-6)


@pytest.mark.parametrize("alphas", ROUGHNESSES, ids=str)
def test_turning_the_material_turns_light_and_viewer_with_it(alphas):
    wi, wo = pairs(2_000)
    still, turned = (conductor(alphas, turn) for turn in (0.0, 37.0))
    expected = f_r(still, wi, wo)
    found = f_r(turned, about_normal(wi, 37), about_normal(wo, 37))
    assert_allclose(found, expected, rtol=1e-3, atol=1e-4 * expected.mean())
    assert np.abs(f_r(turned, wi, wo) - expected).mean() > 0.2 * expected.mean()


@pytest.mark.parametrize("view", VIEWS, ids=str)
@pytest.mark.parametrize("alphas", ROUGHNESSES, ids=str)
@pytest.mark.parametrize("turn", [0.0, 37.0])
def test_samples_follow_their_density(alphas, view, turn, tmp_path, monkeypatch):
    """Mitsuba's chi-square test."""
    monkeypatch.chdir(tmp_path)  # where a failing test leaves its density
    bsdf, ctx = conductor(alphas, turn), mi.BSDFContext()

    def sample(u):
        bs, _ = bsdf.sample(ctx, seen_from(view, dr.width(u)), u[0], mi.Point2f(u[1], u[2]))
        return bs.wo, dr.select(bs.pdf > 0, mi.Float(1), 0)

    test = mi.chi2.ChiSquareTest(
        domain=mi.chi2.SphericalDomain(),
        sample_func=sample,
        pdf_func=lambda wo: bsdf.pdf(ctx, seen_from(view, dr.width(wo)), wo),
        sample_dim=3,
        sample_count=200_000,
        res=65,
        ires=32,
    )
    assert test.run(), test.messages


@pytest.mark.parametrize("view", VIEWS, ids=str)
@pytest.mark.parametrize("alphas", ROUGHNESSES, ids=str)
def test_weights_vary_little_and_their_mean_is_the_albedo(alphas, view):
    brdf = anisotropic(*alphas)
    sampler = mi.load_dict({"type": "independent"})
    n = 100_000
    sampler.seed(7, n)
    args = seen_from(view, n), sampler.next_1d(), sampler.next_2d()
    _, weight = conductor(alphas, 0.0).sample(mi.BSDFContext(), *args)
    weight = np.array(weight).T
    theta, phi = view

    def turned(wi, wo):
        return brdf.eval(about_normal(wi, phi), about_normal(wo, phi))

    expected = directional_albedo(turned, np.radians(theta), n_theta_h=180, n_phi_h=180)
    error = 3 * weight.std(axis=0) / np.sqrt(n)
    assert (np.abs(weight.mean(axis=0) - expected) < error + 0.004 * expected).all()
    assert weight.mean(axis=1).std() < 0.15 * weight.mean()


@pytest.mark.parametrize("alphas", ROUGHNESSES, ids=str)
def test_a_lit_sphere_is_that_of_the_model(alphas):
    """One point light: no noise but that of edges."""
    renderer = Renderer("sphere", size=(96, 96), spp=16)
    expected = renderer.picture(plugin(*alphas))
    assert psnr(renderer.picture(anisotropic(*alphas)), expected) > 40
    across = renderer.picture(plugin(*alphas[::-1]))
    assert psnr(across, expected) < 30


@pytest.mark.parametrize("alphas", ROUGHNESSES, ids=str)
def test_a_lit_sphere_of_a_bsdf_file_in_stock_mitsuba_is_that_of_the_model(alphas, tmp_path):
    """The smallest file that is tried."""
    path = write_rgl(tmp_path / "x.bsdf", anisotropic(*alphas), resolution=RESOLUTIONS[0]).path
    renderer = Renderer("sphere", size=(96, 96), spp=16)
    shown = renderer.picture({"type": "measured", "filename": str(path)})
    assert psnr(shown, renderer.picture(plugin(*alphas))) > 40


@pytest.mark.parametrize("turn", [0.0, 37.0])
@pytest.mark.parametrize("alphas", ROUGHNESSES, ids=str)
def test_a_plane_in_the_studio_is_that_of_the_model_turned_with_it(alphas, turn):
    renderer = {"size": 32, "spp": 1024}
    expected = plane(mi.load_dict(plugin(*alphas)), turn, **renderer)
    found = plane(conductor(alphas, turn), 0.0, **renderer)
    assert psnr(found, expected) > 40
    if turn:
        assert psnr(plane(conductor(alphas, 0.0), 0.0, **renderer), expected) < 40


def plane(bsdf, turn_degrees: float, *, size: int, spp: int) -> np.ndarray:
    """The picture of a plane, itself turned about its normal, under the studio's light, from aside."""
    T = mi.ScalarTransform4f
    light = T().rotate([0, 0, 1], 180) @ T().rotate([1, 0, 0], 90)
    scene = mi.load_dict(
        {
            "type": "scene",
            "sensor": {
                "type": "perspective",
                "to_world": T().look_at([1.0, -3.0, 2.2], [0, 0, 0], [0, 0, 1]),
                "fov": 40,
                "sampler": {"type": "multijitter"},
                "film": {"type": "hdrfilm", "width": size, "height": size, "pixel_format": "rgb"},
            },
            "light": {"type": "envmap", "bitmap": mi.Bitmap(studio()), "to_world": light},
            "plane": {
                "type": "rectangle",
                "to_world": T().rotate([0, 0, 1], turn_degrees) @ T().scale(50),
                "bsdf": bsdf,
            },
            "integrator": {"type": "direct"},
        }
    )
    return np.array(mi.render(scene, spp=spp))


def test_an_isotropic_table_that_is_lifted_renders_the_same():
    flat = table(plugin(0.3, 0.3), Grid.merl(24, 12, 12))
    grid = Grid.anisotropic(24, 4, 12, 12)
    values = np.repeat(flat.values[:, :, None], 4, axis=2)
    renderer = Renderer("sphere", size=(48, 48), spp=16)
    expected = renderer.picture(flat)
    found = renderer.picture(TabularBrdf(values, grid))
    assert_allclose(found, expected, atol=1e-4 * expected.max())
    turned = Renderer("sphere", size=(48, 48), spp=16, turn_degrees=37.0)
    assert_allclose(turned.picture(TabularBrdf(values, grid)), expected, atol=1e-4 * expected.max())


def test_a_turn_of_no_angle_is_refused():
    with pytest.raises(RenderError, match=r"^a turn of nan degrees is none: expected -360 to 360"):
        Renderer("sphere", size=(8, 8), turn_degrees=float("nan"))
