"""RGL materials: hand-made files whose values are known, the laws of the warp, and Mitsuba's own reader."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from halfway import Grid, tabulate
from halfway.errors import FormatError
from halfway.formats import find_brdfs, read_brdf
from halfway.formats.rgl_reader import read_rgl
from halfway.formats.rgl_warp import Warp, slices
from halfway.formats.spectra import rgb_weights
from halfway.formats.tensor_file import read_tensor_file, write_tensor_file

UP = np.array([0.0, 0.0, 1.0])
MERL_TINY = Grid.merl(6, 5, 8)


def directions(rng, n):
    """Unit vectors above the horizon, evenly spread in z, exact in float32 as a renderer holds them."""
    z, phi = rng.uniform(0.02, 1, n), rng.uniform(0, 2 * np.pi, n)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).astype(np.float32).astype(float)


def viewers(rng, n):
    """As `directions`, in the quarter x, y < 0.

    Mitsuba 3.9's plugin mirrors other viewers of an isotropic material, or not, by a variable that it never sets.
    """
    return np.abs(directions(rng, n)) * [-1, -1, 1]


def fields(rng=None, *, n_phi=1, n_theta=3, phi_range=2 * np.pi, n_colours=3, size=4):
    """A material with all factors 1, or random ones."""

    def nodes(*shape):
        return (
            np.ones(shape, np.float32)
            if rng is None
            else rng.uniform(0.2, 2, shape).astype(np.float32)
        )

    phi_i = np.zeros(1) if n_phi == 1 else -np.pi + phi_range * np.linspace(0, 1, n_phi)
    return {
        "description": np.frombuffer(b"hand-made", np.uint8),
        "phi_i": phi_i.astype(np.float32),
        "theta_i": np.linspace(0, np.pi / 2, n_theta, dtype=np.float32),
        "ndf": np.repeat(nodes(1, 7), 5, axis=0) if n_phi == 1 else nodes(5, 7),
        "sigma": np.repeat(nodes(1, 7), 5, axis=0) if n_phi == 1 else nodes(5, 7),
        "vndf": nodes(n_phi, n_theta, 6, 8),
        "rgb": nodes(n_phi, n_theta, n_colours, size, size),
        "luminance": nodes(n_phi, n_theta, size, size),
        "jacobian": np.ones(1, np.uint8),
    }


@pytest.fixture
def brdf_of(tmp_path):
    def read(fields):
        write_tensor_file(tmp_path / "clay_rgb.bsdf", fields)
        return read_rgl(tmp_path / "clay_rgb.bsdf")

    return read


# The container


def test_fields_come_back_as_they_were(tmp_path):
    written = {
        "a": np.arange(6, dtype=np.float32).reshape(2, 3),
        "name": np.frombuffer(b"hi", np.uint8),
        "n": np.ones((1, 1, 2), np.float64),
    }
    write_tensor_file(tmp_path / "x.bsdf", written)
    read = read_tensor_file(tmp_path / "x.bsdf")
    assert list(read) == list(written)
    for name, array in written.items():
        assert read[name].dtype == array.dtype
        assert_allclose(read[name], array)


def test_the_container_is_laid_out_as_its_page_says(tmp_path):
    write_tensor_file(tmp_path / "x.bsdf", {"ab": np.array([1, 2], np.uint32)})
    content = (tmp_path / "x.bsdf").read_bytes()
    header = (
        b"tensor_file\0"
        b"\x01\0"
        b"\x01\0\0\0"
        b"\x02\0ab"
        b"\x01\0"
        b"\x05" + b"\x30" + 7 * b"\0" + b"\x02" + 7 * b"\0"
    )
    assert content == header + b"\0" * (48 - len(header)) + b"\x01\0\0\0\x02\0\0\0"


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


def test_a_material_that_does_not_vary_is_not_called_anisotropic(brdf_of):
    brdf = brdf_of(fields(n_phi=5))
    assert brdf.anisotropy < 1e-12
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


# Colour


def test_a_white_spectrum_is_white():
    assert_allclose(rgb_weights(np.linspace(360, 1000, 40)).sum(axis=1), 1, rtol=1e-12)


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


# The warp

densities = st.integers(0, 2**32 - 1).map(
    lambda seed: np.random.default_rng(seed).uniform(0.01, 1, (2, 5, 6)) ** 3
)
unit = st.floats(0.001, 0.999)


@settings(max_examples=50)
@given(densities, unit, unit, st.integers(0, 1))
def test_invert_undoes_sample(values, s_theta, s_phi, i):
    warp = Warp.of(values)
    s = np.array([s_theta]), np.array([s_phi])
    where = slices((np.arange(2.0),), (np.array([float(i)]),))
    assert_allclose(warp.invert(*warp.sample(*s, i), where), s, atol=1e-9)


@settings(max_examples=20)
@given(densities, st.floats(0, 1))
def test_the_warp_is_onto_the_unit_square(values, p):
    corners = np.array([0.0, 0, 1, 1]), np.array([0.0, 1, 0, 1])
    where = slices((np.arange(2.0),), (np.full(4, p),))
    assert_allclose(Warp.of(values).invert(*corners, where), corners, atol=1e-12)


def test_the_warp_follows_the_density():
    """The area that maps to a patch is the integral of the density over it."""
    values = np.random.default_rng(7).uniform(0.1, 1, (1, 3, 3))
    warp = Warp.of(values)
    # The image of the quarter u_theta, u_phi < 1/2: s_theta at its right edge, integrated over s_phi.
    rows = np.linspace(0, 0.5, 2001)
    s_theta, s_phi = warp.invert(
        np.full(2001, 0.5), rows, slices((np.zeros(1),), (np.zeros(2001),))
    )
    area = np.trapezoid(s_theta, s_phi)
    v = values[0] / (values[0] @ [0.25, 0.5, 0.25] @ [0.25, 0.5, 0.25])
    assert_allclose(area, v[:2, :2].mean() / 4, rtol=1e-6)


def test_a_row_of_zeros_does_not_break_the_warp():
    values = np.ones((1, 4, 4))
    values[:, 1:3] = 0
    s_theta, s_phi = Warp.of(values).invert(
        np.array([0.5]), np.array([0.5]), slices((np.zeros(1),), (np.zeros(1),))
    )
    assert (s_theta, s_phi) == (0, 0.5)


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


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "does not begin as a tensor file"),
        (b"PK\3\4" + b"\0" * 100, "does not begin as a tensor file"),
        (b"tensor_file\0\1\0", "ends after 14 bytes, inside its header"),
        (b"tensor_file\0\2\0\1\0\0\0", "version 2.0"),
        (b"tensor_file\0\1\0\xff\xff\xff\xff", "claims 4294967295 fields"),
        (b"tensor_file\0\1\0\1\0\0\0\1\0a\xff\xff\1" + b"\0" * 8, "65535 dimensions"),
        (b"tensor_file\0\1\0\1\0\0\0\1\0a\1\0\x63" + b"\0" * 16, "has type 99"),
        (
            b"tensor_file\0\1\0\1\0\0\0\1\0a\1\0\1" + b"\0" * 8 + b"\xff" * 8,
            "it is truncated or damaged",
        ),
        (
            b"tensor_file\0\1\0\1\0\0\0\1\0a\2\0\1" + b"\0" * 16 + b"\xff" * 8,
            "it is truncated or damaged",
        ),
        (b"tensor_file\0\1\0\2\0\0\0" + 2 * (b"\1\0a\0\0\1" + b"\0" * 8), "two fields named 'a'"),
    ],
)
def test_a_damaged_container_says_what_is_wrong(tmp_path, content, message):
    (tmp_path / "x.bsdf").write_bytes(content)
    with pytest.raises(FormatError, match=message):
        read_tensor_file(tmp_path / "x.bsdf")


# Mitsuba


def plugin_values(mi, file, light, viewer, wavelengths=()):
    """Values of f times cosine by the stock plugin; its ``wi`` is the viewer."""
    bsdf = mi.load_dict({"type": "measured", "filename": str(file)})
    si, context = mi.SurfaceInteraction3f(), mi.BSDFContext()
    if wavelengths:
        si.wavelengths = wavelengths
    values = []
    for to_light, to_viewer in zip(light.tolist(), viewer.tolist(), strict=True):
        si.wi = to_viewer
        values.append(list(bsdf.eval(context, si, to_light)))
    return np.array(values)


@pytest.fixture
def mitsuba_scalar():
    mi = _mitsuba()
    with mi.variant_context("scalar_rgb"):
        yield lambda file, light, viewer: plugin_values(mi, file, light, viewer)


@pytest.fixture
def mitsuba_spectral():
    mi = _mitsuba()
    with mi.variant_context("scalar_spectral"):
        yield mi


def _mitsuba():
    """Mitsuba with an LLVM that other tests of the same process can use."""
    from halfway.render.variant import load_mitsuba

    return load_mitsuba()
