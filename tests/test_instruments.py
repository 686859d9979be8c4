"""What instruments read off tables, and the attributes that are functions of it."""

import numpy as np
import pytest
from glossy import GRID, glossy
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import dblquad

from halfway import attributes
from halfway.brdf import TabularBrdf, fresnel
from halfway.brdf.quadrature import Windows
from halfway.errors import ControlError
from halfway.halfdiff import Axis, Grid, cosines
from halfway.instruments import ATTRIBUTES, Reader, Readings, attribute, of_readings, read_table
from halfway.instruments.functionals import INSTRUMENTS, PROFILE, RECEPTORS, SOURCE
from halfway.library import ProceduralLibrary
from halfway.recipes import Blend

WHITE = TabularBrdf(np.full((3, *GRID.shape), 1 / np.pi, np.float32), GRID)
RANDOM = np.random.default_rng(0).gamma(0.5, size=(40, len(INSTRUMENTS), 3))
RANDOM[:, -len(PROFILE) :] = -np.sort(-RANDOM[:, -len(PROFILE) :], axis=1)  # a highlight falls
SINGLE = [name for name, a in ATTRIBUTES.items() if a.is_number]


def projected(theta: float, size: tuple[float, float]) -> float:
    """Solid angle times cosine of a window at ``theta``, by another quadrature."""
    along, across = (np.tan(np.radians(x / 2)) for x in size)

    def element(v: float, u: float) -> float:
        length = np.sqrt(1 + u * u + v * v)
        return (np.cos(theta) - u * np.sin(theta)) / length**4

    return dblquad(element, -along, along, -across, across)[0]


def test_a_flat_black_glass_reads_100():
    """A lobe of .1 degrees on cells of a tenth of that: linear interpolation adds .3 % to it, the window takes nothing."""
    grid = Grid.merl(720, 360, 2)
    angles = grid.centres()
    cos_i, cos_o = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    width, cos_h = np.radians(0.1), np.cos(angles.theta_h)
    d = np.exp(-((np.tan(angles.theta_h) / width) ** 2)) / (np.pi * width**2 * cos_h**4)
    mirror = fresnel(np.cos(angles.theta_d), 1.567) * d / (4 * np.abs(cos_i * cos_o))
    values = np.where(grid.mask(), np.broadcast_to(mirror, grid.shape), np.nan).astype(np.float32)
    for name in ("gloss20", "gloss60", "gloss85"):
        read = INSTRUMENTS[name](grid, grid.mask()).of(values.reshape(1, -1))
        assert_allclose(read, 100, atol=0.5)
        assert_allclose(
            INSTRUMENTS["haze"](grid, grid.mask()).of(values.reshape(1, -1)), 0, atol=1e-3
        )


@pytest.mark.parametrize("degrees", [20, 60, 85])
def test_gloss_of_a_white_matte_surface_is_that_of_its_windows(degrees: int):
    """Where pi f = 1 the flux is the product of the windows over pi, and that from black glass the source's alone."""
    theta = np.radians(degrees)
    rule = Windows.at(theta, SOURCE, RECEPTORS[degrees])
    assert_allclose(rule.wi_weights.sum(), projected(theta, SOURCE), rtol=1e-4)
    glass = rule.wi_weights @ fresnel(rule.cos_i, 1.567) / rule.wi_weights.sum()
    expected = 100 * projected(theta, RECEPTORS[degrees]) / np.pi / glass
    assert_allclose(attributes(WHITE)[f"gloss{degrees}"], expected, rtol=1e-4)


def test_a_white_matte_surface():
    """A perfect diffuser reflects everything, everywhere alike."""
    of = attributes(WHITE)
    # The albedo's rule is good to .3 % on this grid, where cells beyond the horizon count as their neighbours.
    assert_allclose([of[n] for n in ("albedo", "albedo0", "albedo45", "albedo60")], 1, rtol=3e-3)
    assert_allclose([of["L"], of["a"], of["b"]], [100, 0, 0], atol=1e-4)
    assert_allclose(of["body"], 1, rtol=1e-6)
    assert_allclose(of["fresnel_edge"], 1, rtol=3e-3)
    assert_allclose(of["doi"], 0, atol=1e-5)


@pytest.mark.parametrize("alpha", [0.03, 0.06, 0.12])
def test_the_width_of_a_ggx_lobe_is_its_roughness(alpha: float):
    """Half of its energy lies within atan(alpha); the foot at 30 degrees takes (alpha / tan 30)^2 of it, and cells a few %."""
    of = attributes(glossy((0.2, 0.2, 0.2), 1.0, alpha, Grid.merl(90, 18, 12)))
    assert_allclose(of["highlight_width"], np.degrees(np.arctan(alpha)), rtol=0.1)


def test_half_a_table_has_half_of_what_is_linear_and_the_same_ratios():
    whole = glossy((0.1, 0.3, 0.5), 0.7, 0.1)
    half = TabularBrdf(whole.values / 2, GRID)
    a, b = attributes(whole), attributes(half)
    linear = [n for n in SINGLE if n.startswith(("gloss", "albedo", "haze"))]
    assert_allclose([b[n] for n in linear], [a[n] / 2 for n in linear], rtol=1e-5)
    ratios = ["doi", "fresnel_edge", "highlight_width"]
    assert_allclose([b[n] for n in ratios], [a[n] for n in ratios], rtol=1e-5)


def test_unmeasured_cells_count_as_their_neighbours_and_each_channel_by_itself():
    values = WHITE.values.copy()
    values[:, ~GRID.mask()] = np.nan
    values[1, 3] = np.nan
    of = attributes(TabularBrdf(values, GRID))
    assert_allclose(
        [of["gloss60"], *of["body"]], [attributes(WHITE)["gloss60"], 1, 1, 1], rtol=1e-5
    )


def test_what_is_nowhere_measured_is_none():
    of = attributes(TabularBrdf(np.full((3, *GRID.shape), np.nan, np.float32), GRID))
    assert all(np.isnan(of[name]) for name in SINGLE)
    assert ATTRIBUTES["gloss60"].written(of["gloss60"]) == "none"
    assert ATTRIBUTES["body"].to_json(of["body"]) is None


def test_readings_of_a_mix_are_the_mix_of_the_readings():
    tables = {"a": glossy((0.1, 0.2, 0.3), 1.0, 0.05), "b": glossy((0.6, 0.1, 0.2), 0.1, 0.3)}
    readings = Readings.fit(ProceduralLibrary("two", tables, grid=GRID))
    mixed = TabularBrdf(0.3 * tables["a"].values + 0.7 * tables["b"].values, GRID)
    weights = np.broadcast_to([0.3, 0.7], (3, 2))
    # float32 of the mixed table
    assert_allclose(readings.mix(weights, Blend.LINEAR), read_table(mixed), rtol=1e-5, atol=1e-9)


@pytest.mark.parametrize("name", [name for name in SINGLE if not ATTRIBUTES[name].needs])
def test_a_condition_says_on_which_side_of_a_target_a_value_is(name: str):
    """And is met with equality at the value itself."""
    wanted = attribute(name)
    values = wanted.of(RANDOM)
    for value in values[:10]:
        (c,) = wanted.conditions(float(value), {})
        sides = np.einsum("nfc,fc->n", RANDOM, c.coefficients) - c.constant
        assert_allclose(sides[values == value], 0, atol=1e-12 * np.abs(sides).max())
        apart = np.abs(values - value) > 1e-9
        assert (np.sign(sides) == np.sign(values - value))[apart].all()


@pytest.mark.parametrize("name", ["a", "b"])
def test_a_condition_on_an_opponent_colour_holds_at_the_lightness_that_is_given(name: str):
    for readings in RANDOM[:10]:
        value, lightness = (float(attribute(n).of(readings)) for n in (name, "L"))
        for target, sign in ((value, 0), (value + 1, -1), (value - 1, 1)):
            (c,) = attribute(name).conditions(target, {"L": lightness})
            side = (c.coefficients * readings).sum() - c.constant
            assert np.sign(np.round(side, 12)) == sign


@given(st.text())
def test_a_target_that_is_none_is_refused_in_one_line(text: str):
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if 0 <= number < np.inf:
        return
    with pytest.raises(ControlError, match="expected a number, 0 or more") as told:
        attribute("gloss60").parsed(text)
    assert "\n" not in str(told.value)


def test_attributes_have_names_that_are_told():
    with pytest.raises(ControlError, match="did you mean gloss60"):
        attribute("glos60")
    with pytest.raises(ControlError, match="#7a2a3a"):
        attribute("body").parsed("brown")


def test_an_instrument_reads_the_mean_over_turns_of_an_anisotropic_sample():
    grid = Grid((*GRID.axes, Axis("phi_h", 4, 2 * np.pi, periodic=True)))
    values = np.random.default_rng(0).gamma(1, size=(3, *grid.shape)).astype(np.float32)
    values[:, ~grid.mask()] = np.nan
    table = TabularBrdf(values, grid)
    mean = TabularBrdf(values.mean(axis=-1, dtype=np.float64).astype(np.float32), GRID)
    assert_allclose(read_table(table), read_table(mean), rtol=1e-5)


@pytest.mark.parametrize("axes", [(), (Axis("phi_h", 4, 2 * np.pi, periodic=True),)])
def test_a_few_instruments_read_the_same_off_the_columns_that_they_need(axes: tuple[Axis, ...]):
    grid = Grid((*GRID.axes, *axes))
    values = np.random.default_rng(0).gamma(1, size=(2, 3, *grid.shape)).astype(np.float32)
    reader = Reader.of({"gloss60", "profile_5", "albedo45"}, grid)
    columns = values.reshape(2, 3, grid.shape[0], -1)[..., reader.columns]
    got = reader.read(columns.reshape(2, 3, -1))
    values[..., ~grid.mask()] = np.nan
    whole = np.stack([read_table(TabularBrdf(each, grid)) for each in values])
    read = np.isfinite(got).all(axis=(0, 2))
    assert [name for name, is_read in zip(INSTRUMENTS, read, strict=True) if is_read] == [
        "gloss60",
        "albedo45",
        "profile_5",
    ]
    assert_allclose(got[:, read], whole[:, read], rtol=1e-5)


def test_what_readings_stand_for_has_every_attribute():
    assert list(of_readings(RANDOM)) == list(ATTRIBUTES)
