"""The container of RGL's files: its bytes, and what it refuses."""

from io import BytesIO

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway.errors import FormatError
from halfway.formats.tensor_file import read_tensors, write_tensor_file


def test_fields_come_back_as_they_were(tmp_path):
    written = {
        "a": np.arange(6, dtype=np.float32).reshape(2, 3),
        "name": np.frombuffer(b"hi", np.uint8),
        "n": np.ones((1, 1, 2), np.float64),
    }
    write_tensor_file(tmp_path / "x.bsdf", written)
    read = read_tensors(BytesIO((tmp_path / "x.bsdf").read_bytes()), "x.bsdf")
    assert list(read) == list(written)
    for name, array in written.items():
        assert read[name].dtype == array.dtype
        assert_allclose(read[name], array)


def test_the_container_is_laid_out_as_its_page_says(tmp_path):
    write_tensor_file(tmp_path / "x.bsdf", {"ab": np.array([1, 2], np.uint32)})
    content = (tmp_path / "x.bsdf").read_bytes()
    header = (
        b"tensor_file\0"
        b"\x01\0"
        b"\x01\0\0\0"
        b"\x02\0ab"
        b"\x01\0"
        b"\x05" + b"\x30" + 7 * b"\0" + b"\x02" + 7 * b"\0"
    )
    assert content == header + b"\0" * (48 - len(header)) + b"\x01\0\0\0\x02\0\0\0"


@pytest.mark.parametrize("first", [0, 2, 88])
def test_the_first_byte_of_the_version_is_not_looked_at(tmp_path, first):
    """Mitsuba's plugin looks at the second alone; a writer that others use puts an X here."""
    path = tmp_path / "x.bsdf"
    write_tensor_file(path, {"a": np.arange(6.0)})
    content = bytearray(path.read_bytes())
    content[12] = first
    path.write_bytes(content)
    assert_allclose(read_tensors(BytesIO(path.read_bytes()), "x.bsdf")["a"], np.arange(6.0))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "does not begin as a tensor file"),
        (b"PK\3\4" + b"\0" * 100, "does not begin as a tensor file"),
        (b"tensor_file\0\1\0", "ends after 14 bytes, inside its header"),
        (b"tensor_file\0\1\1\1\0\0\0", r"version 1\.1: only 1\.0 is known"),
        (b"tensor_file\0\1\0\xff\xff\xff\xff", "claims 4294967295 fields"),
        (b"tensor_file\0\1\0\1\0\0\0\1\0a\xff\xff\1" + b"\0" * 8, "65535 dimensions"),
        (b"tensor_file\0\1\0\1\0\0\0\1\0a\1\0\x63" + b"\0" * 16, "has type 99"),
        (
            b"tensor_file\0\1\0\1\0\0\0\1\0a\1\0\1" + b"\0" * 8 + b"\xff" * 8,
            "it is truncated or damaged",
        ),
        (
            b"tensor_file\0\1\0\1\0\0\0\1\0a\2\0\1" + b"\0" * 16 + b"\xff" * 8,
            "it is truncated or damaged",
        ),
        (
            b"tensor_file\0\1\0\1\0\0\0\2\0\x1b[" + b"\0" * 30,
            r"a field named '\\x1b\[' \(2 bytes\): expected at most 64 printable",
        ),
        (b"tensor_file\0\1\0\1\0\0\0\xff\0" + b"a" * 300, r"'a{20}' \(255 bytes\)"),
        (b"tensor_file\0\1\0\2\0\0\0" + 2 * (b"\1\0a\0\0\1" + b"\0" * 8), "two fields named 'a'"),
    ],
)
def test_a_damaged_container_says_what_is_wrong(tmp_path, content, message):
    (tmp_path / "x.bsdf").write_bytes(content)
    with pytest.raises(FormatError, match=message):
        read_tensors(BytesIO((tmp_path / "x.bsdf").read_bytes()), "x.bsdf")
