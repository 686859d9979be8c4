"""The published models: hand-computed values first, then laws, then the sets that come with the package."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from halfway import Grid, HalfDiff, from_half_diff
from halfway.brdf import IsotropicModel, fresnel
from halfway.errors import LibraryError
from halfway.models import PUBLISHED, AbcModel, SgdModel, builtin

UP = np.array([0.0, 0.0, 1.0])
TINY = Grid.merl(5, 6, 8)
MATERIALS = [(name, material) for name in PUBLISHED for material in builtin(name).models]

materials = st.sampled_from(MATERIALS)


def abc(kD=0.0, A=0.0, B=100.0, C=1.0, ior=1.5) -> AbcModel:
    return AbcModel(kD=np.full(3, kD), A=np.full(3, A), B=B, C=C, ior=ior)


def sgd(**parameters: float) -> SgdModel:
    neutral = {"rhoD": 0, "rhoS": 0, "alpha": 0.1, "p": 1, "F0": 1, "F1": 0, "K": 1}
    neutral |= {"Lambda": 0, "log_c": 0, "k": 1, "theta0": 0}
    return SgdModel(**{name: np.full(3, x) for name, x in (neutral | parameters).items()})


def leaning(degrees: float, phi_degrees: float = 0.0) -> np.ndarray:
    theta, phi = np.radians([degrees, phi_degrees])
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def model(material: tuple[str, str]) -> IsotropicModel:
    return builtin(material[0]).models[material[1]]


class TestAbc:
    def test_without_gloss_is_lambertian(self):
        assert_allclose(abc(kD=0.5).eval(UP, leaning(60)), 0.5 / np.pi, rtol=1e-15)

    def test_head_on_is_strength_times_normal_reflectance(self):
        # D = 1 at the peak, G = 1, F = ((1.5 - 1) / (1.5 + 1))^2 = 0.04
        assert_allclose(abc(A=2.0).eval(UP, UP), 2 * 0.04 / np.pi, rtol=1e-14)

    def test_in_retroreflection_off_the_normal(self):
        # theta_h = 60 deg, theta_d = 0: D = (1 + 2 / 2)^-3 = 1/8; F = 0.04; G = min(1, 2 cos^2 60) = 1/2.
        w = leaning(60)
        expected = 4 / 8 * 0.04 * 0.5 / (np.pi * 0.25)
        assert_allclose(abc(A=4.0, B=2.0, C=3.0).eval(w, w), expected, rtol=1e-13)

    def test_fresnel_at_its_two_ends_and_at_brewsters_angle(self):
        assert_allclose(fresnel(np.array([1.0, 0.0]), 1.5), [0.04, 1.0], rtol=1e-14)
        # tan(Brewster) = n; there only the perpendicular part ((n^2 - 1)/(n^2 + 1))^2 is left, halved.
        brewster = 1 / np.hypot(1, 1.5)
        assert_allclose(fresnel(np.array([brewster]), 1.5), (1.25 / 3.25) ** 2 / 2, rtol=1e-13)


class TestSgd:
    def test_without_gloss_is_lambertian(self):
        assert_allclose(sgd(rhoD=0.5).eval(UP, leaning(60)), 0.5 / np.pi, rtol=1e-15)

    def test_head_on(self):
        # x = alpha = 1/2, p = 2: D = 3 exp(-1/2) / (pi / 4); F = F0 - F1 = 0.3; G1 = 1.
        D = 12 * np.exp(-0.5) / np.pi
        f = sgd(rhoS=0.2, alpha=0.5, p=2, K=3, F0=0.4, F1=0.1).eval(UP, UP)
        assert_allclose(f, 0.2 * D * 0.3 / np.pi, rtol=1e-14)

    def test_masking_starts_past_theta0_and_ends_at_zero(self):
        # Retroreflection at 30 and 60 deg, c = 1, k = 1, theta0 = 45 deg: G1 = 1, then 1 + (1 - exp(pi/12)) Lambda.
        lit, dimmed = (
            sgd(rhoS=1, Lambda=Lambda, theta0=np.pi / 4).eval(w, w)[0] / sgd(rhoS=1).eval(w, w)[0]
            for w, Lambda in ((leaning(30), 1.0), (leaning(60), 1.0))
        )
        assert lit == 1
        assert_allclose(dimmed, (2 - np.exp(np.pi / 12)) ** 2, rtol=1e-12)
        w = leaning(60)
        assert_array_equal(sgd(rhoS=1, Lambda=1e7, theta0=np.pi / 4).eval(w, w), 0)

    def test_a_fresnel_fit_below_zero_counts_as_zero(self):
        # F = 0 - cos 30 + (1 - cos 30)^5 < 0
        f = sgd(rhoD=0.5, rhoS=1, F0=0, F1=1).eval(leaning(30), leaning(-30))
        assert_array_equal(f, 0.5 / np.pi)

    def test_factors_beyond_the_range_of_doubles_clamp_quietly(self):
        w = leaning(79)
        assert_array_equal(sgd(rhoS=1, Lambda=1, log_c=251.0, k=856).eval(w, w), 0)


@given(materials, st.floats(0, 0.99), st.floats(0, 89), st.floats(0, 89), st.floats(0, 180))
def test_swapping_light_and_viewer_changes_nothing(material, shift, i, o, phi):
    brdf, wi, wo = model(material), leaning(i, 360 * shift), leaning(o, 360 * shift + phi)
    # The angles carry about 1e-15; the narrowest published lobes (B = 8e6) magnify that to 1e-15 sqrt(B).
    assert_allclose(brdf.eval(wi, wo), brdf.eval(wo, wi), rtol=1e-9)


@given(materials, st.floats(0, 89.9), st.floats(0, 89.9), st.floats(0, 180))
def test_no_value_is_negative_or_infinite(material, i, o, phi):
    values = model(material).eval(leaning(i), leaning(o, phi))
    assert np.all(values >= 0)
    assert np.all(np.isfinite(values))


@given(
    materials,
    st.floats(80, 89.9),
    st.floats(80, 89.9),
    st.floats(0, 1),
    st.floats(0, 1),
    st.floats(0, 3),
)
def test_past_the_grazing_angle_the_cosines_have_no_effect(material, i, o, h, d, phi):
    def at(*degrees: float) -> np.ndarray:
        cos_i, cos_o = np.cos(np.radians(degrees))
        return model(material).at(*(np.array([x]) for x in (h, d, phi, cos_i, cos_o)))

    assert_array_equal(at(i, o), at(80, 80))


@pytest.mark.parametrize("material", MATERIALS[::19], ids="/".join)
def test_samples_on_a_grid_are_the_values_at_its_cell_centres(material):
    wi, wo = from_half_diff(HalfDiff(*TINY.centres()))
    expected = np.where(TINY.mask(), np.moveaxis(model(material).eval(wi, wo), -1, 0), np.nan)
    samples = model(material).sample_rows(TINY, slice(None))
    assert samples.dtype == np.float32
    # float32 rounding, and the digits that the angles of a pair of directions lose in a narrow lobe
    assert_allclose(samples, expected, rtol=1e-6)


@pytest.mark.parametrize("name", PUBLISHED)
def test_rows_sampled_apart_are_the_rows_of_the_whole(name):
    brdf = builtin(name).models["gold-paint"]
    whole = brdf.sample_rows(TINY, slice(None))
    parts = [brdf.sample_rows(TINY, slice(start, start + 2)) for start in (0, 2, 4)]
    assert_array_equal(np.concatenate(parts, axis=1), whole)


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_built_in_set_holds_the_100_materials_and_says_what_it_is(name):
    models = builtin(name)
    assert len(models.models) == 100
    assert {"light-brown-fabric", "blue-fabric", "cherry-235", "tungsten-carbide"} <= set(
        models.models
    )
    assert "not measurements" in models.origin.description
    assert "20" in models.origin.source
    assert builtin(name) is models


def test_the_published_numbers_arrive_in_their_places():
    gloss = builtin("merl-abc").models["alum-bronze"]
    assert isinstance(gloss, AbcModel)
    assert (gloss.kD[2], gloss.A[0], gloss.B) == (0.016220, 51.714554, 10482.133789)
    assert (gloss.C, gloss.ior) == (0.816737, 2.236525)
    shifted = builtin("merl-sgd").models["alum-bronze"]
    assert isinstance(shifted, SgdModel)
    assert (shifted.F1[1], shifted.theta0[2]) == (0.182842, -0.0661091)
    assert_allclose(np.exp(shifted.log_c[1]), 1.06401e-07, rtol=1e-14)


def test_an_unknown_set_is_one_line_with_the_known_ones():
    with pytest.raises(LibraryError) as error:
        builtin("merl-xyz")
    assert str(error.value) == (
        "builtin:merl-xyz is not in this package: choose one of merl-abc, merl-sgd, anisotropic, synthetic-N "
        "(such as synthetic-2000, or synthetic-2000-7 for seed 7)."
    )


def test_fingerprints_tell_formulas_and_numbers_apart():
    prints = {model(material).fingerprint() for material in MATERIALS}
    assert len(prints) == len(MATERIALS)
    assert abc(kD=0.5).fingerprint() == abc(kD=0.5).fingerprint()
    assert abc().fingerprint().startswith(b"ABC microfacet, held past 80 degrees")


def test_importing_the_models_reads_no_numbers():
    code = (
        "import halfway.models.sets as s; assert s.builtin.cache_info().currsize == 0; "
        "import sys; assert 'h5py' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
