"""Our reader of HDF5 against the C library's, and what it refuses."""

import io
import struct

import h5py
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from halfway.formats.hdf5 import Hdf5Error, read_hdf5
from halfway.formats.sources import members


def written(fill, **options):
    buffer = io.BytesIO()
    with h5py.File(buffer, "w", **options) as file:
        fill(file)
    return buffer.getvalue()


@pytest.mark.parametrize("dtype", ["<f4", "<f8"])
@pytest.mark.parametrize("shape", [(1,), (6, 21), (2, 3, 4)])
def test_arrays_come_back(dtype, shape):
    values = np.random.default_rng(0).normal(size=shape).astype(dtype)
    content = written(lambda file: file.create_dataset("some/where/kernel:0", data=values))
    read = read_hdf5(content)["some/where/kernel:0"].array()
    assert read.dtype == dtype
    assert_array_equal(read, values)


@pytest.mark.parametrize(
    "names",
    [
        np.array([b"dense", b"dense_1"]),  # of a fixed length, as older Keras writes
        [b"dense", "dense_1 é".encode()],  # shared in a heap, as newer Keras writes
        ["dense", "dense_1 é"],
        np.array([], "S1"),
        np.array([]),
    ],
)
def test_lists_of_names_come_back(names):
    def fill(file):
        file.attrs["backend"] = "tensorflow"
        file.attrs["layer_names"] = names
        file.attrs["é"] = 1

    expected = [n.decode() if isinstance(n, bytes) else n for n in list(names)]
    root = read_hdf5(written(fill))
    assert root.strings("layer_names", most=2) == expected
    assert root.strings("weight_names", most=2) is None


def test_a_group_of_many_has_a_tree_of_several_levels():
    """Each leaf of the tree names at most 8, each node above it at most 32."""
    names = [f"layer_{i}" for i in range(600)]
    content = written(lambda file: [file.create_group(name) for name in names])
    root = read_hdf5(content)
    assert all(root[name].strings("weight_names", most=1) is None for name in names)
    with pytest.raises(Hdf5Error, match="there is no 'layer_600'"):
        root["layer_600"]


def test_a_header_may_go_on_elsewhere():
    """Attributes that were added later are in blocks of their own."""

    def fill(file):
        for i in range(40):
            file.attrs[f"names_{i}"] = np.array([b"dense"] * (i + 1))

    root = read_hdf5(written(fill))
    assert all(len(root.strings(f"names_{i}", most=40)) == i + 1 for i in range(40))


def test_equals_the_c_library_on_the_published_networks(shared_data):
    archive = shared_data / "nbrdf" / "merl_nbrdf.zip"
    packed = [m for m in members(archive) if m.label in ("chrome.h5", "gold-paint.h5")]
    assert len(packed) == 2
    for member in packed:
        with member.open() as stream:
            content = stream.read()
        root, theirs = read_hdf5(content), h5py.File(io.BytesIO(content))
        for layer in root.strings("layer_names", most=9):
            for weight in root[layer].strings("weight_names", most=9):
                assert_array_equal(root[layer][weight].array(), np.asarray(theirs[layer][weight]))


@pytest.mark.parametrize(
    ("fill", "options", "message"),
    [
        (lambda f: f.create_dataset("x", data=np.ones(9), chunks=(3,)), {}, "stored in chunks"),
        (lambda f: f.create_dataset("x", data=np.ones(9), compression="gzip"), {}, "in chunks"),
        (lambda f: f.create_dataset("x", data=np.ones(9, ">f4")), {}, "something else than little"),
        (lambda f: f.create_dataset("x", data=np.ones(9, int)), {}, "something else than little"),
        (lambda f: f.create_dataset("x", (0, 3), "<f4"), {}, "is empty or longer than the file"),
        (lambda f: f.create_dataset("x", (2**40,), "<f4"), {}, "is empty or longer than the file"),
        (lambda f: f.create_dataset("x", (9,), "<f4", external=[("/etc/passwd", 0, 36)]), {}, "is asked for where"),
        (lambda f: f.create_group("x"), {}, "is no array"),
        (lambda f: f.__setitem__("x", h5py.ExternalLink("/etc/passwd", "/")), {}, "there is no .x."),
        (lambda f: f.__setitem__("x", h5py.SoftLink("/y")), {}, "is asked for where"),
        (lambda f: f.create_group("x"), {"libver": "latest"}, "superblock is of another version"),
    ],
)  # fmt: skip
def test_what_keras_does_not_write_is_refused(fill, options, message):
    """Links to other files among it: nothing but the file itself is ever opened."""
    with pytest.raises(Hdf5Error, match=message):
        read_hdf5(written(fill, **options))["x"].array()


def test_a_long_list_of_names_is_refused():
    content = written(lambda file: file.attrs.__setitem__("layer_names", [b"a"] * 17))
    with pytest.raises(Hdf5Error, match="layer_names lists 17: at most 16 are read"):
        read_hdf5(content).strings("layer_names", most=16)


def test_a_tree_that_leads_back_to_itself_ends():
    content = bytearray(written(lambda file: file.create_group("x")))
    tree = content.index(b"TREE")
    content[tree + 32 : tree + 40] = struct.pack("<Q", tree)
    with pytest.raises(Hdf5Error, match="B-tree is longer than the file"):
        read_hdf5(bytes(content))["x"]


def test_a_header_that_leads_back_to_itself_ends():
    content = bytearray(written(lambda file: file.attrs.__setitem__("a", np.array([b"dense"]))))
    (root,) = struct.unpack_from("<Q", content, 64)
    # The first message, which is the symbol table, becomes a continuation to the block that it is in.
    content[root + 16 : root + 18] = struct.pack("<H", 16)
    content[root + 24 : root + 40] = struct.pack("<QQ", root + 16, 24)
    with pytest.raises(Hdf5Error, match="header is longer than the file"):
        read_hdf5(bytes(content)).strings("b", most=1)
