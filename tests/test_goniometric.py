"""Files over the directions themselves: read back at their nodes, told apart by content, refused in one line."""

import numpy as np
import pytest
from gonio_files import csail, csail_pairs, utia, utia_directions
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from halfway import Grid, mix, tabulate
from halfway.brdf import Brdf
from halfway.cli import app
from halfway.errors import FormatError
from halfway.formats import find_brdfs, read_brdf, write_brdf
from halfway.formats.zarr_tables import ZarrStore, write_zarr
from halfway.halfdiff import turn
from halfway.library import build_library
from halfway.models.anisotropic import Lobe, Microfacets
from halfway.recipes import open_recipe

CLOTH = Microfacets((Lobe(0.3, 0.6, (1.5, 1.5, 1.5), turn_degrees=20.0),), (0.4, 0.1, 0.2))
GRID = Grid.anisotropic(6, 8, 4, 4)


class OneSided(Brdf):
    """Not reciprocal: what a measurement may be."""

    is_isotropic = False

    def eval(self, wi, wo):
        return CLOTH.eval(wi, wo) * (1 + wi[..., :1])

    def fingerprint(self):
        return b""


def test_utia_values_come_back_at_their_nodes(tmp_path):
    (tmp_path / "cloth.bin").write_bytes(utia(OneSided()))
    brdf = read_brdf(tmp_path / "cloth.bin")
    v = utia_directions()[::7]
    assert_allclose(brdf.eval(v[:, None], v), OneSided().eval(v[:, None], v), rtol=1e-6)
    assert brdf.about == "a UTIA table of 6 x 48 x 6 x 48 directions, its values taken for 1/sr"


@pytest.mark.parametrize("half", [False, True])
def test_csail_values_come_back_at_the_middles_of_their_bins(tmp_path, half):
    (tmp_path / "cloth.binary").write_bytes(csail(OneSided(), half=half))
    brdf = read_brdf(tmp_path / "cloth.binary")
    wi, wo = (v.reshape(-1, 3)[1:] for v in csail_pairs((4, 5, 6, 8), half=half))
    assert_allclose(brdf.eval(wi, wo), OneSided().eval(wi, wo), rtol=1e-5)
    assert np.isnan(read_brdf(tmp_path / "cloth.binary").values[:, 0, 0, 0, 0]).all()


def test_the_other_half_of_a_csail_file_is_there_with_light_and_viewer_exchanged(tmp_path):
    (tmp_path / "cloth.binary").write_bytes(csail(CLOTH, (6, 6, 6, 12), half=True))
    brdf = read_brdf(tmp_path / "cloth.binary")
    wi, wo = (v.reshape(-1, 3)[1:] for v in csail_pairs((6, 6, 6, 12), half=True))
    assert_allclose(brdf.eval(wo, wi), brdf.eval(wi, wo), rtol=1e-9)


def test_past_the_last_ring_its_values_stand(tmp_path):
    (tmp_path / "cloth.bin").write_bytes(utia(CLOTH))
    brdf = read_brdf(tmp_path / "cloth.bin")
    up = np.array([0.0, 0.0, 1.0])
    at = [np.array([np.sin(t), 0, np.cos(t)]) for t in np.radians([75.0, 85.0])]
    assert_allclose(brdf.eval(at[1], up), brdf.eval(at[0], up), rtol=1e-9)


def test_a_table_holds_the_mean_of_both_orders(tmp_path):
    (tmp_path / "cloth.bin").write_bytes(utia(OneSided()))
    brdf = read_brdf(tmp_path / "cloth.bin")
    table = tabulate(brdf, GRID)
    wi, wo = (d[GRID.mask()] for d in GRID.directions())
    expected = (brdf.eval(wi, wo) + brdf.eval(wo, wi)) / 2
    assert_allclose(table.values[:, GRID.mask()].T, expected, rtol=1e-6)
    turned = table.eval(turn(wi, np.pi / 4), turn(wo, np.pi / 4))
    assert np.abs(turned / table.eval(wi, wo) - 1).max() > 0.05


def _csail_with(index, value):
    content = bytearray(csail(CLOTH))
    content[4 * index : 4 * index + 4] = np.array(value, "<i4").tobytes()
    return bytes(content)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (
            csail(CLOTH)[:-1],
            r"cloth has 11,583 bytes: with the sizes 4 x 5 x 6 x 8 it takes 11,584",
        ),
        (_csail_with(0, 3), r"cloth has 11,584 bytes: with the sizes 3 x 5 x 6 x 8 it takes 8,704"),
        (_csail_with(30, 0x7FC00000), r"cloth has 1 of 2,880 samples that are not finite"),
        (utia(CLOTH)[:-8] + np.array(np.inf).tobytes(), "has 1 of 248,832 samples that are not"),
        (utia(CLOTH)[:-8] + np.array(1e300).tobytes(), "has 1 of 248,832 samples that are not"),
    ],
    ids=["short", "long", "nan", "infinite", "huge"],
)
def test_a_damaged_file_is_refused_in_one_line(tmp_path, content, said):
    (tmp_path / "cloth").write_bytes(content)
    with pytest.raises(FormatError, match=said) as raised:
        read_brdf(tmp_path / "cloth")
    assert "\n" not in str(raised.value)


def test_what_is_measured_becomes_a_library_on_the_usual_grid(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "cloth.binary").write_bytes(csail(CLOTH))
    found, _ = find_brdfs([tmp_path / "in"])
    assert found[0].usual_grid == Grid.anisotropic()
    built = build_library([tmp_path / "in"], tmp_path / "x.brdflib", grid=GRID)
    assert built.library.grid == GRID


# Zarr


def test_a_table_comes_back_from_zarr_as_it_was(tmp_path):
    table = tabulate(CLOTH, GRID, name="cloth")
    for _ in range(2):  # the second replaces the first
        write_brdf(tmp_path / "cloth.zarr", table)
    again = read_brdf(tmp_path / "cloth.zarr")
    np.testing.assert_array_equal(again.values, table.values)
    assert (again.grid, again.name) == (GRID, "cloth")
    assert not list(tmp_path.glob(".*"))


def test_any_zarr_reader_reads_it(tmp_path):
    import zarr

    table = tabulate(CLOTH, GRID)
    write_zarr(tmp_path / "cloth.zarr", table)
    array = zarr.open_array(str(tmp_path / "cloth.zarr"), mode="r")
    np.testing.assert_array_equal(array[0], table.values)
    assert array.attrs["unit"] == "1/sr"


def test_a_store_replaces_another_program_s_whole(tmp_path):
    """Whatever is in it: groups are folders."""
    path = tmp_path / "cloth.zarr"
    (path / "group" / "array").mkdir(parents=True)
    (path / "zarr.json").write_text("{}")
    write_zarr(path, tabulate(CLOTH, GRID))
    assert {file.name for file in path.iterdir()} == {"zarr.json", "c.0.0.0.0.0.0"}
    assert list(tmp_path.iterdir()) == [path]


def test_stores_are_found_among_other_files_and_named_one_by_one(tmp_path):
    write_zarr(tmp_path / "a" / "cloth.zarr", tabulate(CLOTH, GRID, name="cloth"))
    (tmp_path / "a" / "README.txt").write_text("cloth")
    found, skipped = find_brdfs([tmp_path / "a"])
    assert [(item.name, item.grid) for item in found] == [("cloth", GRID)]
    assert [item.reason for item in skipped] == ["is text"]
    assert found[0].sha256 == ZarrStore.open(tmp_path / "a" / "cloth.zarr").chunk(0).sha256()


def _spoil(folder, name, change):
    write_zarr(folder / "cloth.zarr", tabulate(CLOTH, GRID))
    path = folder / "cloth.zarr" / name
    path.write_bytes(change(path.read_bytes()))
    return folder / "cloth.zarr"


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("zarr.json", lambda _: b"[]", "cloth.zarr is no Zarr store of tables"),
        ("zarr.json", lambda b: b.replace(b'"gzip"', b'"zstd"'), "its codecs is another"),
        ("zarr.json", lambda b: b.replace(b"phi_h", b"phi_x"), "is no Zarr store"),
        ("zarr.json", lambda b: b.replace(b'"scale": 1.0', b'"scale": -1.0'), "scale -1.0"),
        ("c.0.0.0.0.0.0", lambda b: b[: len(b) // 2], "fewer than the 9,216 bytes"),
        ("c.0.0.0.0.0.0", lambda _: b"cloth", "cannot be read"),
    ],
)
def test_a_damaged_store_is_refused_in_one_line(tmp_path, name, change, said):
    with pytest.raises(FormatError, match=said) as raised:
        read_brdf(_spoil(tmp_path, name, change))
    assert "\n" not in str(raised.value)


def test_convert_takes_a_scale(tmp_path):
    (tmp_path / "cloth.bin").write_bytes(utia(CLOTH))
    words = ["convert", str(tmp_path / "cloth.bin"), str(tmp_path / "cloth.zarr"), "--grid", "6x8x4x4"]  # fmt: skip
    done = CliRunner().invoke(app, [*words, "--scale", "0.5"])
    assert done.exit_code == 0, done.output
    assert done.stderr.startswith(f"{tmp_path / 'cloth.zarr'}: cloth, 6 x 8 x 4 x 4 cells, ")
    assert "dB of its own values on a lit sphere" in done.stderr
    plain = tabulate(read_brdf(tmp_path / "cloth.bin"), GRID)
    assert_allclose(read_brdf(tmp_path / "cloth.zarr").values, plain.values / 2, rtol=1e-6)
    refused = CliRunner().invoke(app, [*words, "--scale", "-1", "--force"])
    assert str(refused.exception) == "a scale of -1 is none: expected a positive number."


def test_a_recipe_of_a_measured_cloth_and_a_paint_is_mixed_on_a_grid_with_phi_h(tmp_path):
    table = tabulate(CLOTH, GRID)
    write_zarr(tmp_path / "cloth.zarr", table)
    library, recipe = open_recipe([f"{tmp_path / 'cloth.zarr'}=.25, gold-paint=.75"])
    assert library.grid == GRID
    paint = tabulate(library.material("gold-paint"), GRID)
    mixed = mix(library, recipe)
    assert_allclose(mixed.values, 0.25 * table.values + 0.75 * paint.values, rtol=1e-5)
