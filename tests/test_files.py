"""What is said of a file that is being written."""

from pathlib import Path

import pytest

from halfway.errors import MissingExtraError, OutputError, shown
from halfway.files import replacing, suffix_of


def test_a_mistake_speaks_of_the_file_that_was_asked_for(tmp_path):
    def write(path: Path) -> None:
        raise OutputError(f"{path.name} is for linear pictures; see {path}.")

    with pytest.raises(OutputError) as error, replacing(tmp_path / "strip.exr") as temporary:
        write(temporary)
    assert str(error.value) == f"strip.exr is for linear pictures; see {tmp_path / 'strip.exr'}."


def test_so_it_does_where_a_writer_replaces_too(tmp_path):
    (tmp_path / "a").write_text("a file")
    path = tmp_path / "a" / "b.bsdf"
    with pytest.raises(OutputError) as error, replacing(path):
        pass
    assert str(error.value).startswith(f"{path} cannot be written")
    with pytest.raises(OutputError) as error, replacing(tmp_path / "c.bsdf") as outer:  # noqa: PT012
        outer.write_text("a file")
        with replacing(outer / "d"):
            pass
    assert str(error.value).startswith(
        f"{tmp_path / 'c.bsdf'}/d cannot be written: part of its path"
    )


def test_the_kind_of_mistake_stays(tmp_path):
    with (
        pytest.raises(MissingExtraError, match="needs the package av"),
        replacing(tmp_path / "a.mp4"),
    ):
        raise MissingExtraError("an animation", "av", "video")


def test_a_suffix_may_be_in_capitals():
    assert suffix_of(Path("A.BINARY"), {".binary": 1}) == ".binary"
    with pytest.raises(OutputError) as error:
        suffix_of(Path("a.tiff"), (".png", ".exr"), what="kind of picture")
    assert str(error.value) == (
        "a.tiff has the suffix '.tiff', which names no kind of picture: expected .png, .exr."
    )
    with pytest.raises(OutputError, match=r"^a has no suffix: expected \.png, \.exr\.$"):
        suffix_of(Path("a"), (".png", ".exr"))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("café, 12:30 = 雪", "café, 12:30 = 雪"),
        ("wide\u3000space", "wide\u3000space"),
        ("\x1b[31mred\x07", r"\x1b[31mred\x07"),
        ("two\nlines\r\tand\u2028three", r"two\nlines\r\tand\u2028three"),
        ("\u202eback\udcff", r"\u202eback\udcff"),
    ],
)
def test_text_from_elsewhere_is_one_line_that_a_terminal_does_not_obey(text, expected):
    assert shown(text) == expected
