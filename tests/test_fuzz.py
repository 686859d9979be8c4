"""Hostile files: whatever the bytes, a reader gives a material or one line that says what is wrong.

Each case is a valid file, spoilt: cut, with bytes changed, with lengths and sizes that lie. No crash, no hang, no memory
beyond a small multiple of the file. ``HALFWAY_FUZZ_EXAMPLES`` makes it run longer; `fuzz` (``python tests/fuzz.py``) runs for
hours, guided by what an input reaches.
"""

import os
import tracemalloc
import warnings

import pytest
from hostile import subjects
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from patience import PATIENCE

from halfway import Brdf
from halfway.errors import HalfwayError
from halfway.formats import read_brdf

EXAMPLES = int(os.environ.get("HALFWAY_FUZZ_EXAMPLES", "60"))

fuzz = settings(
    max_examples=EXAMPLES,
    deadline=1000 * PATIENCE,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
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


def require_harmless(read, content, folder):
    """Reading gives what can be used, or a `HalfwayError` of one line; in little memory."""
    said = ""
    tracemalloc.start()
    try:
        with warnings.catch_warnings():
            # A warning is for people; that a damaged file warns is no fault.
            warnings.simplefilter("ignore")
            read(content, folder)
    except HalfwayError as error:
        said = str(error)
    finally:
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert not said or ("\n" not in said and 20 < len(said) < 1000), said
    assert most < 20 * len(content) + 20_000_000


class Subjects(dict):
    """Valid files by kind; short where a failing case is printed."""

    def __repr__(self):
        return "valid"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@pytest.fixture(scope="module")
def valid(folder):
    return Subjects(subjects(folder / "valid"))


KINDS = ["merl", "merl-order", "rgl", "rgl-spectral", "csail", "utia", "zarr", "zarr-chunk", "nbrdf", "nbrdf-model", "nbrdf-numbered", "zip", "unpack", "ply", "ply-text", "obj", "hdr", "exr", "library", "tables", "recipe", "route", "words"]  # fmt: skip


def test_every_kind_is_spoilt(valid):
    assert list(valid) == KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_the_files_to_be_spoilt_are_valid(valid, folder, kind):
    """Or nothing beyond the first check would ever be reached."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        valid[kind].read(valid[kind].valid, folder)


@pytest.mark.parametrize("kind", KINDS)
@fuzz
@given(changes=changes)
def test_a_spoilt_file_does_no_harm(valid, folder, kind, changes):
    require_harmless(valid[kind].read, spoilt(valid[kind].valid, changes), folder)


@fuzz
@given(content=st.binary(max_size=2000))
def test_noise_does_no_harm(folder, content):
    def read(content, folder):
        (folder / "noise").write_bytes(content)
        assert isinstance(read_brdf(folder / "noise"), Brdf)

    require_harmless(read, content, folder)
