"""MERL tables: a hand-made file first, then round trips, then every way in which a file can be wrong."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_array_equal
from written_files import MERL_SHAPE, merl

from halfway import MERL, Grid, TabularBrdf
from halfway.errors import FormatError, OutputError
from halfway.formats import (
    MerlFile,
    encode_header,
    find_brdfs,
    read_brdf,
    read_merl,
    write_merl,
)
from halfway.formats.merl import SCALES
from halfway.halfdiff import Axis

GRID = Grid.merl(*MERL_SHAPE)
N_BYTES = 12 + 8 * 3 * 2 * 3 * 4  # 588

shapes = st.tuples(*[st.integers(1, 4)] * 3)
stored = st.floats(allow_nan=False, allow_infinity=False)  # any double, -0.0 and subnormals too
measured = st.floats(0, 1e6, width=32) | st.just(float("nan"))


@pytest.fixture
def path(tmp_path):
    return tmp_path / "gold-paint.binary"


class TestByHand:
    def test_a_sample_of_1500_is_one_per_steradian_times_the_channels_scale(self, path):
        path.write_bytes(merl(np.full(72, 1500.0)))
        table = read_merl(path)
        assert table.name == "gold-paint"
        assert table.grid == GRID
        assert_array_equal(table.values[:, 0, 0, 0], np.float32([1.0, 1.15, 1.66]))

    def test_samples_run_over_channel_theta_h_theta_d_phi_d(self, path):
        path.write_bytes(merl())
        assert MerlFile.read(path).samples[2, 1, 0, 3] == 2 * 24 + 1 * 12 + 0 * 4 + 3

    def test_negative_samples_are_unmeasured_and_written_as_minus_one(self, path):
        samples = np.ones(72)
        samples[[0, 30, 71]] = -1, -0.5, -1e300
        path.write_bytes(merl(samples))
        table = read_merl(path)
        assert_array_equal(np.flatnonzero(np.isnan(table.values)), [0, 30, 71])
        assert_array_equal(MerlFile.from_table(table).samples.ravel()[[0, 30, 71]], -1)

    def test_the_header_of_the_database(self):
        assert encode_header(MERL) == b"\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"

    def test_samples_are_written_as_they_are(self, path):
        MerlFile(GRID, np.arange(72.0).reshape(3, *MERL_SHAPE)).write(path)
        assert path.read_bytes() == merl()

    def test_samples_in_another_memory_order_are_written_in_the_files(self, path):
        MerlFile(GRID, np.asfortranarray(np.arange(72.0).reshape(3, *MERL_SHAPE))).write(path)
        assert path.read_bytes() == merl()


@given(st.data(), shapes)
def test_reading_and_writing_gives_the_same_bytes_whatever_the_samples(
    tmp_path_factory, data, shape
):
    samples = data.draw(arrays("<f8", (3, *shape), elements=stored))
    folder = tmp_path_factory.mktemp("round-trip")
    before, after = folder / "before.binary", folder / "after.binary"
    before.write_bytes(merl(samples, shape))
    MerlFile.read(before).write(after)
    assert after.read_bytes() == before.read_bytes()


@given(st.data(), shapes)
def test_a_table_survives_its_file_and_the_file_its_table(tmp_path_factory, data, shape):
    """float32 / scale in float64, times scale, rounds back to the same float32."""
    values = data.draw(arrays(np.float32, (3, *shape), elements=measured))
    path = tmp_path_factory.mktemp("table") / "a.binary"
    write_merl(path, TabularBrdf(values, Grid.merl(*shape)))
    written = path.read_bytes()
    table = read_merl(path)
    assert_array_equal(table.values, values)
    write_merl(path, table)
    assert path.read_bytes() == written


def test_the_scales_are_those_of_the_database():
    assert_array_equal(SCALES, [1 / 1500, 1.15 / 1500, 1.66 / 1500])


def _with(position: int, value: float) -> bytes:
    samples = np.ones(72)
    samples[position] = value
    return merl(samples)


WRONG = {
    "truncated": (
        merl()[:92],
        (
            "gold-paint.binary is 496 bytes shorter than its header says: a 2 x 3 x 4 RGB table takes 588 bytes, this file "
            "has 92. It is probably truncated; compare it with the original download."
        ),
    ),
    "too long": (
        merl() + b"12345678",
        (
            "gold-paint.binary is 8 bytes longer than its header says: a 2 x 3 x 4 RGB table takes 588 bytes, this file "
            "has 596. It is probably damaged, or holds something else as well; compare it with the original download."
        ),
    ),
    "not a number": (
        _with(31, np.nan),
        (
            "gold-paint.binary has a NaN sample (1 of 72 are not finite; the first is channel G, cell [0, 1, 3]): expected "
            "finite samples, negative where unmeasured. It is damaged; compare it with the original download."
        ),
    ),
    "infinite": (
        _with(71, -np.inf),
        (
            "gold-paint.binary has an infinite sample (1 of 72 are not finite; the first is channel B, cell [1, 2, 3]): "
            "expected finite samples, negative where unmeasured. It is damaged; compare it with the original download."
        ),
    ),
    "negative size": (
        merl(sizes=(2, -3, 4)),
        (
            "gold-paint.binary states a negative size, 2 x -3 x 4: expected three positive sizes, 90 x 90 x 180 in the "
            "database. It is damaged, or no MERL table."
        ),
    ),
    "zero size": (
        merl(sizes=(2, 3, 0)),
        (
            "gold-paint.binary states a zero size, 2 x 3 x 0: expected three positive sizes, 90 x 90 x 180 in the "
            "database. It is damaged, or no MERL table."
        ),
    ),
    "absurd size": (
        merl(sizes=(2**31 - 1, 2**31 - 1, 2**31 - 1)),
        (
            "gold-paint.binary states an absurd size, 2147483647 x 2147483647 x 2147483647: that takes "
            "237,684,487,210,751,619,608,478,744,564 bytes, this file has 588. "
            "It is no MERL table, or not in little-endian order."
        ),
    ),
    "text": (
        b"Copyright 2006, all rights reserved",
        "gold-paint.binary is text: expected a MERL table, 12 bytes of sizes and then samples.",
    ),
    "another format": (
        b"\x93NUMPY" + bytes(600),
        "gold-paint.binary is a NumPy array: expected a MERL table, 12 bytes of sizes and then samples.",
    ),
    "empty": (
        b"",
        "gold-paint.binary is empty: expected a MERL table, 12 bytes of sizes and then samples.",
    ),
    "shorter than a header": (
        b"\x5a\0\0\0\x5a",
        (
            "gold-paint.binary is 5 bytes long: a MERL table begins with three sizes, 12 bytes. "
            "It is truncated, or no MERL table."
        ),
    ),
}


@pytest.mark.parametrize(("wrong", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_file_gets_its_own_line(path, wrong, message):
    path.write_bytes(wrong)
    with pytest.raises(FormatError) as error:
        read_merl(path)
    assert str(error.value) == message


class TestOtherWriters:
    """Files of the same samples under other headers: right as a table, and kept as they are as a file."""

    GRID = Grid.merl(8, 8, 16)

    @pytest.fixture
    def table(self):
        values = np.random.default_rng(0).random((3, 8, 8, 16)).astype(np.float32)
        values[:, ~self.GRID.mask()] = np.nan
        return TabularBrdf(values, self.GRID, name="gold-paint")

    def headed(self, table, *sizes) -> bytes:
        return merl(MerlFile.from_table(table).samples, sizes)

    @pytest.mark.parametrize("sizes", [(16, 8, 8), (8, 16, 8), (1024, 1, 1), (8, 128, 1)])
    def test_sizes_with_the_right_product_alone(self, path, table, sizes):
        path.write_bytes(self.headed(table, *sizes))
        assert read_merl(path).grid == self.GRID
        assert_array_equal(read_merl(path).values, table.values)
        assert MerlFile.read(path).to_table().grid == self.GRID
        MerlFile.read(path).write(path.with_suffix(".copy"))
        assert path.with_suffix(".copy").read_bytes() == path.read_bytes()

    def test_axes_in_another_order_under_the_right_sizes(self, path, table):
        samples = MerlFile.from_table(table).samples
        path.write_bytes(merl(samples.transpose(0, 2, 1, 3), (8, 8, 16)))
        assert_array_equal(read_merl(path).values, table.values)

    def test_phi_d_over_a_whole_turn(self, path, table):
        samples = MerlFile.from_table(table).samples
        path.write_bytes(merl(np.concatenate([samples, samples], axis=3), (8, 8, 32)))
        assert read_merl(path).grid == self.GRID
        assert_array_equal(read_merl(path).values, table.values)

    def test_a_library_takes_the_grid_that_the_samples_draw(self, path, table):
        path.write_bytes(self.headed(table, 16, 8, 8))
        (found,), _ = find_brdfs([path])
        assert found.grid == found.load().grid == self.GRID

    def test_an_order_that_nothing_tells_is_noted(self, path):
        path.write_bytes(merl(np.ones(3 * MERL.size), (180, 90, 90)))
        with pytest.warns(
            UserWarning, match="gold-paint states 180 x 90 x 90, as many cells as the"
        ):
            assert read_merl(path).grid == Grid.merl(180, 90, 90)

    @pytest.mark.parametrize(
        ("order", "samples", "named"),
        [
            (">", "f8", "big-endian float64"),
            ("<", "f4", "little-endian float32"),
            (">", "f4", "big-endian float32"),
        ],
    )
    @pytest.mark.parametrize("sizes", [MERL_SHAPE, (90, 2, 300)])
    def test_samples_of_another_order_or_type_are_named(self, path, order, samples, named, sizes):
        body = np.ones(3 * np.prod(sizes), order + samples).tobytes()
        path.write_bytes(struct.pack(f"{order}3i", *sizes) + body)
        message = (
            f"gold-paint.binary is a MERL table of {named}: expected little-endian float64, as in the database. "
            "Convert it with the program that wrote it."
        )
        for read in (read_merl, read_brdf):
            with pytest.raises(FormatError) as error:
                read(path)
            assert str(error.value) == message


def test_a_folder_is_not_a_file(tmp_path):
    with pytest.raises(FormatError, match="is a folder: expected one file"):
        read_merl(tmp_path)


def test_a_file_that_is_not_there(path):
    with pytest.raises(FormatError, match=r"gold-paint\.binary does not exist"):
        read_merl(path)


def test_a_sample_beyond_float32_is_not_made_infinite(path):
    path.write_bytes(_with(5, 1e300))
    with pytest.raises(FormatError, match=r"has a sample of 1e\+300: a table holds float32"):
        read_merl(path)


@pytest.mark.parametrize(("value", "what"), [(-0.25, "negative"), (np.inf, "infinite")])
def test_a_table_that_a_file_cannot_hold_is_not_written(path, value, what):
    values = np.ones((3, *MERL_SHAPE), np.float32)
    values[1, 0, 2, 3] = value
    with pytest.raises(OutputError, match=f"gold has 1 {what} values"):
        write_merl(path, TabularBrdf(values, GRID, name="gold"))
    assert not path.exists()


def test_a_grid_that_a_header_cannot_state_is_not_written(path):
    flat = Grid((Axis("theta_h", 5, np.pi / 2, power=2), Axis("theta_d", 6, np.pi / 2)))
    with pytest.raises(OutputError) as error:
        write_merl(path, TabularBrdf(np.ones((3, 5, 6), np.float32), flat, name="gold"))
    assert str(error.value) == (
        "gold has a grid of 5 x 6 cells over theta_h, theta_d: a MERL file holds theta_h (square-root spaced), "
        "theta_d and phi_d. Sample it on such a grid first: `halfway convert IN OUT.binary --grid 90x90x180`."
    )
    evenly = Grid((Axis("theta_h", 5, np.pi / 2), *GRID.axes[1:]))
    with pytest.raises(OutputError, match="square-root"):
        encode_header(evenly)
