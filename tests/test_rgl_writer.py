"""Written RGL files: what they reflect, what the readers need in them, and what stock Mitsuba makes of them."""

from io import BytesIO

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rgl_files import directions, plugin_values, viewers

from halfway import MERL, Grid, TabularBrdf, tabulate
from halfway.brdf.quality import Quality, lit_sphere, quality
from halfway.errors import FormatError, OutputError
from halfway.formats import read_rgl
from halfway.formats.rgl_writer import RESOLUTIONS, WAVELENGTHS, Resolution, write_rgl
from halfway.formats.spectra import smooth_primaries
from halfway.formats.tensor_file import read_tensors
from halfway.models import builtin
from halfway.render.variant import load_mitsuba

COARSE = Resolution(8, 16)
GRID = Grid.merl(24, 24, 48)


@pytest.fixture(scope="module")
def glossy():
    """A metallic paint on a coarse grid, with unmeasured samples as every table has."""
    return tabulate(builtin("merl-abc").models["gold-paint"], GRID, name="gold-paint")


def constant(value):
    return TabularBrdf(np.full((3, *GRID.shape), value, np.float32), GRID, name="flat")


# What a file reflects


def test_a_diffuse_material_stays_diffuse(tmp_path):
    """Only the cosine is interpolated between the nodes: where neither direction is grazing, to some thousandths."""
    write_rgl(tmp_path / "x.bsdf", constant(0.3), resolution=Resolution(16, 32))
    rng = np.random.default_rng(0)
    wi, wo = (v[v[:, 2] > 0.3][:300] for v in (directions(rng, 500), directions(rng, 500)))
    values = read_rgl(tmp_path / "x.bsdf").eval(wi, wo) * wi[:, 2:]
    error = np.abs(values / (0.3 * wi[:, 2:]) - 1)
    assert error.mean() < 0.005
    assert error.max() < 0.05


def test_a_file_holds_the_material_at_its_nodes(tmp_path, glossy):
    """At a fixed direction of the file and on its half vectors nothing is interpolated."""
    write_rgl(tmp_path / "x.bsdf", glossy, resolution=Resolution(9, 17))
    brdf = read_rgl(tmp_path / "x.bsdf")
    theta_i = brdf.theta_i[3]
    u_theta, u_phi = brdf.vndf.sample(np.linspace(0, 1, 17), np.full(17, 0.5), 3)
    theta_m, phi_m = np.pi / 2 * u_theta**2, np.pi * (2 * u_phi - 1)
    m = np.stack(
        [np.sin(theta_m) * np.cos(phi_m), np.sin(theta_m) * np.sin(phi_m), np.cos(theta_m)], -1
    )
    i = np.array([np.sin(theta_i), 0, np.cos(theta_i)])
    o = 2 * (m @ i)[:, None] * m - i
    o, i = o[o[:, 2] > 0.01], np.broadcast_to(i, o[o[:, 2] > 0.01].shape)
    assert len(o) > 5
    # float32 storage, and the ill-conditioned inversion of it where the density is small
    assert_allclose(brdf.eval(o, i), glossy.eval(o, i), rtol=1e-3)


@pytest.mark.parametrize("name", ["gold-paint", "alum-bronze", "light-brown-fabric", "chrome"])
def test_by_default_the_picture_is_right(tmp_path, name):
    """At least 40 dB on smooth materials and 36 on mirrors, as read back from the file."""
    table = tabulate(builtin("merl-abc").models[name], GRID)
    written = write_rgl(tmp_path / "x.bsdf", table)
    again = quality(lit_sphere(read_rgl(written.path)), lit_sphere(table))
    assert again.psnr == pytest.approx(written.quality.psnr, abs=1e-9)
    assert again.psnr > (36 if name == "chrome" else 40)


def test_the_resolution_is_the_first_that_is_good_enough(tmp_path):
    matte, mirror = (
        tabulate(builtin("merl-abc").models[name], GRID) for name in ("blue-fabric", "chrome")
    )
    assert write_rgl(tmp_path / "x.bsdf", matte).resolution == RESOLUTIONS[0]
    assert write_rgl(tmp_path / "x.bsdf", mirror, min_psnr=55.0).resolution == RESOLUTIONS[1]
    assert write_rgl(tmp_path / "x.bsdf", mirror, resolution=COARSE).resolution == COARSE


def test_a_finer_file_is_closer(tmp_path, glossy):
    coarse, fine = (
        write_rgl(tmp_path / "x.bsdf", glossy, resolution=Resolution(n, 2 * n)).quality
        for n in (6, 24)
    )
    # Linear interpolation: a quarter of the step is a sixteenth of the error where the material is smooth.
    assert fine.relative_l1 < coarse.relative_l1 / 4, (coarse, fine)


def test_a_black_material_stays_black(tmp_path):
    written = write_rgl(tmp_path / "x.bsdf", constant(0), resolution=COARSE)
    assert written.quality == Quality(psnr=120.0, relative_l1=0.0)
    assert_allclose(lit_sphere(read_rgl(written.path)), 0)


def test_what_is_unmeasured_everywhere_is_refused(tmp_path):
    with pytest.raises(FormatError, match="is measured nowhere on a lit sphere"):
        write_rgl(tmp_path / "x.bsdf", constant(np.nan), resolution=COARSE)


def test_negative_values_are_written_as_0(tmp_path):
    write_rgl(tmp_path / "x.bsdf", constant(-0.1), resolution=COARSE)
    assert read_tensors(BytesIO((tmp_path / "x.bsdf").read_bytes()), "x.bsdf")["rgb"].min() == 0


def test_a_measurement_comes_back_through_table_and_file(shared_data, tmp_path):
    """RGL file to table to RGL file: at least 36 dB of the table."""
    table = tabulate(read_rgl(shared_data / "rgl" / "cg_sunflower_rgb.bsdf"), GRID)
    assert write_rgl(tmp_path / "x.bsdf", table, resolution=RESOLUTIONS[1]).quality.psnr > 36


# What the readers need


def test_the_fields_are_those_that_the_readers_ask_for(tmp_path, glossy):
    """Names, types and shapes as pbrt-v4 and Mitsuba check them on loading."""
    write_rgl(tmp_path / "x.bsdf", glossy, resolution=COARSE, spectral=True)
    read = read_tensors(BytesIO((tmp_path / "x.bsdf").read_bytes()), "x.bsdf")
    n = len(WAVELENGTHS)
    expected = {
        "description": ("u1", (len("gold-paint"),)),
        "phi_i": ("f4", (1,)),
        "theta_i": ("f4", (8,)),
        "ndf": ("f4", (2, 128)),
        "sigma": ("f4", (2, 128)),
        "vndf": ("f4", (1, 8, 32, 128)),
        "luminance": ("f4", (1, 8, 16, 16)),
        "wavelengths": ("f4", (n,)),
        "spectra": ("f4", (1, 8, n, 16, 16)),
        "jacobian": ("u1", (1,)),
    }
    assert {name: (array.dtype.str[1:], array.shape) for name, array in read.items()} == expected
    assert read["jacobian"][0] == 1
    assert bytes(read["description"]) == b"gold-paint"


def test_an_rgb_file_has_rgb_in_the_place_of_spectra(tmp_path, glossy):
    write_rgl(tmp_path / "x.bsdf", glossy, resolution=COARSE)
    read = read_tensors(BytesIO((tmp_path / "x.bsdf").read_bytes()), "x.bsdf")
    assert read["rgb"].shape == (1, 8, 3, 16, 16)
    assert not {"spectra", "wavelengths"} & set(read)


def test_spectra_have_the_colours_they_were_made_of(tmp_path, glossy):
    for spectral in (False, True):
        write_rgl(tmp_path / f"{spectral}.bsdf", glossy, resolution=COARSE, spectral=spectral)
    rgb, spectral = (lit_sphere(read_rgl(tmp_path / f"{s}.bsdf")) for s in (False, True))
    assert_allclose(spectral, rgb, rtol=1e-4, atol=1e-5)


def test_the_luminance_is_positive_and_small_below_the_horizon(tmp_path, glossy):
    """A density that is 0 where the reader interpolates cannot be sampled."""
    write_rgl(tmp_path / "x.bsdf", glossy, resolution=COARSE)
    luminance = read_tensors(BytesIO((tmp_path / "x.bsdf").read_bytes()), "x.bsdf")["luminance"]
    assert luminance.min() > 0
    grazing = luminance[0, -1]
    assert grazing.min() < 1e-3 * grazing.mean()


def test_a_folder_in_the_way_is_said(tmp_path, glossy):
    (tmp_path / "x").write_text("a file")
    with pytest.raises(OutputError, match="part of its path is a file"):
        write_rgl(tmp_path / "x" / "y.bsdf", glossy, resolution=COARSE)


# Stock Mitsuba


@pytest.fixture(scope="module")
def written(tmp_path_factory, glossy):
    folder = tmp_path_factory.mktemp("written")
    for spectral in (False, True):
        write_rgl(
            folder / f"{spectral}.bsdf", glossy, resolution=Resolution(16, 32), spectral=spectral
        )
    return folder


def test_mitsuba_shows_what_we_read(written):
    rng = np.random.default_rng(1)
    light, viewer = directions(rng, 500), viewers(rng, 500)
    ours = read_rgl(written / "False.bsdf").eval(light, viewer) * light[:, 2:]
    mi = load_mitsuba()
    with mi.variant_context("scalar_rgb"):
        theirs = plugin_values(mi, written / "False.bsdf", light, viewer)
    assert_allclose(ours, theirs, rtol=1e-4, atol=1e-4)


def test_mitsuba_loads_spectra_in_spectral_variants(written):
    rng = np.random.default_rng(2)
    light, viewer = directions(rng, 100), viewers(rng, 100)
    wavelengths = [460.0, 540.0, 600.0, 700.0]
    mi = load_mitsuba()
    with mi.variant_context("scalar_spectral"):
        spectra = plugin_values(mi, written / "True.bsdf", light, viewer, wavelengths)
    at = np.searchsorted(WAVELENGTHS, wavelengths)
    rgb = read_rgl(written / "True.bsdf").eval(light, viewer) * light[:, 2:]
    assert_allclose(spectra, rgb @ smooth_primaries(WAVELENGTHS)[at].T, rtol=1e-3, atol=1e-4)


@pytest.mark.parametrize("light", ["D65", "E"])
def test_under_white_light_a_spectral_file_has_the_colour_of_the_rgb_file(
    written, light, mitsuba_spectral
):
    """With Mitsuba's own observer and illuminant; white is shown white. Exact under D65, 2 % under the equal-energy E."""
    mi = mitsuba_spectral
    wi, wo = (
        v[:40]
        for v in (directions(np.random.default_rng(3), 40), viewers(np.random.default_rng(4), 40))
    )
    nm = np.arange(380, 781, 10.0)
    observer = np.array([list(mi.cie1931_xyz(w)) for w in nm])
    illuminant = np.array([mi.cie_d65(w) if light == "D65" else 1.0 for w in nm])
    columns = [list(mi.xyz_to_srgb(mi.Color3f(*axis))) for axis in np.eye(3)]
    weights = observer * illuminant[:, None] @ np.array(columns)
    groups = [
        plugin_values(mi, written / "True.bsdf", wi, wo, np.resize(nm[i : i + 4], 4).tolist())
        for i in range(0, len(nm), 4)
    ]
    spectra = np.concatenate(groups, axis=1)[:, : len(nm)]
    colours = spectra @ (weights / weights.sum(axis=0))
    expected = read_rgl(written / "False.bsdf").eval(wi, wo) * wi[:, 2:]
    assert (
        np.abs(colours - expected).sum()
        < (0.003 if light == "D65" else 0.02) * np.abs(expected).sum()
    )


@pytest.fixture(scope="module")
def mirror(tmp_path_factory):
    """Chrome, whose highlight is a tenth of a degree wide."""
    path = tmp_path_factory.mktemp("mirror") / "chrome.bsdf"
    write_rgl(path, tabulate(builtin("merl-abc").models["chrome"], MERL), resolution=RESOLUTIONS[1])
    return path


@pytest.mark.parametrize("degrees", [0, 20, 45, 70, 85])
@pytest.mark.parametrize("material", ["glossy", "mirror"])
def test_mitsuba_samples_what_its_density_says(
    written, mirror, material, degrees, tmp_path, monkeypatch
):
    """The stock plugin's chi-square test on our files, at its own resolution, by half vectors (see `half_vector_domain`)."""
    monkeypatch.chdir(tmp_path)  # where a failing test leaves its density
    from half_vector_domain import HalfVectorDomain

    path = mirror if material == "mirror" else written / "False.bsdf"
    mi = load_mitsuba()
    with mi.variant_context("llvm_ad_rgb"):
        import drjit as dr

        bsdf, context = mi.load_dict({"type": "measured", "filename": str(path)}), mi.BSDFContext()
        domain = HalfVectorDomain(degrees)

        def seen(n):
            si = dr.zeros(mi.SurfaceInteraction3f, n)
            si.wi = domain.wo
            return si

        def sample(u):
            drawn, weight = bsdf.sample(context, seen(dr.width(u)), u[0], mi.Point2f(u[1], u[2]))
            # What is drawn below the horizon carries nothing, and `pdf` is 0 there.
            return drawn.wo, dr.select(dr.max(weight) > 0, mi.Float(1), 0)

        test = mi.chi2.ChiSquareTest(
            domain=domain,
            sample_func=sample,
            pdf_func=lambda wi: bsdf.pdf(context, seen(dr.width(wi)), wi) * domain.measure(wi),
            sample_dim=3,
            sample_count=200_000,
            res=51,
            ires=32,
        )
        assert test.run(), test.messages
        assert_allclose(np.array(test.pdf_sum), 1, atol=0.01)


def test_mitsuba_samples_in_proportion_to_the_material(written):
    """The weights f cos / pdf of the luminance hardly vary: no sample carries much more than another."""
    mi = load_mitsuba()
    with mi.variant_context("llvm_ad_rgb"):
        import drjit as dr

        bsdf = mi.load_dict({"type": "measured", "filename": str(written / "False.bsdf")})
        n = 20_000
        si = dr.zeros(mi.SurfaceInteraction3f, n)
        si.wi = mi.Vector3f(-0.6, 0.0, 0.8)
        u = np.random.default_rng(3).random((2, n), np.float32)
        _, weights = bsdf.sample(mi.BSDFContext(), si, 0.5, mi.Point2f(u[0], u[1]))
        luminance = [0.2126, 0.7152, 0.0722] @ np.array(weights)
    assert luminance.std() < 0.15 * luminance.mean()
