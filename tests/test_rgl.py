"""RGL materials: hand-made files whose values are known, and Mitsuba's own reader."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rgl_files import UP, directions, fields, plugin_values, viewers
from typer.testing import CliRunner

from halfway import Grid, tabulate
from halfway.cli import app
from halfway.errors import FormatError
from halfway.formats import find_brdfs, read_brdf
from halfway.formats.rgl_reader import read_rgl
from halfway.formats.spectra import rgb_weights
from halfway.formats.tensor_file import write_tensor_file
from halfway.render.variant import load_mitsuba

MERL_TINY = Grid.merl(6, 5, 8)


@pytest.fixture
def brdf_of(tmp_path):
    def read(fields):
        write_tensor_file(tmp_path / "clay_rgb.bsdf", fields)
        return read_rgl(tmp_path / "clay_rgb.bsdf")

    return read


@pytest.fixture
def mitsuba_scalar():
    mi = load_mitsuba()
    with mi.variant_context("scalar_rgb"):
        yield lambda file, light, viewer: plugin_values(mi, file, light, viewer)


# Evaluation


def test_a_file_of_ones_reflects_one_over_four_cosines(brdf_of):
    """As f cos = rgb D / (4 sigma): with every factor 1 that is 1/4, and f is it over the light's cosine."""
    brdf = brdf_of(fields())
    light = np.array([0.6, 0.0, 0.8])
    assert_allclose(brdf.eval(light, UP), 0.25 / 0.8)
    assert_allclose(brdf.eval(UP, light), 0.25)
    assert brdf.description == "hand-made"
    assert brdf.name == "clay"


def test_without_its_jacobian_a_file_holds_f_cos_itself(brdf_of):
    brdf = brdf_of({**fields(), "jacobian": np.zeros(1, np.uint8)})
    assert_allclose(brdf.eval(UP, UP), 1.0)


def test_below_the_horizon_nothing_is_reflected(brdf_of):
    brdf = brdf_of(fields())
    assert_allclose(brdf.eval(np.stack([-UP, UP]), np.stack([UP, -UP])), 0)


def test_turning_an_isotropic_material_changes_nothing(brdf_of):
    rng = np.random.default_rng(1)
    brdf = brdf_of(fields(rng))
    wi, wo = directions(rng, 50), directions(rng, 50)
    turn = np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]])
    # A turned m may fall on the other side of a node; the function is continuous there.
    assert_allclose(brdf.eval(wi @ turn, wo @ turn), brdf.eval(wi, wo), rtol=1e-9)


def test_equals_mitsuba_on_the_database(shared_data, mitsuba_scalar):
    """At random pairs, in what the plugin returns: f times cosine. It computes in float32, we in float64."""
    rng = np.random.default_rng(2)
    files = sorted((shared_data / "rgl").glob("*.bsdf"))
    assert len(files) == 11
    for file in files:
        light, viewer = directions(rng, 2000), viewers(rng, 2000)
        expected = mitsuba_scalar(file, light, viewer)
        ours = read_rgl(file).eval(light, viewer) * light[:, 2:]
        assert_allclose(ours, expected, rtol=1e-4, atol=1e-4, err_msg=file.name)


@pytest.mark.parametrize("n_parts", [1, 2, 4])
def test_equals_mitsuba_on_anisotropic_files(brdf_of, tmp_path, mitsuba_scalar, n_parts):
    """The whole circle, half of it, or a quarter, as the database stores them."""
    rng = np.random.default_rng(n_parts)
    brdf = brdf_of(fields(rng, n_phi=5, phi_range=2 * np.pi / n_parts))
    light, viewer = directions(rng, 500), directions(rng, 500)
    expected = mitsuba_scalar(tmp_path / "clay_rgb.bsdf", light, viewer)
    assert_allclose(brdf.eval(light, viewer) * light[:, 2:], expected, rtol=1e-4, atol=1e-5)


def test_beyond_the_last_direction_the_material_stays_what_it_was(
    brdf_of, tmp_path, mitsuba_scalar
):
    rng = np.random.default_rng(8)
    short = fields(rng)
    brdf = brdf_of({**short, "theta_i": np.array([0.3, 0.5, 0.7], np.float32)})
    light, viewer = directions(rng, 100), viewers(rng, 100)
    expected = mitsuba_scalar(tmp_path / "clay_rgb.bsdf", light, viewer)
    assert_allclose(brdf.eval(light, viewer) * light[:, 2:], expected, rtol=1e-4, atol=1e-5)


def test_a_file_of_the_database_is_found_under_its_name_there(tmp_path):
    write_tensor_file(tmp_path / "clay_rgb.bsdf", fields())
    (found,), _ = find_brdfs([tmp_path])
    assert found.name == "clay"
    assert_allclose(found.load().eval(UP, UP), 0.25)
    assert_allclose(read_brdf(tmp_path / "clay_rgb.bsdf").eval(UP, UP), 0.25)


# Tables


def test_colours_out_of_gamut_are_kept_by_eval_and_clamped_in_a_table(brdf_of):
    """The database holds negative values where a measured colour has no RGB; a table is a physical BRDF."""
    negative = fields()
    negative["rgb"][:, :, 0] = -1
    brdf = brdf_of(negative)
    assert_allclose(brdf.eval(UP, UP), [-0.25, 0.25, 0.25])
    assert np.nanmax(tabulate(brdf, MERL_TINY).values[0]) == 0


def test_a_table_holds_the_mean_of_both_orders(brdf_of):
    brdf = brdf_of(fields(np.random.default_rng(3)))
    wi, wo = MERL_TINY.directions()
    mask = MERL_TINY.mask()
    expected = (brdf.eval(wi, wo) + brdf.eval(wo, wi))[mask] / 2
    table = tabulate(brdf, MERL_TINY).values
    assert_allclose(table[:, mask].T, expected, rtol=1e-6)
    assert np.isnan(table[:, ~mask]).all()


def test_rows_of_a_table_are_those_of_the_whole(brdf_of):
    brdf = brdf_of(fields(np.random.default_rng(4)))
    whole = brdf.sample_rows(MERL_TINY, slice(None))
    assert_allclose(brdf.sample_rows(MERL_TINY, slice(2, 4)), whole[:, 2:4])


def test_a_table_of_an_anisotropic_material_holds_the_mean_and_says_so(brdf_of):
    rng = np.random.default_rng(5)
    brdf = brdf_of(fields(rng, n_phi=5))
    with pytest.warns(UserWarning, match=r"clay is anisotropic: its values vary by \d+%") as record:
        table = tabulate(brdf, MERL_TINY).values
    assert len(record) == 1
    wi, wo = (d[2, 1, 3] for d in MERL_TINY.directions())
    angles = 2 * np.pi * np.arange(16) / 16
    turned = [
        [np.cos(a) * v[0] - np.sin(a) * v[1], np.sin(a) * v[0] + np.cos(a) * v[1], v[2]]
        for v in (wi, wo)
        for a in angles
    ]
    wi, wo = np.split(np.array(turned), 2)
    assert_allclose(
        table[:, 2, 1, 3], (brdf.eval(wi, wo) + brdf.eval(wo, wi)).mean(axis=0) / 2, rtol=1e-6
    )


def test_info_says_how_anisotropic_a_file_is(brdf_of, tmp_path):
    """And what comes from the file cannot steer a terminal."""
    aniso = fields(np.random.default_rng(5), n_phi=5)
    brdf = brdf_of({**aniso, "description": np.frombuffer(b"silk\x1b[2J", np.uint8)})
    done = CliRunner().invoke(app, ["info", str(tmp_path / "clay_rgb.bsdf")])
    said = f"clay_rgb: an RGL material (anisotropic by {brdf.anisotropy():.0%}), 3 x 5 directions, RGB of the file, silk[2J"
    assert done.stdout.startswith(said), done.output
    assert "\x1b" not in done.stdout


def test_a_material_that_does_not_vary_is_not_called_anisotropic(brdf_of):
    brdf = brdf_of(fields(n_phi=5))
    assert brdf.anisotropy() < 1e-12
    assert not brdf.is_isotropic


def test_fingerprints_tell_materials_apart(brdf_of):
    one, other = (brdf_of(fields(np.random.default_rng(seed))) for seed in (0, 1))
    again = brdf_of(fields(np.random.default_rng(0)))
    assert one.fingerprint() == again.fingerprint() != other.fingerprint()


def test_the_database_becomes_tables(shared_data):
    brdf = read_rgl(shared_data / "rgl" / "acrylic_felt_green_rgb.bsdf")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = tabulate(brdf, Grid.merl(30, 30, 60))
    assert np.nanmin(table.values) >= 0
    # Green felt: green above red and blue, straight down.
    red, green, blue = table.eval(UP, UP)
    assert green > max(red, blue) > 0


def test_a_spectral_file_has_the_colour_of_its_spectra(brdf_of, tmp_path, mitsuba_spectral):
    """Mitsuba's spectral value at each wavelength of the file, weighted by the observer."""
    rng = np.random.default_rng(6)
    wavelengths = np.array([420, 500, 580, 660], np.float32)
    spectral = fields(rng, n_colours=4)
    spectral["spectra"] = spectral.pop("rgb")
    brdf = brdf_of({**spectral, "wavelengths": wavelengths})
    light, viewer = directions(rng, 100), viewers(rng, 100)
    spectra = plugin_values(
        mitsuba_spectral, tmp_path / "clay_rgb.bsdf", light, viewer, wavelengths.tolist()
    )
    assert_allclose(
        brdf.eval(light, viewer) * light[:, 2:],
        spectra @ rgb_weights(wavelengths).T,
        rtol=1e-4,
        atol=1e-5,
    )
    assert brdf.source == "4 wavelengths from 420 to 660 nm, CIE 1931 observer, illuminant D65"


# Errors


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"ndf": None}, "clay_rgb.bsdf has no field 'ndf', only description, jacobian"),
        ({"rgb": None}, "has no field 'wavelengths'"),
        (
            {"theta_i": np.array([0, 2, 1], np.float32)},
            "the 3 values of field 'theta_i' do not ascend",
        ),
        ({"theta_i": np.array([0, 1], np.float32)}, r"field 'rgb' has shape \(1, 3, 3, 4, 4\)"),
        (
            {"sigma": np.ones((5, 7))},
            r"field 'sigma' is float64 of shape \(5, 7\): expected float32 with 2",
        ),
        (
            {"sigma": np.full((5, 7), np.nan, np.float32)},
            "35 of 35 values of field 'sigma' are not finite",
        ),
        ({"ndf": np.full((5, 7), -1, np.float32)}, "field 'ndf' goes down to -1"),
        ({"vndf": np.zeros((1, 3, 6, 8), np.float32)}, "field 'vndf' is 0 everywhere"),
        ({"jacobian": np.zeros(0, np.uint8)}, "none empty"),
    ],
)
def test_a_damaged_material_says_what_is_wrong(brdf_of, change, message):
    changed = {**fields(), **change}
    with pytest.raises(FormatError, match=message):
        brdf_of({name: value for name, value in changed.items() if value is not None})
