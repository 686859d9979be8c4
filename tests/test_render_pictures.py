"""Tone mapping, strips, sheets and animations."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from halfway.errors import OutputError
from halfway.recipes import NamedBrdf
from halfway.render import Renderer, pictures, write_pictures


def grey(value: float, size: int = 32) -> np.ndarray:
    return np.full((size, size, 3), value, np.float32)


def test_srgb_coding_at_known_values():
    """0 and 1 are black and white; IEC 61966-2-1 codes 18 % grey as 118; the linear part has slope 12.92."""
    coded = [int(pictures.to_8_bit(grey(v, 1))[0, 0, 0]) for v in (-1, 0, 0.001, 0.18, 0.5, 1, 9)]
    assert coded == [0, 0, 3, 118, 188, 255, 255]


def test_one_stop_doubles_the_light():
    assert_array_equal(pictures.to_8_bit(grey(0.1), exposure=1.0), pictures.to_8_bit(grey(0.2)))


def test_what_is_coded_stays_as_it_is():
    coded = pictures.to_8_bit(grey(0.3))
    assert pictures.to_8_bit(coded, exposure=3.0) is coded


@pytest.mark.parametrize("suffix", [".png", ".webp"])
def test_a_written_picture_reads_back(tmp_path, suffix):
    image = grey(0.18)
    pictures.write(tmp_path / f"a{suffix}", image)
    read = np.array(Image.open(tmp_path / f"a{suffix}").convert("RGB"))
    assert_allclose(read, pictures.to_8_bit(image), atol=1)
    assert [path.name for path in tmp_path.iterdir()] == [f"a{suffix}"]


@pytest.mark.parametrize("exposure", [float("nan"), float("inf"), -65.0])
def test_an_exposure_that_shows_nothing_is_refused_before_anything_is_rendered(tmp_path, exposure):
    with pytest.raises(OutputError, match=f"exposure of {exposure:g} stops shows nothing"):
        pictures.to_8_bit(grey(0.1), exposure=exposure)
    with pytest.raises(OutputError, match="expected -64 to 64"):
        write_pictures(tmp_path / "a.png", Renderer("sphere"), [], exposure=exposure)


def test_exr_keeps_the_radiance(tmp_path):
    image = np.random.default_rng(0).random((4, 5, 3)).astype(np.float32) * 50
    pictures.write(tmp_path / "a.exr", image, exposure=2.0)
    import mitsuba as mi  # now that it has the right LLVM

    assert_array_equal(np.array(mi.Bitmap(str(tmp_path / "a.exr"))), image)


def test_a_strip_is_one_row_with_room_for_labels():
    plain = pictures.strip([grey(0.1), grey(0.2), grey(0.3)])
    labelled = pictures.strip([grey(0.1), grey(0.2), grey(0.3)], labels=["0", "0.5", "1"])
    assert plain.shape == (32, 3 * 32 + 2 * 2, 3)
    assert labelled.shape[1] == plain.shape[1]
    assert labelled.shape[0] > 32
    assert_array_equal(labelled[:32], plain)
    assert (labelled[32:] < 200).any()  # ink


def test_a_sheet_fills_its_last_row_with_paper():
    sheet = pictures.sheet([grey(0.0)] * 5, columns=3)
    assert sheet.shape == (2 * 32 + 2, 3 * 32 + 2 * 2, 3)
    assert (sheet[-32:, -32:] == pictures.PAPER).all()
    assert (sheet[:32, -32:] == 0).all()


@pytest.mark.parametrize("suffix", [".webp", ".gif"])
def test_an_animation_has_all_its_frames(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    pictures.animate(path, [grey(v) for v in (0.1, 0.4, 0.9)], fps=10.0)
    with Image.open(path) as animation:
        assert animation.n_frames == 3
        animation.seek(1)
        animation.load()
        assert animation.info["duration"] == 100


def test_a_video_has_all_its_frames_and_an_even_size(tmp_path):
    av = pytest.importorskip("av", reason="the extra video is not installed")
    path = tmp_path / "a.mp4"
    pictures.animate(path, [grey(v, 33) for v in (0.1, 0.4, 0.9)], fps=10.0)
    with av.open(str(path)) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    assert [frame.shape for frame in frames] == [(32, 32, 3)] * 3
    assert_allclose(frames[1].mean(), pictures.to_8_bit(grey(0.4)).mean(), atol=4)


@pytest.mark.parametrize("name", ["a", "a.bmp", "a.mov"])
def test_an_unknown_suffix_is_refused_with_what_is_known(tmp_path, name):
    with pytest.raises(OutputError, match=r"expected \.png, \.jpg"):
        pictures.write(tmp_path / name, grey(0))
    with pytest.raises(OutputError, match=r"expected \.webp"):
        pictures.animate(tmp_path / name, [grey(0)])


@pytest.fixture
def two(small_library) -> list[NamedBrdf]:
    names = ("material-1", "material-2")
    return [NamedBrdf(name, partial(small_library.brdf, name), name, name) for name in names]


def test_a_turntable_is_a_row_of_each_material(tmp_path, two):
    renderer = Renderer("sphere", size=(24, 20), spp=1)
    write_pictures(tmp_path / "strip.png", renderer, [two], most=8, n_turns=3)
    with Image.open(tmp_path / "strip.png") as strip:
        width, height = strip.size
    assert width == 3 * 24 + 2 * 2
    assert height > 2 * 20
    renderer = Renderer("teapot", size=(24, 20), spp=1)
    said = write_pictures(tmp_path / "around.webp", renderer, [two], n_turns=2)
    assert said == "2 frames of the teapot scene"
    with Image.open(tmp_path / "around.webp") as animation:
        assert (animation.n_frames, animation.width) == (2, 2 * 24 + 2)


def test_a_strip_is_no_linear_picture_which_is_said_before_it_is_rendered(tmp_path, two):
    path = tmp_path / "two.exr"
    with pytest.raises(OutputError, match=rf"{path} is for linear pictures: .* --format exr"):
        write_pictures(path, Unrendered("sphere"), [two])
    with pytest.raises(OutputError, match=rf"{path} is for linear pictures"):
        pictures.write(path, pictures.to_8_bit(grey(0.1)))
    assert not list(tmp_path.iterdir())


class Unrendered(Renderer):
    def picture(self, brdf, **options):  # noqa: ARG002
        raise AssertionError


def test_a_turntable_in_a_folder_goes_on_where_it_stopped(tmp_path, two):
    renderer = Renderer("teapot", size=(24, 20), spp=4)
    assert write_pictures(tmp_path / "all", renderer, [two[:1]], n_turns=2).startswith("2 pictures")
    before = {path.name: path.read_bytes() for path in (tmp_path / "all").glob("*.png")}
    assert sorted(before) == ["material-1-000.png", "material-1-001.png"]
    assert len(set(before.values())) == 2
    assert write_pictures(tmp_path / "all", renderer, [two[:1]], n_turns=2).endswith(", 2 kept")
    # The first of four shows what the first of two does.
    assert write_pictures(tmp_path / "all", renderer, [two[:1]], n_turns=4).endswith(", 1 kept")


def test_materials_that_dress_a_scene_together_turn_together(tmp_path, two):
    renderer = Renderer("trio", size=(24, 20), spp=1, bounces=1)
    said = write_pictures(tmp_path / "a.gif", renderer, [[*two, two[0]]], n_turns=2)
    assert said == "2 frames of the trio scene"
    with Image.open(tmp_path / "a.gif") as animation:
        assert animation.width == 24


def test_nothing_to_show_is_refused(tmp_path):
    with pytest.raises(OutputError, match="no pictures"):
        pictures.sheet([])
    with pytest.raises(OutputError, match="no pictures"):
        pictures.animate(tmp_path / "a.gif", [])
    assert not list(tmp_path.iterdir())
