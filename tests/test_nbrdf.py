"""Neural BRDFs: against a plain float64 evaluation of the network, then every way in which a file can be wrong."""

import io
import zipfile

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from written_files import NBRDF_SHAPES, keras, keras_model, keras_numbered, nbrdf_layers

from halfway import MERL, Grid, build_library, from_half_diff, open_library, to_half_diff
from halfway.errors import FormatError
from halfway.formats import NeuralBrdf, read_nbrdf, read_nbrdf_archive
from halfway.library import Origin

TINY = Grid.merl(5, 6, 8)


def dense(layers: list[np.ndarray], wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """The network as its authors describe it: six inputs a pair of directions, one layer after the other, float64."""
    W1, b1, W2, b2, W3, b3 = (x.astype(np.float64) for x in layers)
    h, _, d, phi = to_half_diff(wi, wo)
    zero = np.zeros_like(h)
    x = np.stack(
        [np.sin(h), zero, np.cos(h), np.sin(d) * np.cos(phi), np.sin(d) * np.sin(phi), np.cos(d)],
        axis=-1,
    )
    x = np.maximum(x @ W1 + b1, 0)
    x = np.maximum(x @ W2 + b2, 0)
    return np.maximum(np.exp(x @ W3 + b3) - 1, 0)


def pairs(n: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    w = np.random.default_rng(seed).normal(size=(2, n, 3))
    w[..., 2] = abs(w[..., 2])
    wi, wo = w / np.linalg.norm(w, axis=-1, keepdims=True)
    return wi, wo


def close(actual, expected):
    # The exponent is a sum of 21 float32 products of some tens: 21 x 30 x 2^-24 = 4e-5, absolute, and exp makes it relative.
    assert_allclose(actual, expected, rtol=4e-5, atol=4e-5)


def test_a_network_of_biases_alone_is_a_constant():
    layers = [np.zeros(shape, np.float32) for shape in NBRDF_SHAPES]
    layers[5][:] = np.log([1.5, 1.0, 0.5])
    wi, wo = pairs(4)
    assert_allclose(NeuralBrdf(*layers).eval(wi, wo), np.tile([0.5, 0, 0], (4, 1)), atol=1e-6)


@given(st.integers(0, 10_000))
def test_values_are_those_of_the_network_applied_layer_by_layer(seed):
    layers, (wi, wo) = nbrdf_layers(seed), pairs(20, seed + 1)
    close(read_nbrdf(keras(layers)).eval(wi, wo), dense(layers, wi, wo))


def test_samples_on_a_grid_are_the_networks_values_at_its_cell_centres():
    layers = nbrdf_layers()
    expected = np.moveaxis(dense(layers, *from_half_diff(TINY.centres())), -1, 0)
    samples = NeuralBrdf(*layers).sample_rows(TINY, slice(1, 4))
    close(samples, np.where(TINY.mask(), expected, np.nan)[:, 1:4])


def test_the_order_of_the_layers_is_the_files_own_not_the_alphabets():
    network = read_nbrdf(keras(nbrdf_layers(), order=("z", "m", "a")))
    assert_array_equal(network.W1, nbrdf_layers()[0])
    assert_array_equal(network.b3, nbrdf_layers()[5])


@pytest.mark.parametrize(
    "content",
    [keras_model(keras(nbrdf_layers())), keras_numbered(nbrdf_layers())],
    ids=["a whole model", "numbered weights"],
)
def test_other_files_of_keras_hold_the_same_network(content):
    assert read_nbrdf(content).fingerprint() == read_nbrdf(keras(nbrdf_layers())).fingerprint()


def test_a_large_grid_is_computed_in_pieces_as_a_small_one():
    """More cells in a row of theta_h than are computed at once, and a rest."""
    layers, grid = nbrdf_layers(), Grid.merl(2, 33, 67)
    expected = np.moveaxis(dense(layers, *from_half_diff(grid.centres())), -1, 0)
    samples = NeuralBrdf(*layers).sample_rows(grid, slice(None))
    close(samples, np.where(grid.mask(), expected, np.nan))


def test_a_path_and_its_bytes_give_the_same_network(tmp_path):
    path = tmp_path / "gold.h5"
    path.write_bytes(keras(nbrdf_layers()))
    assert read_nbrdf(path).fingerprint() == read_nbrdf(path.read_bytes()).fingerprint()
    assert read_nbrdf(path).fingerprint() != read_nbrdf(keras(nbrdf_layers(1))).fingerprint()


class TestArchive:
    def test_is_read_in_memory_by_name(self, tmp_path):
        path = tmp_path / "all.zip"
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("fits/silver.h5", keras(nbrdf_layers(1)))
            archive.writestr("fits/gold.h5", keras(nbrdf_layers(2)))
            archive.writestr("fits/gold.json", "{}")
        networks = read_nbrdf_archive(path).models
        assert list(networks) == ["gold", "silver"]
        assert_array_equal(networks["silver"].W2, nbrdf_layers(1)[2])
        assert list(tmp_path.iterdir()) == [path]

    def test_a_library_of_it_says_where_it_comes_from(self, tmp_path):
        """And so does one that is made of that library, and of more; a person's word on source and licence counts more."""
        with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
            archive.writestr("gold.h5", keras(nbrdf_layers(2)))
        origin = open_library(tmp_path / "all.zip").origin
        assert "stand-in" in origin.description
        assert origin.source
        assert origin.licence
        first = build_library([tmp_path / "all.zip"], tmp_path / "a.brdflib", grid=TINY).library
        assert first.origin == origin
        more = [first.path, "builtin:synthetic-2"]
        both = build_library(more, tmp_path / "b.brdflib", grid=TINY).library.origin
        assert both.licence == f"{origin.licence}; CC0-1.0"
        mine = build_library(
            [first.path], tmp_path / "c.brdflib", origin=Origin("files", "me", "mine")
        )
        assert mine.library.origin == Origin(origin.description, "me", "mine")

    def test_without_a_network_is_an_error(self, tmp_path):
        path = tmp_path / "all.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("README.txt", "nothing here")
        with pytest.raises(FormatError, match=r"all\.zip holds no neural BRDF: expected"):
            read_nbrdf_archive(path)

    def test_that_is_no_zip_is_an_error(self, tmp_path):
        path = tmp_path / "all.zip"
        path.write_bytes(keras(nbrdf_layers()))
        with pytest.raises(FormatError, match=r"all\.zip is no zip: expected"):
            read_nbrdf_archive(path)


def _reshaped() -> bytes:
    layers = nbrdf_layers()
    layers[0], layers[4] = layers[0][:5], layers[4][:, :1]
    return keras(layers)


def _not_finite() -> bytes:
    layers = nbrdf_layers()
    layers[2][3, 4] = np.nan
    return keras(layers)


def _nameless() -> bytes:
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        file["tables"] = np.zeros(3)
    return buffer.getvalue()


WRONG = {
    "text": (b"{}", "gold.h5 is text: expected the Keras weights of a neural BRDF (HDF5)."),
    "binary": (
        bytes(range(200, 256)),
        "gold.h5 is no HDF5 file: expected the Keras weights of a neural BRDF (HDF5).",
    ),
    "another HDF5 file": (
        _nameless(),
        "gold.h5 is an HDF5 file without layer_names: expected the Keras weights of a neural BRDF.",
    ),
    "wrong shapes": (
        _reshaped(),
        (
            "gold.h5 has layers of shapes 5x21, 21, 21x21, 21, 21x1, 3: a neural BRDF has "
            "6x21, 21, 21x21, 21, 21x3, 3. It is a network for something else."
        ),
    ),
    "not finite": (
        _not_finite(),
        "gold.h5 has weights that are not finite: expected finite numbers. It is damaged, or was not trained.",
    ),
    "integers": (
        keras([w.astype(np.int32) for w in nbrdf_layers()]),
        (
            "gold.h5 is no HDF5 as Keras writes it (an array holds something else than little-endian float32 or float64): "
            "expected the weights of a neural BRDF. Compare it with the original download."
        ),
    ),
}


@pytest.mark.parametrize(("wrong", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_file_gets_its_own_line(wrong, message):
    with pytest.raises(FormatError) as error:
        read_nbrdf(wrong, name="gold.h5")
    assert str(error.value) == message


@pytest.mark.parametrize(
    "damaged",
    [
        keras(nbrdf_layers(), omit="b/kernel:0"),
        keras(nbrdf_layers())[:5000],
        keras(nbrdf_layers())[:40],
    ],
    ids=["a weight is missing", "cut in the middle", "cut in the header"],
)
def test_a_damaged_file_is_one_line(damaged):
    with pytest.raises(
        FormatError, match=r"^gold\.h5 is no HDF5 as Keras writes it \(.*\): expected"
    ) as error:
        read_nbrdf(damaged, name="gold.h5")
    assert "\n" not in str(error.value)


def test_a_file_too_large_for_a_network_is_not_read(tmp_path):
    path = tmp_path / "gold.h5"
    with path.open("wb") as file:
        file.write(keras(nbrdf_layers()))
        file.truncate(5_000_000)
    with pytest.raises(
        FormatError, match=r"gold\.h5 is an HDF5 file of 5,000,000 bytes: a neural BRDF takes"
    ):
        read_nbrdf(path)


@pytest.fixture(scope="module")
def networks(shared_data):
    return read_nbrdf_archive(shared_data / "nbrdf" / "merl_nbrdf.zip").models


class TestPublished:
    """The fits of the MERL materials."""

    def test_there_are_100_in_the_order_of_their_names(self, networks):
        assert len(networks) == 100
        assert list(networks) == sorted(networks)
        assert "gold-metallic-paint3" in networks

    @pytest.mark.parametrize("name", ["gold-paint", "chrome", "blue-fabric"])
    def test_they_agree_with_a_plain_evaluation(self, networks, name):
        brdf, (wi, wo) = networks[name], pairs(2000)
        layers = [brdf.W1, brdf.b1, brdf.W2, brdf.b2, brdf.W3, brdf.b3]
        close(brdf.eval(wi, wo), dense(layers, wi, wo))

    def test_they_are_non_negative_where_measured_and_nothing_elsewhere(self, networks):
        samples = networks["chrome"].sample_rows(MERL, slice(0, 90, 15))
        dark = ~MERL.mask()[::15]
        assert_array_equal(np.isnan(samples), np.broadcast_to(dark, samples.shape))
        assert np.nanmin(samples) >= 0
