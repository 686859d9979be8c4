"""Environments as other programs write them, and damaged ones: each is one picture, written in another way."""

import struct
from itertools import groupby

import numpy as np
import pytest
from exr_files import exr
from numpy.testing import assert_allclose, assert_array_equal

from halfway.errors import RenderError
from halfway.render.variant import load_mitsuba

HEIGHT, WIDTH = 6, 12
RGBE = np.random.default_rng(0).integers(2, 256, (HEIGHT, WIDTH, 4)).astype(np.uint8)
RGBE[..., 3] = np.random.default_rng(1).integers(126, 132, (HEIGHT, WIDTH))
RGBE[2, 3:9] = RGBE[2, 3]  # runs
RGBE[4] = RGBE[4, 0]
RADIANCE = RGBE[..., :3] / 256 * 2.0 ** (RGBE[..., 3:].astype(int) - 128)
MAGIC = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"


def read(folder, name, content):
    load_mitsuba()
    from halfway.render.environment import read_environment

    (folder / name).write_bytes(content)
    return read_environment(folder / name)


def older_runs(pixels):
    """A run is the pixel, then 1 1 1 and how often it comes again."""
    out = b""
    for row in pixels:
        for pixel, same in groupby(map(bytes, row)):
            n = len(list(same)) - 1
            out += pixel + (b"\1\1\1" + bytes([n]) if n > 1 else pixel * n)
    return out


def newer_runs(pixels):
    out = b""
    for row in pixels:
        out += b"\2\2" + struct.pack(">H", len(row))
        for plane in row.T:
            for value, same in groupby(plane.tolist()):
                n = len(list(same))
                out += bytes([128 + n, value]) if n > 1 else bytes([1, value])
    return out


def turned(size):
    """The rows of the file whose resolution line says this of the picture."""
    pixels = RGBE[:: -1 if "+Y" in size else 1, :: -1 if "-X" in size else 1]
    return pixels.swapaxes(0, 1) if size.index("X") < size.index("Y") else pixels


@pytest.mark.parametrize("packed", [np.ndarray.tobytes, older_runs, newer_runs])
@pytest.mark.parametrize(
    "size",
    ["-Y 6 +X 12", "+Y 6 +X 12", "-Y 6 -X 12", "+Y 6 -X 12", "+X 12 -Y 6", "-X 12 -Y 6", "+X 12 +Y 6", "-X 12 +Y 6"],
)  # fmt: skip
def test_a_radiance_picture_is_upright_however_it_is_written(tmp_path, size, packed):
    pixels = turned(size)
    if packed is newer_runs and pixels.shape[1] < 8:
        packed = np.ndarray.tobytes  # as the format has it
    found = read(tmp_path, "x.hdr", MAGIC + f"{size}\n".encode() + packed(pixels))
    assert found.dtype == np.float32
    assert_array_equal(found, RADIANCE.astype(np.float32))


@pytest.mark.parametrize(
    "header",
    [
        b"#?RGBE\n# by hand\nEXPOSURE= 2.0\nVIEW= -vtv -vp 0 0 0\nSOFTWARE=a\nFORMAT=32-bit_rle_rgbe\n\n",
        b"#?RADIANCE\n\n",
        b"#?AUTOPANO\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n",
    ],
)
def test_other_lines_of_a_header_say_nothing(tmp_path, header):
    found = read(tmp_path, "x.HDR", header + b"-Y 6  +X 12 \n" + newer_runs(RGBE) + b"\n")
    assert_array_equal(found, RADIANCE.astype(np.float32))


def test_runs_of_hundreds_count_in_base_256(tmp_path):
    run = bytes([128, 64, 32, 129, 1, 1, 1, 43, 1, 1, 1, 1])
    found = read(tmp_path, "x.hdr", MAGIC + b"-Y 1 +X 300\n" + run)
    assert_allclose(found, np.broadcast_to([1.0, 0.5, 0.25], (1, 300, 3)))


def test_equals_mitsuba(tmp_path):
    mi = load_mitsuba()
    content = MAGIC + b"-Y 6 +X 12\n" + newer_runs(RGBE)
    found = read(tmp_path, "x.hdr", content)
    assert_array_equal(found, np.array(mi.Bitmap(str(tmp_path / "x.hdr"))))


HALVES = RADIANCE.astype(np.float16).astype(float)
R, G, B = np.moveaxis(HALVES, -1, 0)
OTHER = np.full_like(R, 77.0)


def layer(name, kind=2, planes=(R, G, B)):
    return [(f"{name}{c}", kind, plane) for c, plane in zip("RGB", planes, strict=True)]


OTHERS = [OTHER] * 3


@pytest.mark.parametrize(
    "channels",
    [
        layer(""),
        layer("", 1),
        [*layer("", 1), ("Z", 2, OTHER)],
        [*layer(""), ("A", 1, OTHER), ("id", 0, OTHER), ("Normal.X", 2, OTHER)],
        layer("ViewLayer.Combined."),
        [*layer("ViewLayer.Combined."), *layer("ViewLayer.Noisy Image.", 2, OTHERS), ("ViewLayer.Depth.Z", 2, OTHER)],
        [*layer(""), *layer("diffuse.", 2, OTHERS)],
        [*layer("crypto."), ("crypto.A", 2, OTHER), ("diffuse.R", 2, OTHER), ("Y", 2, OTHER)],
        [(name.lower(), kind, plane) for name, kind, plane in layer("")],
        [("red", 2, R), ("green", 2, G), ("blue", 2, B)],
        [("R", 2, R), ("G", 1, G), ("B", 2, B)],
    ],
    ids=["RGB", "half", "Z", "more", "one layer", "Blender's layers", "bare before layers", "only one in colour",
         "lower case", "words", "mixed types"],
)  # fmt: skip
def test_an_openexr_file_is_its_red_green_and_blue(tmp_path, channels):
    assert_allclose(read(tmp_path, "x.exr", exr(channels)), HALVES)


def test_windows_and_whole_numbers_and_grey(tmp_path):
    assert_allclose(read(tmp_path, "x.exr", exr(layer(""), corner=(-3, 5))), HALVES)
    whole = np.round(1000 * HALVES)
    found = read(tmp_path, "x.exr", exr(layer("", 0, np.moveaxis(whole, -1, 0))))
    assert_array_equal(found, whole)
    for channels in ([("Y", 2, R)], [("Y", 2, R), ("A", 2, OTHER)]):
        assert_allclose(read(tmp_path, "x.exr", exr(channels)), np.stack([R] * 3, axis=-1))


def test_radiance_below_nothing_is_nothing(tmp_path):
    found = read(tmp_path, "x.exr", exr(layer("", 2, (R - 1, G, B))))
    assert_allclose(found[..., 0], np.maximum(R - 1, 0))
    assert_allclose(found[..., 1:], HALVES[..., 1:])


def spoilt(value):
    plane = R.copy()
    plane[2, 5] = value
    return exr(layer("", 2, (plane, G, B)))


WHOLE = MAGIC + b"-Y 6 +X 12\n"


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("x.exr", exr([("Z", 2, R)]), "has the channels Z: expected R, G and B, or one layer that has them"),
        ("x.exr", exr([*layer("a."), *layer("b.")]), "has the channels .*a.R.*b.R.*: expected R, G and B"),
        ("x.exr", exr(layer(""))[:-9], "is damaged, or of a kind that is not read: expected OpenEXR"),
        ("x.exr", b"", "is damaged"),
        ("x.exr", spoilt(np.nan), "1 of 72 pixels that are no number or infinite"),
        ("x.exr", spoilt(np.inf), "1 of 72 pixels that are no number or infinite"),
        ("x.exr", exr(layer("", 2, [0 * R] * 3)), "has 0 of 72 pixels .* radiance up to 0: expected none, and some light"),
        ("x.exr", b"\x76\x2f\x31\1\2\0\0\0dataWindow\0box2i\0\x10\0\0\0" + struct.pack("<4i", 0, 0, 99_999, 99_999), r"states 10,000,000,000 pixels in \d+ bytes: expected 1 to"),
        ("x.hdr", MAGIC + b"-Y 100000 +X 100000\n", r"states 10,000,000,000 pixels in \d+ bytes: expected 1 to"),
        ("x.hdr", MAGIC + b"-Y 0 +X 12\n" + RGBE.tobytes(), "states 0 pixels in .* bytes: expected 1 to"),
        ("x.hdr", b"no hdr", "does not begin as a Radiance picture"),
        ("x.hdr", MAGIC + b"-Y 6 +Y 12\n", "does not begin as a Radiance picture"),
        ("x.hdr", WHOLE.replace(b"rgbe", b"xyze") + RGBE.tobytes(), "has pixels in XYZ: expected RGB"),
        ("x.hdr", WHOLE + RGBE.tobytes()[:-1], "holds 71 pixels: expected 6 x 12"),
        ("x.hdr", WHOLE + older_runs(RGBE)[:-4], r"holds \d+ pixels: expected 6 x 12"),
        ("x.hdr", WHOLE + newer_runs(RGBE)[:-1], r"holds \d+ pixels: expected 6 x 12"),
        ("x.hdr", WHOLE + newer_runs(RGBE).replace(b"\2\2\0\x0c", b"\2\2\0\x0c\x8d\7"), r"holds \d+ pixels: expected 6 x 12"),
        ("x.hdr", WHOLE + b"\1\1\1\xff" * 9, "holds .* pixels: expected 6 x 12"),
        ("x.hdr", WHOLE, "holds 0 pixels"),
    ],
)  # fmt: skip
def test_a_damaged_environment_says_what_is_wrong(tmp_path, name, content, message):
    with pytest.raises(RenderError, match=message) as said:
        read(tmp_path, name, content)
    assert str(said.value).isprintable()
    assert "[" not in str(said.value)  # nothing of Mitsuba's inside
