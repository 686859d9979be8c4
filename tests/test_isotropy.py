"""What depends on phi_h says so."""

import numpy as np
from numpy.testing import assert_allclose

from halfway import Grid, TabularBrdf, directional_albedo
from halfway.halfdiff import Axis, from_half_diff
from halfway.library import Library, ProceduralLibrary

PHI_H = Axis("phi_h", 8, 2 * np.pi, periodic=True)
GRID = Grid((*Grid.merl(6, 4, 6).axes, PHI_H))


def brushed() -> TabularBrdf:
    """Light across the brush is spread, along it is not: values fall with the half vector's x faster than with its y."""
    wi, wo = from_half_diff(GRID.centres())
    h = (wi + wo) / np.linalg.norm(wi + wo, axis=-1, keepdims=True)
    values = np.exp(-8 * h[..., 0] ** 2 - 0.5 * h[..., 1] ** 2)
    samples = np.where(GRID.mask(), values, np.nan).astype(np.float32)
    return TabularBrdf(np.stack([samples] * 3), GRID, name="brushed")


def turned(table: TabularBrdf) -> TabularBrdf:
    """By a quarter turn, two cells of phi_h."""
    return TabularBrdf(np.roll(table.values, 2, axis=-1), table.grid, name="turned")


def library() -> Library:
    return ProceduralLibrary("brushes", {"a": brushed(), "b": turned(brushed())}, grid=GRID)


def test_a_grid_and_a_table_say_whether_they_are_isotropic():
    assert Grid.merl().is_isotropic
    assert not GRID.is_isotropic
    assert not brushed().is_isotropic


def test_a_turned_table_reflects_otherwise():
    """So an albedo of it has no meaning without the light's azimuth."""
    along, across = (
        directional_albedo(table.eval, np.radians(60)) for table in (brushed(), turned(brushed()))
    )
    assert np.abs(along / across - 1).min() > 0.1


def test_they_are_stored_and_come_back():
    assert_allclose(library().brdf("a").values, brushed().values)
