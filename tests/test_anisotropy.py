"""What depends on phi_h: the laws of isotropic materials hold for it, and isotropic ones among it stay what they are."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from strategies import random_tables

import halfway
from halfway import Grid, TabularBrdf, directional_albedo, mix, open_library, tabulate
from halfway.brdf import check, fresnel, repair
from halfway.brdf.albedo_operator import albedos
from halfway.errors import OutputError
from halfway.export import write_route
from halfway.fit.microfacet import ggx, smith_correlated
from halfway.formats import read_brdf, write_merl
from halfway.halfdiff import HalfDiff, from_half_diff, to_half_diff, turn
from halfway.instruments import read_table
from halfway.library import ProceduralLibrary, build_library
from halfway.look import SphereOperator, SphereScene
from halfway.look.lit_sphere import PACING_SCENE, Sky
from halfway.look.sphere_rule import points
from halfway.models import builtin
from halfway.models.anisotropic import Lobe, Microfacets, Ward, fresnel_conductor
from halfway.space import make_space

GRID = Grid.anisotropic(10, 8, 6, 6)
FLAT = GRID.without("phi_h")
TABLE = random_tables(1, GRID)["material-0"]
MODELS = builtin("anisotropic").models
METAL = Microfacets((Lobe(0.2, 0.5, (2.9, 2.9, 2.6), (3.0, 2.9, 2.8)),))


def pairs(n=400, seed=0):
    rng = np.random.default_rng(seed)
    v = rng.normal(size=(2, n, 3))
    v[..., 2] = np.abs(v[..., 2]) + 0.05
    return tuple(v / np.linalg.norm(v, axis=-1, keepdims=True))


def turned(table, cells):
    return TabularBrdf(np.roll(table.values, cells, axis=2), table.grid, name=table.name)


# Tables


def test_turning_a_material_and_its_light_and_viewer_changes_nothing():
    angle = 3 * 2 * np.pi / 8
    wi, wo = pairs()
    assert_allclose(
        turned(TABLE, 3).eval(turn(wi, angle), turn(wo, angle)), TABLE.eval(wi, wo), rtol=1e-5
    )


def test_an_isotropic_table_is_lifted_as_it_is():
    flat = random_tables(1, FLAT)["material-0"]
    lifted = tabulate(flat, GRID)
    assert_array_equal(lifted.values, np.repeat(flat.values[:, :, None], 8, axis=2))
    assert_allclose(lifted.eval(*pairs()), flat.eval(*pairs()), rtol=1e-5)
    assert_allclose(lifted.turned_mean().values, flat.values, rtol=1e-6)
    assert_allclose(lifted.anisotropy(), 0, atol=1e-6)


@pytest.mark.parametrize("rows", [slice(2, 5), (slice(1, 2), slice(3, 6)), (slice(4, 9, 1), slice(0, 8), slice(2, 3))])  # fmt: skip
@pytest.mark.parametrize("name", ["gold-paint", "brushed-steel", "linen"])
def test_a_part_of_a_table_is_that_of_the_whole(name, rows):
    brdf = MODELS.get(name) or open_library("builtin:merl-abc").material(name)
    whole = brdf.sample_rows(GRID, slice(None))
    every = (slice(None), *(rows if isinstance(rows, tuple) else (rows,)))
    assert_array_equal(brdf.sample_rows(GRID, rows), whole[every])


def test_a_grid_without_phi_h_takes_the_mean_over_turns_and_says_so():
    with pytest.warns(UserWarning, match=r"^the material is anisotropic: its values vary by \d+%"):
        table = tabulate(METAL, FLAT)
    wi, wo = (d[3, 2, 1] for d in FLAT.directions())
    angles = 2 * np.pi * np.arange(16)[:, None] / 16
    turns = [turn(np.tile(d, (16, 1)), angles[:, 0]) for d in (wi, wo)]
    assert_allclose(table.values[:, 3, 2, 1], METAL.eval(*turns).mean(axis=0), rtol=1e-6)


def test_the_mean_over_turns_of_a_table_is_that_of_its_measured_cells():
    values = np.array(TABLE.values)
    values[:, 2, 1, 0, 0] = np.nan
    mean = TabularBrdf(values, GRID).turned_mean()
    assert mean.grid == FLAT
    assert_allclose(mean.values[:, 2, 0, 0], np.nanmean(values[:, 2, :, 0, 0], axis=1), rtol=1e-6)


def test_the_more_the_slopes_differ_the_more_anisotropic():
    found = [Microfacets((Lobe(a, 0.5),)).anisotropy() for a in (0.5, 0.4, 0.2, 0.1)]
    assert_allclose(found[0], 0, atol=1e-12)
    assert (np.diff(found) > 0).all()


# Albedo, check, repair


def test_the_albedo_is_that_from_the_worst_azimuth():
    theta = np.radians([10.0, 60.0])
    expected = [
        directional_albedo(TABLE, theta, 2 * np.pi * i / 8, n_theta_h=360, n_phi_h=60)
        for i in range(8)
    ]
    assert_allclose(albedos(TABLE, theta), np.max(expected, axis=0), rtol=1e-9)
    assert np.ptp(expected, axis=0).min() > 0


def test_a_brushed_metal_is_sound():
    card = check(tabulate(METAL, Grid.anisotropic(24, 16, 8, 8)))
    assert card.ok, card.broken
    assert card.reciprocity_error < 1e-6
    assert 0.1 < card.anisotropy < 1
    assert f"anisotropic by {card.anisotropy:.0%}" in card.summary


def test_what_reflects_too_much_from_one_side_is_repaired_for_all():
    values = 3 * np.array(tabulate(METAL, Grid.anisotropic(24, 16, 8, 8)).values)
    repaired = repair(TabularBrdf(values, Grid.anisotropic(24, 16, 8, 8))).table
    card = check(repaired)
    assert card.ok, card.broken
    assert card.max_albedo > 0.9


def test_a_lifted_table_is_checked_and_read_as_before():
    flat = tabulate(open_library("builtin:merl-abc").material("gold-paint"), Grid.merl(24, 12, 12))
    lifted = tabulate(flat, Grid.anisotropic(24, 6, 12, 12))
    before, after = check(flat), check(lifted)
    assert_allclose(after.max_albedo, before.max_albedo, rtol=1e-5)
    # On the normal itself phi_d counts from any azimuth.
    assert_allclose(after.highlight_width_degrees, before.highlight_width_degrees, rtol=1e-3)
    assert_allclose(read_table(lifted), read_table(flat), rtol=1e-6)


# The lit sphere


def test_an_even_sky_shows_the_albedo_for_the_viewer():
    """By reciprocity: light from everywhere to a viewer is light from there to everywhere."""
    scene = SphereScene("even", (), Sky((0, 1, 0), zenith=1.0, nadir=1.0), size=12, n_points=1)
    grid = Grid.anisotropic(32, 24, 10, 8)
    table = tabulate(METAL, grid)
    picture = SphereOperator.of(scene, grid).picture(table.values.reshape(3, -1))
    frame, _ = points(12, 1)
    some = np.flatnonzero(frame.theta_o < np.radians(70))[::9]
    expected = directional_albedo(table, frame.theta_o[some], frame.phi_o()[some])
    assert_allclose(picture[some], expected, rtol=0.02)


def test_the_sphere_of_a_lifted_table_is_that_of_the_table():
    flat = tabulate(open_library("builtin:merl-abc").material("gold-paint"), Grid.merl(24, 12, 12))
    lifted = tabulate(flat, Grid.anisotropic(24, 6, 12, 12))
    scene = SphereScene("small", PACING_SCENE.lights, PACING_SCENE.sky, size=16, n_points=2)
    shown = [
        SphereOperator.of(scene, t.grid).picture(t.values.reshape(3, -1)) for t in (flat, lifted)
    ]
    # The sky's moments stand at half as many theta_o.
    assert_allclose(shown[1], shown[0], atol=2e-3)


# Mixing, libraries, spaces


def test_a_mix_of_both_kinds_is_the_weighted_mean():
    brdfs = {"metal": METAL, "paint": open_library("builtin:merl-abc").material("gold-paint")}
    library = ProceduralLibrary("both", brdfs, grid=GRID)
    mixed = mix(library, "metal=.25, paint=.75")
    expected = 0.25 * library.brdf("metal").values + 0.75 * library.brdf("paint").values
    assert_allclose(mixed.values, expected, rtol=1e-6)
    for blend in ("root", "lobes"):
        table = mix(library, "metal=.25, paint=.75", blend=blend)
        assert (albedos(table, np.radians([0.0, 60.0])) <= 1).all()


def _abc(grid):
    few = dict(list(builtin("merl-abc").models.items())[::11])
    return ProceduralLibrary("abc", few, grid=grid)


# Cells are weighed in float32, where the root of a quarter is exact, and that of an eighth is not. The paper's space counts them.
@pytest.mark.parametrize(
    ("name", "n_phi_h", "tolerance"), [("paper", 8, 1e-9), ("anchored", 4, 1e-9), ("anchored", 8, 1e-7)]
)  # fmt: skip
def test_a_lifted_library_has_the_same_scores_and_recipes(name, n_phi_h, tolerance):
    lifted_grid = Grid.anisotropic(10, n_phi_h, 6, 6)
    flat, lifted = (make_space(name, _abc(grid)) for grid in (FLAT, lifted_grid))
    longer = np.sqrt(n_phi_h) if name == "paper" else 1
    for before, after in zip(flat.charts, lifted.charts, strict=True):
        points = before.coordinates.points * longer
        assert_allclose(after.coordinates.points, points, atol=tolerance * np.abs(points).max())
    t = np.linspace(0, 1, 9)
    assert_allclose(lifted.leg(0, 7).at(t), flat.leg(0, 7).at(t), atol=tolerance)


def test_a_route_goes_from_brushed_metal_to_paint():
    """In the default space, blend and pace: each end is its material, and between there is a recipe."""
    some = ("brushed-steel", "satin-steel", "brushed-gold", "anodised-blue", "satin-purple")
    few = dict(list(builtin("merl-abc").models.items())[::9])
    brdfs = {**{name: MODELS[name] for name in some}, **few}
    library = ProceduralLibrary("both", brdfs, grid=Grid.anisotropic(16, 12, 6, 6, period=np.pi))
    route = halfway.route(library, "brushed-steel", "alum-bronze")
    start, stop = route.recipe(0.0), route.recipe(1.0)
    assert (start.names, stop.names) == (("brushed-steel",), ("alum-bronze",))
    mixed = mix(library, route.recipe(0.5))
    assert library.brdf("brushed-steel").anisotropy() > mixed.anisotropy() > 0.01
    assert (albedos(mixed, np.radians([0.0, 60.0])) <= 1.01).all()


def test_libraries_of_both_kinds_are_built_and_sampled(tmp_path):
    flat = TabularBrdf(np.array(random_tables(1, Grid.merl(6, 4, 5))["material-0"].values), Grid.merl(6, 4, 5))  # fmt: skip
    write_merl(tmp_path / "mine.binary", flat)
    built = build_library(
        ["builtin:anisotropic", tmp_path / "mine.binary"],
        tmp_path / "both.brdflib",
        grid=Grid.anisotropic(6, 4, 4, 4),
    )
    assert len(built.library) == len(MODELS) + 1
    assert not built.skipped
    assert_allclose(
        built.library.brdf("mine").values, tabulate(flat, built.library.grid).values, rtol=1e-6
    )


def test_no_merl_files_are_written_of_a_route_among_them(tmp_path):
    library = ProceduralLibrary("metals", {"a": METAL, "b": MODELS["denim"]}, grid=GRID)
    found = halfway.route(library, "a", "b", space="linear", pace="uniform")
    with pytest.raises(OutputError, match="a MERL file holds theta_h"):
        write_route(tmp_path / "out", found, [0.5], library, format="merl")
    write_route(tmp_path / "out", found, [0.5], library, format="zarr")
    again = read_brdf(tmp_path / "out" / "tables.zarr")
    assert_allclose(again.values, mix(library, found.recipe(0.5)).values, rtol=2**-10)


def test_its_own_grid_knows_that_half_a_turn_is_enough():
    library = open_library("builtin:anisotropic")
    assert library.grid == Grid.anisotropic(period=np.pi)
    assert library.grid.shape == (64, 90, 24, 20)


# Models


@pytest.mark.parametrize("name", MODELS)
def test_models_are_reciprocal_passive_and_the_same_after_half_a_turn(name):
    brdf = MODELS[name]
    wi, wo = pairs(100)
    values = brdf.eval(wi, wo)
    assert values.min() >= 0
    assert_allclose(brdf.eval(wo, wi), values, rtol=1e-9)
    assert_allclose(brdf.eval(turn(wi, np.pi), turn(wo, np.pi)), values, rtol=1e-9)
    azimuths = np.array([0, np.pi / 4, np.pi / 2])
    albedo = directional_albedo(brdf, np.radians([[5.0], [60.0], [85.0]]), azimuths, n_theta_h=120)
    assert albedo.max() <= 1.005


def test_models_have_no_name_of_the_database():
    assert not set(MODELS) & set(builtin("merl-abc").models)
    assert "not measurements" in builtin("anisotropic").origin.description


def test_many_at_once_are_the_samples_of_each():
    several = [MODELS[name] for name in ("brushed-steel", "denim", "crosshatched-steel")]
    together = Microfacets.sample_many(several, GRID, slice(2, 4))
    each = [brdf.sample_rows(GRID, slice(2, 4)) for brdf in several]
    assert_array_equal(together, np.stack(each, axis=1))
    wi, wo = GRID.directions()
    expected = np.where(GRID.mask(), np.moveaxis(several[1].eval(wi, wo), -1, 0), np.nan)
    assert_allclose(several[1].sample_rows(GRID, slice(None)), expected, rtol=1e-5)


def test_equal_slopes_are_the_isotropic_model():
    wi, wo = pairs(50)
    theta_h = to_half_diff(wi, wo).theta_h
    cos_i, cos_o = wi[:, 2], wo[:, 2]
    expected = ggx(theta_h, 0.3) * smith_correlated(cos_i, cos_o, 0.3, 0.3) / (4 * cos_i * cos_o)
    assert_allclose(Microfacets((Lobe(0.3, 0.3),)).eval(wi, wo)[:, 0], expected, rtol=1e-9)


def test_a_lobe_of_no_loss_reflects_as_much_from_any_side_of_a_smooth_surface():
    """D is normalised: hardly anything of a nearly smooth mirror is hidden."""
    lobe = Microfacets((Lobe(0.02, 0.05),))
    found = directional_albedo(lobe, np.radians(20.0), np.array([0, 1.0]), n_phi_h=240)
    assert_allclose(found, 1, atol=0.01)


def test_the_reflectance_of_metals_and_glass():
    n, k = np.array([0.2]), np.array([3.4])
    straight = ((n - 1) ** 2 + k**2) / ((n + 1) ** 2 + k**2)
    assert_allclose(fresnel_conductor(np.array([1.0]), n, k), straight, rtol=1e-12)
    cosine = np.linspace(0.01, 1, 50)
    assert_allclose(
        fresnel_conductor(cosine, np.array(1.5), np.array(0.0)), fresnel(cosine, 1.5), rtol=1e-9
    )


def test_ward_at_the_normal_is_his_constant():
    up = np.array([0.0, 0.0, 1.0])
    brass = Ward(0.10, 0.33, 0.050, 0.16)
    assert_allclose(brass.eval(up, up), 0.1 / np.pi + 0.33 / (4 * np.pi * 0.05 * 0.16))
    angles = HalfDiff(*(np.array([x]) for x in (np.arctan(0.16), np.pi / 2, 0.0, 0.0)))
    f = brass.eval(*from_half_diff(angles))[0, 0] - 0.1 / np.pi
    ratio = np.exp(-1) / np.cos(np.arctan(0.16)) ** 4
    assert_allclose(f, 0.33 / (4 * np.pi * 0.05 * 0.16) * ratio, rtol=1e-6)


def test_no_warning_where_nothing_is_lost():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tabulate(METAL, GRID)
