"""`.bsdf` files of several azimuths: what we write, stock Mitsuba shows."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rgl_files import directions, plugin_values

from halfway import Grid, tabulate
from halfway.brdf import Brdf
from halfway.formats import read_rgl, write_rgl
from halfway.formats.rgl_writer import Resolution
from halfway.models.anisotropic import Lobe, Microfacets
from halfway.render.variant import load_mitsuba

COARSE = Resolution(6, 12)
STEEL = Lobe(0.15, 0.4, (2.9, 2.9, 2.6), (3.0, 2.9, 2.8))
BRUSHED = Microfacets((STEEL,))
TWILL = Microfacets((STEEL, Lobe(0.2, 0.5, turn_degrees=30.0, share=(0.2, 0.1, 0.1))))


class OneWay(Brdf):
    """Brushed fur: half a turn is not the same."""

    is_isotropic = False

    def eval(self, wi, wo):
        return BRUSHED.eval(wi, wo) * (1 + 0.2 * (wi + wo)[..., :1])

    def fingerprint(self):
        return b""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bsdf")
    cases = {4: BRUSHED, 2: TWILL, 1: OneWay()}
    for n_parts, brdf in cases.items():
        write_rgl(folder / f"{n_parts}.bsdf", brdf, resolution=COARSE)
    return folder


@pytest.mark.parametrize("n_parts", [1, 2, 4])
def test_the_file_covers_the_part_of_a_turn_that_symmetry_leaves(files, n_parts):
    brdf = read_rgl(files / f"{n_parts}.bsdf")
    assert not brdf.is_isotropic
    assert_allclose(brdf.phi_i[[0, -1]], [-np.pi, 2 * np.pi / n_parts - np.pi], rtol=1e-6)


@pytest.mark.parametrize("n_parts", [1, 2, 4])
def test_stock_mitsuba_shows_what_we_read(files, n_parts):
    mi = load_mitsuba()
    rng = np.random.default_rng(n_parts)
    light, viewer = directions(rng, 60), directions(rng, 60)
    with mi.variant_context("scalar_rgb"):
        shown = plugin_values(mi, files / f"{n_parts}.bsdf", light, viewer)
    ours = read_rgl(files / f"{n_parts}.bsdf").eval(light, viewer) * light[:, 2:]
    assert_allclose(shown, ours, rtol=1e-4, atol=1e-4 * ours.mean())


@pytest.mark.parametrize(("n_parts", "brdf"), [(1, OneWay()), (2, TWILL), (4, BRUSHED)])
def test_the_file_is_near_to_the_material_at_every_azimuth(files, n_parts, brdf):
    """Even a coarse one, where both directions are within 70 degrees: a mean error of 5 %."""
    rng = np.random.default_rng(0)
    light, viewer = (v[v[:, 2] > 0.34][:300] for v in (directions(rng, 900), directions(rng, 900)))
    expected = brdf.eval(light, viewer)
    found = read_rgl(files / f"{n_parts}.bsdf").eval(light, viewer)
    assert np.abs(found - expected).sum() < 0.05 * expected.sum()


def test_a_table_comes_back_through_the_file(tmp_path):
    table = tabulate(BRUSHED, Grid.anisotropic(24, 24, 8, 8))
    written = write_rgl(tmp_path / "x.bsdf", table, resolution=Resolution(12, 24))
    assert written.quality.psnr > 36
    again = tabulate(read_rgl(written.path), table.grid)
    wi, wo = table.grid.directions()
    exchanged = np.where(table.grid.mask(), wi[..., 2] * wo[..., 2], np.nan)
    difference = np.nansum(np.abs(again.values - table.values) * exchanged)
    assert difference < 0.05 * np.nansum(table.values * exchanged)
