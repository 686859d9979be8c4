"""Analytic models: their values against references, and fits that find what is known."""

import json
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import directions

from halfway.brdf import IsotropicModel, TabularBrdf, directional_albedo, quadrature, tabulate
from halfway.brdf.quality import Quality
from halfway.errors import FormatError, HalfwayError
from halfway.fit import MODELS, Fit, Gltf, OpenPbr, Principled, fit
from halfway.fit.cycles import Cycles
from halfway.fit.metric import comparison_pairs
from halfway.fit.microfacet import Azimuths, Widths, ggx
from halfway.fit.openpbr import eon
from halfway.halfdiff import Grid, turn
from halfway.models import builtin

GRID = Grid.merl(90, 30, 36)
ANGLES = np.radians([0, 20, 45, 70, 80])
ABC = builtin("merl-abc").models


@cache
def fitted(name: str, model: str) -> Fit:
    return fit(ABC[name], model, name=name)


KNOWN = {
    "plastic": Principled([0.1, 0.3, 0.6], roughness=0.3, specular=0.6),
    "metal": Principled([0.9, 0.7, 0.3], roughness=0.2, metallic=1.0),
    "cloth": Principled([0.5, 0.2, 0.1], roughness=0.9, sheen=0.5, flatness=0.6),
    "lacquer": Principled([0.4, 0.1, 0.1], roughness=0.6, clearcoat=0.9, clearcoat_gloss=0.6),
    "tinted": Principled([0.6, 0.3, 0.1], metallic=0.3, spec_tint=0.7, sheen=0.4, sheen_tint=0.8),
    "brushed": Principled([0.9, 0.7, 0.3], roughness=0.4, metallic=1.0, anisotropic=0.7),
    "no index": Principled([0.9, 0.5, 0.2], roughness=0.3, metallic=0.5, specular=0.0),
}


@pytest.mark.parametrize("name", KNOWN)
def test_principled_is_mitsubas(name):
    from halfway.render import register
    from halfway.render.fits import to_plugin

    register()
    import drjit as dr
    import mitsuba as mi

    v = np.random.default_rng(1).normal(size=(2, 5_000, 3))
    v[..., 2] = np.abs(v[..., 2])
    wi, wo = (v / np.linalg.norm(v, axis=-1, keepdims=True)).astype(np.float32)
    si = dr.zeros(mi.SurfaceInteraction3f, len(wi))
    si.wi, light = (mi.Vector3f(*(mi.Float(np.array(x)) for x in w.T)) for w in (wo, wi))
    plugin = mi.load_dict(to_plugin(KNOWN[name]))
    got = np.array(plugin.eval(mi.BSDFContext(), si, light)).T
    expected = KNOWN[name].eval(wi.astype(float), wo.astype(float)) * wi[:, 2:]
    # Float32 against float64: Mitsuba's GGX loses digits at the peak.
    assert_allclose(got, expected, rtol=1e-4, atol=1e-7)


def gltf_by_the_book(model: Gltf, wi, wo) -> np.ndarray:
    """Appendix B.3 of glTF 2.0 and the extensions, one pair at a time, in their own symbols."""

    def stretched_brdf():
        c, s = np.cos(model.anisotropy_rotation), np.sin(model.anisotropy_rotation)
        t, b = np.array([c, s, 0]), np.array([-s, c, 0])
        ab = model.roughness**2
        at = ab + (1 - ab) * model.anisotropy_strength**2
        a2 = at * ab
        f = np.array([ab * (t @ H), at * (b @ H), a2 * NdotH])
        D = a2 * (a2 / (f @ f)) ** 2 / np.pi
        ggxv = NdotL * np.linalg.norm([at * (t @ wo), ab * (b @ wo), NdotV])
        ggxl = NdotV * np.linalg.norm([at * (t @ wi), ab * (b @ wi), NdotL])
        return D * 0.5 / (ggxv + ggxl)

    def specular_brdf(alpha):
        chi = 1.0 if NdotH > 0 else 0.0
        D = alpha**2 * chi / (np.pi * (NdotH**2 * (alpha**2 - 1) + 1) ** 2)
        g = [x + np.sqrt(alpha**2 + (1 - alpha**2) * x**2) for x in (NdotL, NdotV)]
        return D / (g[0] * g[1])

    H = (wi + wo) / np.linalg.norm(wi + wo)
    NdotL, NdotV, NdotH, VdotH = wi[2], wo[2], H[2], float(wo @ H)
    fresnel_w = (1 - VdotH) ** 5
    specular = stretched_brdf() if model.anisotropy_strength else specular_brdf(model.roughness**2)
    f0 = np.minimum(((1 - model.ior) / (1 + model.ior)) ** 2 * model.specular_color, 1.0)
    dielectric_fresnel = model.specular * (f0 + (1 - f0) * fresnel_w)
    diffuse = model.base_color / np.pi
    dielectric = dielectric_fresnel * specular + (1 - dielectric_fresnel.max()) * diffuse
    metal = specular * (model.base_color + (1 - model.base_color) * fresnel_w)
    material = (1 - model.metallic) * dielectric + model.metallic * metal
    share = model.clearcoat * (0.04 + 0.96 * (1 - NdotV) ** 5)
    return (1 - share) * material + share * specular_brdf(model.clearcoat_roughness**2)


@given(directions(85.0), directions(85.0), st.integers(0, 2**32 - 1))
def test_gltf_is_the_specifications(wi, wo, seed):
    low, high = Gltf.bounds()
    model = Gltf.from_vector(
        low + (high - low) * np.random.default_rng(seed).uniform(0.1, 1, len(low))
    )
    assert_allclose(model.eval(wi, wo), gltf_by_the_book(model, wi, wo), rtol=1e-7)


@pytest.mark.parametrize("roughness", [0.0, 0.5, 1.0])
def test_white_diffuse_openpbr_loses_no_energy_however_rough(roughness):
    def white(wi, wo):
        between = (wi * wo).sum(axis=-1)
        return eon(np.ones((3, 1)), roughness, wi[:, 2], wo[:, 2], between).T

    # MaterialX counts no angle between light and viewer as more than a right one, which adds light when seen sideways.
    extra = roughness * np.array([0, 0.01, 0.03, 0.1])
    albedo = directional_albedo(white, ANGLES[:4])[:, 0]
    assert (albedo > 1 - 1e-3).all()
    assert (albedo < 1 + 1e-3 + extra).all()


# Light and view in degrees (theta_i, theta_o, phi between), and what Blender 5.3 renders of a plane there under a sun.
IN_CYCLES = {
    Cycles([0.6, 0.3, 0.1], roughness=0.5): [
        ((10, 30, 170), (0.21057, 0.11925, 0.05836)),
        ((40, 45, 180), (0.28421, 0.19374, 0.13343)),
        ((70, 60, 150), (0.20487, 0.11698, 0.0584)),
    ],
    Cycles([0.6, 0.3, 0.1], roughness=0.2, ior=2.2, specular_tint=[1, 0.7, 0.5]): [
        ((10, 30, 170), (0.18376, 0.0959, 0.03732)),
        ((40, 45, 180), (3.01411, 2.13156, 1.54319)),
        ((70, 60, 150), (0.15784, 0.07963, 0.0275)),
    ],
    Cycles([0.9, 0.6, 0.2], metallic=1.0, roughness=0.3, specular_tint=[1, 0.7, 0.5]): [
        ((40, 45, 180), (10.70177, 7.12749, 2.37524)),
        ((30, 80, 20), (0.00815, 0.00543, 0.00181)),
    ],
    Cycles([0.5, 0.2, 0.1], 0.3, 0.6, 1.4, [0.8, 0.9, 0.5], 0.7, 0.15): [
        ((10, 30, 170), (0.18496, 0.08019, 0.04127)),
        ((40, 45, 180), (0.70409, 0.55303, 0.49391)),
        ((70, 60, 150), (0.17507, 0.08506, 0.04768)),
        ((30, 80, 20), (0.08256, 0.03374, 0.01695)),
    ],
}


@pytest.mark.parametrize("model", IN_CYCLES, ids=["plastic", "tinted", "metal", "coated"])
def test_cycles_is_blenders(model):
    """Cycles has the albedo of a layer in a table, and we in a sum: half a percent at grazing angles."""
    for (theta_i, theta_o, phi), expected in IN_CYCLES[model]:
        i, o, p = np.radians([theta_i, theta_o, phi])
        wi = np.array([np.sin(i) * np.cos(p), np.sin(i) * np.sin(p), np.cos(i)])
        wo = np.array([np.sin(o), 0, np.cos(o)])
        assert_allclose(model.eval(wi, wo), expected, rtol=5e-3)


def test_another_solver_is_asked():
    asked = []

    def solver(residuals, start, **options):
        asked.append(options["bounds"])
        return SimpleNamespace(x=start, cost=float(np.square(residuals(start)).sum() / 2))

    fit(ABC["teflon"], "cycles", solver=solver)
    assert len(asked) == Cycles.n_searches


def test_the_metric_integrates_albedos():
    pairs = comparison_pairs()
    matte = pairs.reflected @ np.full(len(pairs.wi), 1 / np.pi)
    # Light from beyond 85 degrees is left out: sin^2 of the last five, .8 %, and what the coarse rule adds.
    assert_allclose(matte, 1, atol=0.05)
    assert_allclose([np.square(w).sum() for w in (pairs.weight, pairs.view_weight)], 1)


@pytest.mark.parametrize("kind", MODELS.values(), ids=MODELS)
def test_vectors_and_models_go_back_and_forth(kind):
    low, high = kind.bounds()
    assert (low < high).all()
    assert_allclose(kind.from_vector(kind.neutral()).to_vector(), kind.neutral())


TRUTHS = [
    KNOWN["plastic"],
    KNOWN["metal"],
    Gltf([0.6, 0.3, 0.1], roughness=0.4),
    Gltf([0.9, 0.6, 0.4], metallic=1.0, roughness=0.25),
    OpenPbr([0.1, 0.3, 0.5], specular_roughness=0.2),
    OpenPbr([0.9, 0.6, 0.4], base_metalness=1.0, specular_roughness=0.4),
]


@pytest.fixture
def one_search(monkeypatch):
    """Where a model's own table is, the best start leads there: a search from others as well can but be better."""
    for kind in MODELS.values():
        monkeypatch.setattr(kind, "n_searches", 1)


@pytest.mark.usefixtures("one_search")
@pytest.mark.parametrize("truth", TRUTHS, ids=lambda m: f"{type(m).__name__}-{m.base_color[0]}")
def test_a_table_of_a_model_gives_the_model_back(truth):
    (name,) = (name for name, kind in MODELS.items() if type(truth) is kind)
    found = fit(tabulate(truth, GRID), name)
    # Parameters trade with each other, a coat with a gloss; the look comes back better than they do.
    assert_allclose(found.model.base_color, truth.base_color, atol=0.05)
    roughness = "specular_roughness" if name == "openpbr" else "roughness"
    assert_allclose(getattr(found.model, roughness), getattr(truth, roughness), atol=0.02)
    # What is left is the grid's: theta_d in steps of three degrees.
    assert found.picture.psnr > 38
    assert found.albedo_error < 0.03


BRUSHED = [
    Principled([0.9, 0.7, 0.3], roughness=0.4, metallic=1.0, anisotropic=0.8, tangent_rotation=0.6),
    OpenPbr(
        [0.9, 0.6, 0.4],
        base_metalness=1.0,
        specular_roughness=0.4,
        specular_roughness_anisotropy=0.7,
        tangent_rotation=2.2,
    ),
    Gltf(
        [0.9, 0.6, 0.4],
        metallic=1.0,
        roughness=0.3,
        anisotropy_strength=0.5,
        anisotropy_rotation=1.0,
    ),
]
BRUSHED_GRID = Grid.anisotropic(40, 36, 12, 12, period=np.pi)


@pytest.mark.usefixtures("one_search")
@pytest.mark.parametrize("truth", BRUSHED, ids=lambda m: type(m).__name__)
def test_a_table_of_an_anisotropic_model_gives_its_anisotropy_and_rotation_back(truth):
    (name,) = (name for name, kind in MODELS.items() if isinstance(truth, kind))
    found = fit(tabulate(truth, BRUSHED_GRID), name).model
    how_much, where = ((getattr(model, grain) for model in (found, truth)) for grain in truth.grain)
    # What is left is the grid's: theta_d in steps of seven and a half degrees, phi_h in steps of five.
    assert_allclose(*how_much, atol=0.02)
    assert_allclose(*where, atol=0.02)


def test_another_model_finds_the_direction():
    truth = BRUSHED[0]
    found = fit(truth, "openpbr")
    assert found.picture.psnr > 32
    direction, expected = (getattr(model, model.grain[1]) for model in (found.model, truth))
    assert_allclose(direction, expected, atol=0.03)


def test_an_isotropic_table_that_is_lifted_is_fitted_as_none_that_is_anisotropic():
    plastic = KNOWN["plastic"]
    found = fit(tabulate(plastic, Grid.anisotropic(48, 4, 12, 24)), "principled").model
    assert found.anisotropic < 0.05
    assert_allclose(found.roughness, plastic.roughness, atol=0.02)
    assert fit(tabulate(plastic, GRID), "principled").model.is_isotropic


@pytest.mark.parametrize("model", BRUSHED, ids=lambda m: type(m).__name__)
@given(directions(85.0), directions(85.0))
def test_turning_a_model_turns_light_and_viewer_with_it(model, wi, wo):
    straight = replace(model, **{model.grain[1]: 0.0})
    angle = getattr(model, model.grain[1])
    expected = straight.eval(turn(wi, -angle), turn(wo, -angle))
    assert_allclose(model.eval(wi, wo), expected, rtol=1e-9)


@pytest.mark.parametrize("widths", [(0.3, 0.3), (0.5, 0.1), (0.05, 0.3)])
def test_all_normals_of_a_stretched_lobe_cover_the_surface_once(widths):
    """The integral of D cos(theta_h) over half vectors is 1."""
    nodes, solid_angles = quadrature.hemisphere(400, 360)
    zero = np.zeros(len(nodes))
    azimuths = Azimuths(np.arctan2(nodes[:, 1], nodes[:, 0]), zero, zero)
    lobe = Widths.along(*widths, 0.4, azimuths)
    density = lobe.density * ggx(np.arccos(nodes[:, 2]), lobe.h)
    assert_allclose((density * nodes[:, 2] * solid_angles).sum(), 1, rtol=1e-3)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", ["chrome", "white-diffuse-bball"])
def test_a_fit_reflects_no_more_than_it_receives_and_stays_in_bounds(name, model):
    found = fitted(name, model)
    low, high = found.model.bounds()
    x = found.model.to_vector()
    assert ((x >= low) & (x <= high)).all()
    assert directional_albedo(found.model, ANGLES).max() <= 1.005


class Retroreflective(IsotropicModel):
    """Light that goes back to where it comes from; no model here does that."""

    def at(self, theta_h, theta_d, phi_d, cos_i, cos_o):  # noqa: ARG002
        lobe = 0.2 / np.pi + 3 * np.exp(-((theta_d / 0.2) ** 2)) + 0 * theta_h
        return np.stack([lobe, lobe, lobe])


@pytest.mark.parametrize(("model", "least"), [("openpbr", 12), ("principled", 12), ("gltf", 12)])
def test_what_no_model_has_is_fitted_badly_and_said_so(model, least):
    found = fit(Retroreflective(), model, name="tape")
    assert least < found.picture.psnr < 30
    assert f"{found.picture.psnr:.1f} dB" in found.summary
    assert found.summary.endswith("a poor fit: look at it before you use it")
    assert found.to_json()["error"]["poor"] is True


@given(directions(85.0), directions(85.0), st.integers(0, 2**32 - 1))
def test_what_other_programs_make_of_gltf(wi, wo, seed):
    """Without extensions the index is 1.5 and there is no coat; in Blender the edge is white, so what specular takes from f0 stays there."""
    low, high = Gltf.bounds()
    model = Gltf.from_vector(
        low + (high - low) * np.random.default_rng(seed).uniform(0.1, 1, len(low))
    )
    core, blender = (model.readings[name] for name in ("without extensions", "in Blender"))
    assert_allclose(core.eval(wi, wo), gltf_by_the_book(Gltf(model.base_color, model.metallic, model.roughness, clearcoat_roughness=0.1), wi, wo))  # fmt: skip
    plain = replace(model, specular=1.0)
    assert_allclose(plain.readings["in Blender"].eval(wi, wo), plain.eval(wi, wo))
    # An index whose f0 is as much lower says the same to Blender.
    root = np.sqrt(model.specular) * (model.ior - 1) / (model.ior + 1)
    lower = replace(plain, ior=(1 + root) / (1 - root))
    assert_allclose(blender.eval(wi, wo), lower.eval(wi, wo), rtol=1e-9)


def test_of_fits_about_as_good_the_one_that_other_programs_read_is_found():
    """Chrome looks as well as a metal as it does as a dielectric of index 3, which is black without its index."""
    chrome = fitted("chrome", "gltf")
    assert chrome.model.metallic > 0.9
    assert chrome.model.specular == 1
    assert min(read.psnr for read in chrome.readings.values()) > 40
    assert (
        f"without extensions {chrome.readings['without extensions'].psnr:.1f} dB" in chrome.summary
    )
    assert not chrome.is_poor
    # Here only the dielectric is good: the others are three decibels off.
    assert fit(ABC["gold-paint"], "gltf").picture.psnr > 39


@pytest.mark.parametrize("model", MODELS)
def test_a_mirror_like_lobe_keeps_its_energy(model):
    """Its peak is some thousands of 1/sr and less than a degree wide."""
    truth = Gltf([0.8, 0.8, 0.8], metallic=1.0, roughness=0.1)
    found = fit(tabulate(truth, GRID), model)
    assert found.albedo_error < 0.06
    width = getattr(found.model, "specular_roughness", getattr(found.model, "roughness", None))
    assert 0.07 < width < 0.13


def test_unmeasured_samples_do_not_count():
    table = tabulate(ABC["gold-paint"], GRID)
    holes = np.array(table.values)
    holes[:, ::2, ::5] = np.nan
    whole, some = (fit(t, "principled").model for t in (table, TabularBrdf(holes, GRID)))
    assert_allclose(some.base_color, whole.base_color, atol=0.02)
    empty = TabularBrdf(np.full_like(holes, np.nan), GRID)
    with pytest.raises(FormatError, match=r"ghost is measured at none of the .* pairs"):
        fit(empty, name="ghost")


def test_an_unknown_model_is_named():
    with pytest.raises(
        HalfwayError, match="no model 'phong': expected openpbr, principled, cycles, gltf"
    ):
        fit(ABC["teflon"], "phong")


def test_a_fit_is_json():
    found = fit(ABC["teflon"], "principled", name="teflon")
    document = json.loads(json.dumps(found.to_json()))
    assert (document["format"], document["material"]) == (1, "teflon")
    assert document["model"] == "principled"
    assert document["parameters"]["base_color"] == found.model.base_color.tolist()
    assert replace(found, name="other").to_json()["material"] == "other"


def test_mitsubas_plugin_looks_as_the_table_of_its_model():
    """The picture of a fit that is the material: nothing in either difference but noise and the grid."""
    from halfway.render.fits import fit_sheet

    size = 48
    exact = Fit("exact", KNOWN["lacquer"], 0.0, Quality(120.0, 0.0), 0.0)
    sheet = fit_sheet(tabulate(exact.model, GRID, name="exact"), exact, size=size)
    n_rows = sheet.shape[0] // 2
    above, below = (sheet[start : start + size, -size:].mean() for start in (0, n_rows + 1))
    assert above == 0
    # Of 255, which are ten CIEDE2000.
    assert below < 25
