"""The table as a Mitsuba BSDF: the same values as numpy, and a sampler that matches its density."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway.brdf import IsotropicModel, TabularBrdf, directional_albedo, tabulate
from halfway.halfdiff import MERL, Grid
from halfway.render import register

register()

import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402

from halfway.render import bsdf as bsdf_module  # noqa: E402
from halfway.render.sampling import buffer  # noqa: E402

VIEWS = (0, 20, 45, 70, 85)


class Glossy(IsotropicModel):
    """Lambert and a GGX lobe: F. Walter et al., EGSR 2007, equations 20, 33 and 34."""

    def __init__(self, roughness: float, diffuse: tuple, specular: float) -> None:
        self.alpha2 = roughness**2
        self.diffuse = np.array(diffuse)
        self.specular = specular

    def at(self, theta_h, theta_d, phi_d, cos_i, cos_o):  # noqa: ARG002
        c2 = np.cos(theta_h) ** 2
        D = self.alpha2 / (np.pi * (c2 * (self.alpha2 - 1) + 1) ** 2)
        F = 0.04 + 0.96 * (1 - np.cos(theta_d)) ** 5
        lobe = self.specular * D * F * self.g1(cos_i) * self.g1(cos_o) / (4 * cos_i * cos_o)
        return self.diffuse.reshape(3, *[1] * np.ndim(lobe)) / np.pi + lobe

    def g1(self, c):
        return 2 * c / (c + np.sqrt(self.alpha2 + (1 - self.alpha2) * c * c))


MATTE = tabulate(Glossy(0.6, (0.6, 0.4, 0.2), 0.5), MERL, name="matte")
PLASTIC = tabulate(Glossy(0.1, (0.5, 0.3, 0.2), 1.0), MERL, name="plastic")
METAL = tabulate(Glossy(0.2, (0.0, 0.0, 0.0), 12.0), MERL, name="metal")
MIRROR = tabulate(Glossy(0.03, (0.0, 0.0, 0.0), 12.0), MERL, name="mirror")
BLACK = TabularBrdf(np.zeros((3, 4, 4, 8), np.float32), Grid.merl(4, 4, 8), name="black")


def in_mitsuba(brdf: TabularBrdf):
    return bsdf_module.TableBsdf(mi.Properties(), brdf)


def seen_from(degrees: float, n: int = 1):
    theta = float(np.radians(degrees))
    si = dr.zeros(mi.SurfaceInteraction3f, n)
    # Off the x axis: phi = pi is the seam of the chi-square test's domain.
    si.wi = mi.Vector3f(0, float(np.sin(theta)), float(np.cos(theta)))
    return si


def samples(bsdf, degrees: float, n: int = 100_000):
    """Weights (n, 3) of samples for a view angle."""
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(7, n)
    _, weight = bsdf.sample(
        mi.BSDFContext(), seen_from(degrees, n), sampler.next_1d(), sampler.next_2d()
    )
    return np.array(weight).T


def pairs(n: int) -> tuple[np.ndarray, np.ndarray]:
    v = np.random.default_rng(1).normal(size=(2, n, 3))
    v[..., 2] = np.abs(v[..., 2])
    wi, wo = (v / np.linalg.norm(v, axis=-1, keepdims=True)).astype(np.float32)
    return wi, wo


def evaluated(bsdf, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """f_r cos(theta_i) as Mitsuba's ``eval`` gives it."""
    si = dr.zeros(mi.SurfaceInteraction3f, len(wi))
    si.wi = mi.Vector3f(*map(buffer, wo.T))
    return np.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*map(buffer, wi.T)))).T


@pytest.mark.parametrize("brdf", [MATTE, PLASTIC, METAL], ids=lambda b: b.name)
def test_values_are_those_of_the_table(brdf):
    wi, wo = pairs(100_000)
    expected = brdf.eval(wi.astype(float), wo.astype(float)) * wi[:, 2:]
    known = np.isfinite(expected)
    got = evaluated(in_mitsuba(brdf), wi, wo)
    error = np.abs(got - expected)[known] / np.abs(expected)[known]
    assert np.quantile(error, 0.999) < 1e-5
    # A position is known to 4 units in the last place of 180, 6e-5 cells; two neighbours differ by half at most here.
    assert error.max() < 3e-5
    assert_allclose(got[~known], 0)


def test_unmeasured_samples_never_blend_into_a_value():
    grid = Grid.merl(6, 5, 8)
    values = np.full((3, *grid.shape), 2.0, np.float32)
    values[:, np.random.default_rng(0).random(grid.shape) < 0.4] = np.nan
    values[1] *= 3
    brdf = TabularBrdf(values, grid)
    wi, wo = pairs(5_000)
    expected = np.nan_to_num(brdf.eval(wi.astype(float), wo.astype(float))) * wi[:, 2:]
    assert_allclose(evaluated(in_mitsuba(brdf), wi, wo), expected, rtol=1e-5)


def test_channels_may_miss_different_samples():
    grid = Grid.merl(5, 5, 6)
    rng = np.random.default_rng(3)
    values = rng.random((3, *grid.shape)).astype(np.float32)
    values[rng.random(values.shape) < 0.2] = np.nan
    brdf = TabularBrdf(values, grid)
    wi, wo = pairs(2_000)
    expected = np.nan_to_num(brdf.eval(wi.astype(float), wo.astype(float))) * wi[:, 2:]
    assert_allclose(evaluated(in_mitsuba(brdf), wi, wo), expected, rtol=1e-4, atol=1e-5)


def test_a_direction_below_the_horizon_reflects_nothing():
    bsdf, ctx = in_mitsuba(MATTE), mi.BSDFContext()
    below = mi.Vector3f(0.6, 0.0, -0.8)
    assert_allclose(np.array(bsdf.eval(ctx, seen_from(20), below)), 0)
    assert_allclose(np.array(bsdf.pdf(ctx, seen_from(20), below)), 0)
    assert_allclose(np.array(bsdf.eval(ctx, seen_from(120), mi.Vector3f(0, 0, 1))), 0)


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("brdf", [MATTE, PLASTIC, METAL, MIRROR, BLACK], ids=lambda b: b.name)
def test_samples_follow_their_density(brdf, view, tmp_path, monkeypatch):
    """Mitsuba's chi-square test. A black table has no weights to keep, so its samples are taken as they are."""
    monkeypatch.chdir(tmp_path)  # where a failing test leaves its density
    bsdf = in_mitsuba(brdf)
    ctx = mi.BSDFContext()

    def sample(u):
        si = seen_from(view, dr.width(u))
        bs, _ = bsdf.sample(ctx, si, u[0], mi.Point2f(u[1], u[2]))
        return bs.wo, dr.select(bs.pdf > 0, mi.Float(1), 0)

    def density(wo):
        return bsdf.pdf(ctx, seen_from(view, dr.width(wo)), wo)

    test = mi.chi2.ChiSquareTest(
        domain=mi.chi2.SphericalDomain(),
        sample_func=sample,
        pdf_func=density,
        sample_dim=3,
        sample_count=200_000,
        res=65,
        ires=128 if brdf is MIRROR else 16,
    )
    assert test.run(), test.messages


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("brdf", [MATTE, PLASTIC, METAL, MIRROR], ids=lambda b: b.name)
def test_the_mean_weight_is_the_directional_albedo(brdf, view):
    """White furnace: light from everywhere comes back as the albedo says."""
    weights = samples(in_mitsuba(brdf), view)
    expected = directional_albedo(brdf, np.radians(view), n_theta_h=720, n_phi_h=180)
    # Three standard errors, and the quadrature of a lobe of one cell.
    assert_allclose(weights.mean(axis=0), expected, rtol=0.004)


@pytest.mark.parametrize(
    ("brdf", "most"), [(MATTE, 0.1), (PLASTIC, 0.1), (METAL, 0.2), (MIRROR, 0.25)], ids=str
)
def test_weights_vary_little(brdf, most):
    """The deviation of the sample weights, of the mean of the channels."""
    for view in VIEWS:
        weights = samples(in_mitsuba(brdf), view).mean(axis=1)
        assert weights.std() / weights.mean() < most


def test_a_new_table_needs_no_new_kernel():
    bsdf = in_mitsuba(MATTE)
    wi, wo = pairs(1_000)
    evaluated(bsdf, wi, wo)
    samples(bsdf, 45)
    parameters = mi.traverse(bsdf)
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        dr.kernel_history_clear()
        for brdf in (PLASTIC, MIRROR, METAL):
            parameters["table"] = bsdf_module.pack(brdf)
            parameters.update()
            got = evaluated(bsdf, wi, wo)
            weights = samples(bsdf, 45)
        compiled = [kernel for kernel in dr.kernel_history() if not kernel.get("cache_hit", 1)]
    assert not compiled
    assert_allclose(got, evaluated(in_mitsuba(METAL), wi, wo))
    assert_allclose(weights, samples(in_mitsuba(METAL), 45))


def test_a_table_of_another_size_is_refused():
    parameters = mi.traverse(in_mitsuba(BLACK))
    parameters["table"] = mi.Float(np.zeros(12))
    with pytest.raises(Exception, match="12 floats: a 4 x 4 x 8 grid takes 512"):
        parameters.update()
