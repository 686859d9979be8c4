"""The validity card and the repair: materials whose laws are broken on purpose, then laws that hold for all."""

import math
import re

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from halfway import Brdf, Grid, TabularBrdf, directional_albedo, tabulate
from halfway.brdf.albedo_operator import AlbedoOperator, albedos
from halfway.brdf.check import check
from halfway.brdf.layout import horizon
from halfway.brdf.repair import repair
from halfway.models import builtin

GRID = Grid.merl(12, 10, 16)
MASK = GRID.mask()


def table(values, name="clay"):
    """A table of one value per cell, unmeasured below the horizon."""
    filled = np.where(MASK, np.broadcast_to(values, (3, *GRID.shape)), np.nan)
    return TabularBrdf(filled.astype(np.float32), GRID, name=name)


def changed(index, value, base=0.2):
    values = np.array(table(base).values)
    values[index] = value
    return TabularBrdf(values, GRID, name="clay")


INSIDE = (0, 2, 3, 8)
OUTSIDE = (0, *np.argwhere(~MASK)[0])
assert MASK[INSIDE[1:]]


# The card


def test_a_white_diffuse_surface_is_sound():
    card = check(table(1 / np.pi))
    assert card.ok
    assert card.mask_is_the_grids
    assert card.minimum == pytest.approx(1 / np.pi)
    assert card.max_albedo == pytest.approx(1, abs=0.005)
    assert card.reciprocity_error < 1e-12
    assert card.bilateral_error < 1e-12
    assert card.unmeasured == pytest.approx(1 - MASK.mean())
    assert card.highlight_degrees is None
    assert card.dynamic_range == pytest.approx(1)
    assert card.name == "clay"


@pytest.mark.parametrize(
    ("brdf", "broken"),
    [
        (changed(INSIDE, np.inf), ("1 samples are infinite",)),
        (changed(INSIDE, -0.25), ("goes down to -0.25 /sr",)),
        (
            table(1.1 / np.pi),
            ("reflects 1.1 times the light from", "reflects 1.1 times the light from above 80"),
        ),
        (table(np.nan), ("nothing is measured",)),
    ],
)
def test_a_broken_law_is_said_with_its_numbers(brdf, broken):
    card = check(brdf)
    assert not card.ok
    assert len(card.broken) == len(broken)
    for said, expected in zip(card.broken, broken, strict=True):
        assert expected in said


class OneWay(Brdf):
    """Brighter the higher the light stands: not reciprocal."""

    name = "one-way"
    is_isotropic = True

    def eval(self, wi, wo):
        return np.where(
            (wi[..., 2:] > 0) & (wo[..., 2:] > 0), 0.1 + 0.1 * wi[..., 2:], 0
        ) * np.ones(3)

    def fingerprint(self):
        return b"one-way"


def test_a_material_that_is_not_reciprocal_is_found_out():
    card = check(OneWay(), grid=GRID)
    (said,) = card.broken
    assert said.startswith(f"changes by {card.reciprocity_error:.1%}")
    assert card.reciprocity_error > 0.05


class Woven(Brdf):
    """Brighter to one side of the plane of incidence."""

    is_isotropic = True

    def eval(self, wi, wo):
        side = wi[..., 0] * wo[..., 1] - wi[..., 1] * wo[..., 0]
        return (0.2 + 0.1 * np.abs(side) * np.sign(side))[..., None] * np.ones(3)

    def fingerprint(self):
        return b"woven"


def test_a_material_may_tell_left_from_right_without_breaking_a_law():
    assert check(Woven(), grid=GRID).bilateral_error > 0.05


def test_a_card_says_in_one_line_what_matters():
    sound, broken = check(table(1 / np.pi)), check(table(1.1 / np.pi))
    assert sound.summary == (
        f"reflects at most {sound.max_albedo:.3f} (grazing {sound.max_albedo_grazing:.3f}), "
        f"{sound.unmeasured:.1%} unmeasured, dynamic range 1"
    )
    assert broken.summary == "; ".join(broken.broken)


def test_holes_and_samples_below_the_horizon_are_counted():
    card = check(changed((slice(None), *INSIDE[1:]), np.nan))
    assert (card.n_holes, card.n_below_horizon, card.mask_is_the_grids) == (1, 0, False)
    card = check(changed((slice(None), *OUTSIDE[1:]), 0.2))
    assert (card.n_holes, card.n_below_horizon, card.mask_is_the_grids) == (0, 1, False)
    assert card.ok


def said(card):
    """What a person reads and what a program reads: the same sentences."""
    assert (card.ok, list(card.broken), list(card.notes)) == tuple(
        card.as_json()[key] for key in ("ok", "broken", "notes")
    )
    for sentence in card.broken or card.notes:
        assert sentence in card.summary
    return [*card.broken, *card.notes]


def masked(unmeasured, grid=GRID):
    return TabularBrdf(
        np.where(unmeasured, np.nan, np.full((3, *grid.shape), 0.1, np.float32)), grid
    )


@pytest.mark.parametrize(
    ("mask", "expected"),
    [
        (
            np.roll(~MASK, 4, axis=2),
            r"\d+ cells above the horizon are unmeasured and \d+ cells below the",
        ),
        (~MASK[::-1], r"\d+ cells above the horizon are unmeasured and \d+ cells below the"),
        (~MASK | (np.arange(10)[:, None] > 6), r"\d+ cells above the horizon are unmeasured"),
        (~MASK & (np.arange(10)[:, None] > 6), r"\d+ cells below the horizon are measured"),
        (
            np.random.default_rng(0).random(GRID.shape) < 0.25,
            r"\d+ cells above the horizon are unm",
        ),
    ],
    ids=["turned", "upside down", "more", "less", "anywhere"],
)
def test_a_mask_that_is_not_the_horizon_is_never_sound(mask, expected):
    card = check(masked(mask))
    assert not card.ok
    assert not card.mask_is_the_grids
    assert re.match(expected, said(card)[0])


def test_the_card_says_which_grid_the_unmeasured_cells_draw():
    twice = np.concatenate([~MASK, ~MASK], axis=2)
    values = np.where(twice, np.nan, np.random.default_rng(0).random((3, *twice.shape)) / 9)
    card = check(TabularBrdf(values.astype(np.float32), Grid.merl(*twice.shape)))
    assert said(card)[1] == (
        "its cells are those of another grid: 12 x 10 x 32 cells, phi_d over a whole turn"
    )
    assert card.lies_as == "12 x 10 x 32 cells, phi_d over a whole turn"


def test_the_card_says_that_the_axes_are_in_another_order():
    grid = Grid.merl(12, 12, 24)
    card = check(masked(~grid.mask().transpose(1, 0, 2), grid))
    assert not card.ok
    assert said(card)[0].endswith("12 x 12 x 24 cells, stored in the order theta_d, theta_h, phi_d")


def test_cells_that_the_horizon_cuts_may_be_measured_or_not():
    above, below = horizon(GRID)
    for mask in (below, ~above):
        card = check(masked(mask))
        assert card.ok
        assert len(said(card)) == 1


def test_a_table_that_is_measured_everywhere_is_sound():
    card = check(masked(np.zeros(GRID.shape, bool)))
    assert card.ok
    assert said(card) == [f"{(~MASK).sum():,} cells below the horizon are measured"]


def test_channels_that_are_measured_in_different_cells_are_said():
    values = np.array(table(0.1).values)
    values[2, :, ::2] = np.nan
    card = check(TabularBrdf(values, GRID))
    lost, left = MASK[:, ::2].sum() / MASK.size, MASK[:, 1::2].sum() / MASK.size
    assert said(card)[0] == (
        f"{100 * lost:.2g}% of the cells are measured in some channels only (red 75.4%, green 75.4%, blue {left:.1%})"
    )
    assert not card.ok
    card = check(changed(INSIDE, np.nan))
    assert card.ok
    assert said(card)[0] == (
        "0.052% of the cells are measured in some channels only (red 75.4%, green 75.4%, blue 75.4%)"
    )


def test_the_highlight_is_found_where_it_is():
    """A Gaussian in theta_h of 6 degrees falls to half at 6 sqrt(ln 2) degrees."""
    theta_h = np.degrees(Grid.merl(90, 10, 8).centres().theta_h)
    grid = Grid.merl(90, 10, 8)
    lobe = np.broadcast_to(0.1 + np.exp(-((theta_h / 6) ** 2)), grid.shape)
    card = check(TabularBrdf(np.stack([lobe] * 3).astype(np.float32), grid))
    assert card.highlight_degrees == pytest.approx(0, abs=0.1)
    assert card.highlight_width_degrees == pytest.approx(6 * math.sqrt(math.log(2)), abs=0.15)
    assert card.dynamic_range == pytest.approx(1.1 / np.median(lobe), rel=0.1)


def test_the_card_is_json_that_says_whether_all_is_well():
    card = check(table(np.nan)).as_json()
    assert card["ok"] is False
    assert card["minimum"] is None
    assert card["broken"] == ["nothing is measured"]
    assert check(table(0.1)).as_json()["ok"] is True


def test_built_in_materials_are_sound():
    for name in ("chrome", "white-fabric", "pink-plastic", "alum-bronze"):
        model = builtin("merl-abc").models[name]
        assert check(tabulate(model, Grid.merl(45, 45, 45), name=name)).broken == ()


# Albedo


# Seeds have nothing to shrink.
QUICK = (Phase.explicit, Phase.reuse, Phase.generate)
seeds = st.integers(0, 2**32 - 1)


def random_table(seed, scale=0.2, grid=GRID):
    values = np.random.default_rng(seed).gamma(0.5, scale, (3, *grid.shape))
    return TabularBrdf(np.where(grid.mask(), values, np.nan).astype(np.float32), grid)


@pytest.mark.parametrize("holes", [False, True])
def test_the_fast_albedo_is_the_directional_albedo(holes):
    material = random_table(0)
    if holes:
        values = np.array(material.values)
        values[:, 1:4, 2:5, ::3] = np.nan
        values[1, 6] = np.nan
        material = TabularBrdf(values, GRID)
    theta_i = np.radians([0.0, 33.0, 85.0])
    assert_allclose(albedos(material, theta_i), directional_albedo(material, theta_i), rtol=1e-9)


def test_the_albedo_of_a_mix_is_the_mix_of_albedos():
    a, b = random_table(1), random_table(2)
    operator = AlbedoOperator.of(GRID, MASK, np.radians([10.0, 60.0]))
    mixed = operator.apply(np.nan_to_num(0.3 * a.values + 0.7 * b.values))
    parts = [operator.apply(np.nan_to_num(t.values)) for t in (a, b)]
    assert_allclose(mixed, 0.3 * parts[0] + 0.7 * parts[1], rtol=1e-6)


@settings(max_examples=8, phases=QUICK)
@given(seeds, seeds, st.floats(0, 1))
def test_a_mix_of_sound_materials_is_sound(one, other, share):
    a, b = (repair(random_table(seed)).table for seed in (one, other))
    assert check(
        TabularBrdf(((1 - share) * a.values + share * b.values).astype(np.float32), GRID)
    ).ok


# Repair


def test_a_sound_table_is_left_alone():
    sound = table(0.3)
    repaired = repair(sound)
    assert repaired.table is sound
    assert repaired.changes == ()


def test_a_hole_takes_the_nearest_sample():
    values = np.array(random_table(3).values)
    neighbours = [(1, 3, 8), (3, 3, 8), (2, 2, 8), (2, 4, 8), (2, 3, 7), (2, 3, 9)]
    values[:, 2, 3, 8] = np.nan
    repaired = repair(TabularBrdf(values, GRID))
    assert repaired.table.values[0, 2, 3, 8] in [values[0, *cell] for cell in neighbours]
    assert (
        repaired.changes[0]
        == "3 of 5,760 samples were unmeasured and took the nearest measured one."
    )


def test_a_hole_at_the_end_of_a_turn_takes_the_sample_at_its_start():
    """phi_d is periodic: across its seam is one step, along the other axes nothing is measured."""
    values = np.full((3, *GRID.shape), np.nan, np.float32)
    values[:, 2, 3, 0] = 0.25
    values[:, 2, 3, 8] = 0.125
    filled = repair(TabularBrdf(values, GRID)).table.values
    assert filled[0, 2, 3, -1] == 0.25
    assert filled[0, 2, 3, 9] == 0.125


def test_every_change_is_listed():
    values = np.array(table(2 / np.pi).values)
    values[INSIDE] = np.inf
    values[:, 3, 3, 3] = -1
    values[OUTSIDE] = 7
    repaired = repair(TabularBrdf(values, GRID, name="clay"))
    assert len(repaired.changes) == 5
    for said, expected in zip(
        repaired.changes,
        [
            "1 of 5,760 samples below the horizon were removed.",
            "1 of 5,760 samples were infinite",
            "1 of 5,760 samples were unmeasured",
            "3 of 5,760 samples were negative, down to -1 /sr",
            "Up to 2 times the light was reflected",
        ],
        strict=True,
    ):
        assert said.startswith(expected)
    assert check(repaired.table).ok
    assert check(repaired.table).mask_is_the_grids
    assert repaired.table.name == "clay"


def test_nothing_measured_becomes_black():
    repaired = repair(table(np.nan))
    assert check(repaired.table).ok
    assert np.nanmax(repaired.table.values) == 0
    assert "0 in a channel without any measured sample" in repaired.changes[0]


@settings(max_examples=12, phases=QUICK)
@given(seeds, st.floats(0.1, 50), st.booleans())
def test_what_was_repaired_is_sound_and_stays_as_it_is(seed, scale, spoilt):
    rng = np.random.default_rng(seed)
    values = np.array(random_table(seed, scale).values)
    if spoilt:
        where = rng.random(values.shape)
        values[where < 0.1] = np.nan
        values[where > 0.97] *= -1
        values[where > 0.99] = np.inf
    repaired = repair(TabularBrdf(values, GRID))
    assert check(repaired.table).broken == ()
    assert check(repaired.table).mask_is_the_grids
    assert repair(repaired.table).changes == ()


def test_scaling_down_keeps_what_was_sound():
    """Too bright between grazing directions only: what is lit and seen from elsewhere is not touched."""
    theta_i, theta_o = (np.degrees(np.arccos(np.clip(d[..., 2], 0, 1))) for d in GRID.directions())
    bright = table(np.where(np.minimum(theta_i, theta_o) > 70, 30.0, 0.05))
    assert check(bright).max_albedo_grazing > 1.5
    repaired = repair(bright).table
    assert check(repaired).ok
    assert_allclose(repaired.values[:, MASK & (np.maximum(theta_i, theta_o) < 50)], 0.05)
    # The lesser factor of the two rules, whichever of them is grazing, or the table were not reciprocal.
    one_grazing = (np.minimum(theta_i, theta_o) < 40) & (np.maximum(theta_i, theta_o) > 82)
    assert (repaired.values[:, MASK & one_grazing] < 0.04).all()
