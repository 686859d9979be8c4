"""Hostile files: whatever the bytes, a reader gives a material or one line that says what is wrong.

Each case is a valid file, spoilt: cut, with bytes changed, with lengths and sizes that lie. No crash, no hang, no memory
beyond a small multiple of the file. ``HALFWAY_FUZZ_EXAMPLES`` makes it run for as long as one likes.
"""

import io
import os
import struct
import tracemalloc
import warnings
import zipfile

import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from halfway import Brdf, Grid, TabularBrdf
from halfway.errors import HalfwayError
from halfway.fetch.unpack import unpack
from halfway.formats import find_brdfs, read_brdf, write_brdf

EXAMPLES = int(os.environ.get("HALFWAY_FUZZ_EXAMPLES", "60"))
UP = np.array([0.0, 0.0, 1.0])

fuzz = settings(
    max_examples=EXAMPLES,
    deadline=2000,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)

# Numbers that files lie with: nothing, all, signs, powers of two and their neighbours.
lies = st.sampled_from(
    [0, 1, 2, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 2**62, 2**63, 2**64 - 1]
)  # fmt: skip


# Where (headers are short and matter most), how, and with what.
changes = st.lists(
    st.tuples(
        st.one_of(st.integers(0, 600), st.floats(0, 1)),
        st.integers(0, 4),
        st.integers(1, 255),
        st.sampled_from([1, 2, 4, 8]),
        lies,
    ),
    min_size=1,
    max_size=6,
)


def spoilt(valid, changes):
    """The bytes of a valid file with some of them changed, cut out, doubled or cut off."""
    content = bytearray(valid)
    for where, how, n, size, lie in changes:
        at = min(where, len(content)) if isinstance(where, int) else int(where * len(content))
        match how:
            case 0:
                content[at : at + 1] = bytes([n])
            case 1:
                content[at : at + size] = (lie % 256**size).to_bytes(size, "little")
            case 2:
                del content[at : at + n]
            case 3:
                content[at:at] = content[at : at + n]
            case _:
                del content[at:]
    return bytes(content)


def require_harmless(read, content, path):
    """Reading gives a material that can be evaluated, or a `HalfwayError` of one line; in little memory."""
    path.write_bytes(content)
    said = ""
    tracemalloc.start()
    try:
        with warnings.catch_warnings():
            # A warning is for people; that a damaged file warns is no fault.
            warnings.simplefilter("ignore")
            brdf = read(path)
            values = brdf.eval(UP, UP) if isinstance(brdf, Brdf) else np.zeros(3)
        assert values.shape == (3,)
    except HalfwayError as error:
        said = str(error)
    finally:
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert not said or ("\n" not in said and 20 < len(said) < 1000), said
    assert most < 20 * len(content) + 20_000_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


def _tiny():
    grid = Grid.merl(4, 3, 4)
    return TabularBrdf(np.full((3, *grid.shape), 0.2, np.float32), grid, name="clay")


def _merl(folder):
    write_brdf(folder / "clay.binary", _tiny())
    return (folder / "clay.binary").read_bytes()


def _rgl():
    from halfway.formats.tensor_file import MAGIC

    def nodes(*shape):
        return np.linspace(0.5, 1, int(np.prod(shape)), dtype="<f4").reshape(shape)

    arrays = {
        "description": np.frombuffer(b"clay", np.uint8),
        "phi_i": np.zeros(1, "<f4"),
        "theta_i": np.array([0, 1.5], "<f4"),
        "ndf": nodes(2, 3),
        "sigma": nodes(2, 3),
        "vndf": nodes(1, 2, 3, 4),
        "rgb": nodes(1, 2, 3, 3, 3),
        "jacobian": np.ones(1, np.uint8),
    }
    codes = {"|u1": 1, "<f4": 10}
    entries = [(name.encode(), codes[a.dtype.str], a) for name, a in arrays.items()]
    at = len(MAGIC) + 6 + sum(13 + len(name) + 8 * a.ndim for name, _, a in entries)
    header, data = MAGIC + struct.pack("<BBI", 1, 0, len(entries)), b""
    for name, code, a in entries:
        header += (
            struct.pack("<H", len(name)) + name + struct.pack("<HBQ", a.ndim, code, at + len(data))
        )
        header += struct.pack(f"<{a.ndim}Q", *a.shape)
        data += a.tobytes()
    return header + data


def _nbrdf(folder):
    rng = np.random.default_rng(0)
    with h5py.File(folder / "clay.h5", "w") as file:
        names = [b"dense", b"dense_1", b"dense_2"]
        file.attrs["layer_names"] = names
        for name, (n_in, n_out) in zip(names, [(6, 21), (21, 21), (21, 3)], strict=True):
            group = file.create_group(name.decode())
            group.attrs["weight_names"] = [name + b"/kernel:0", name + b"/bias:0"]
            inner = group.create_group(name.decode())
            inner["kernel:0"] = rng.normal(size=(n_in, n_out)).astype(np.float32)
            inner["bias:0"] = np.zeros(n_out, np.float32)
    return (folder / "clay.h5").read_bytes()


def _zip(folder):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("brdfs/clay.binary", _merl(folder))
        archive.writestr("clay.bsdf", _rgl())
    return content.getvalue()


class Valid(dict):
    """Valid files by kind; short where a failing case is printed."""

    def __repr__(self):
        return "valid"


@pytest.fixture(scope="module")
def valid(folder):
    return Valid(merl=_merl(folder), rgl=_rgl(), nbrdf=_nbrdf(folder), zip=_zip(folder))


@pytest.mark.parametrize("kind", ["merl", "rgl", "nbrdf"])
def test_the_files_to_be_spoilt_are_valid(valid, folder, kind):
    """Or nothing beyond the first check would ever be reached."""
    (folder / "valid").write_bytes(valid[kind])
    assert isinstance(read_brdf(folder / "valid"), Brdf)


@pytest.mark.parametrize("kind", ["merl", "rgl", "nbrdf"])
@fuzz
@given(changes=changes)
def test_a_spoilt_file_does_no_harm(valid, folder, kind, changes):
    require_harmless(read_brdf, spoilt(valid[kind], changes), folder / "spoilt")


@fuzz
@given(changes=changes)
def test_a_spoilt_zip_does_no_harm(valid, folder, changes):
    def read(path):
        found, _ = find_brdfs([path])
        for item in found:
            item.load()

    require_harmless(read, spoilt(valid["zip"], changes), folder / "spoilt")


@fuzz
@given(changes=changes)
def test_a_spoilt_zip_is_unpacked_within_its_folder_or_not_at_all(valid, folder, changes):
    inside = folder / "inside"

    def read(path):
        for unpacked in unpack(path, inside):
            assert unpacked.resolve().is_relative_to(inside.resolve())

    require_harmless(read, spoilt(valid["zip"], changes), folder / "spoilt")


@fuzz
@given(content=st.binary(max_size=2000))
def test_noise_does_no_harm(folder, content):
    require_harmless(read_brdf, content, folder / "noise")
