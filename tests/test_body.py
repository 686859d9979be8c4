"""The same material in another colour: the body of a mix scaled, and found so where no mix keeps the highlight."""

import json
from dataclasses import replace

import numpy as np
import pytest
from glossy import GRID, glossy
from numpy.testing import assert_allclose, assert_array_equal

from halfway import find, mix, write_brdf
from halfway.brdf import TabularBrdf, albedos, gloss
from halfway.cli import main as halfway
from halfway.control import Control, Wishes
from halfway.control.recolour import HELD, changed
from halfway.errors import ControlError, OutOfReachError, RecipeError
from halfway.halfdiff import Grid
from halfway.instruments import ATTRIBUTES, of_table
from halfway.library import ProceduralLibrary, open_library
from halfway.look import Looks
from halfway.models import builtin
from halfway.recipes import Blend, Recipe

THREE = ProceduralLibrary(
    "three",
    {
        "matte": glossy((0.3, 0.2, 0.1), 0.0, 0.1),
        "shiny": glossy((0.1, 0.2, 0.3), 0.8, 0.1),
        "dark": glossy((0.02, 0.02, 0.02), 0.4, 0.2),
    },
    grid=GRID,
)
TURNED = ProceduralLibrary(
    "turned",
    dict(list(builtin("anisotropic").models.items())[:3]),
    grid=Grid.anisotropic(16, 8, 6, 6),
)
ANGLES = np.radians([0.0, 30.0, 60.0, 80.0])
COLOUR = np.array([0.35, 0.02, 0.2])
libraries = pytest.mark.parametrize("library", [THREE, TURNED], ids=lambda each: each.name)


def half(library: ProceduralLibrary, blend: Blend = Blend.LINEAR) -> Recipe:
    return Recipe.of(library, dict.fromkeys(library.names[:2], 0.5), blend)


@libraries
@pytest.mark.parametrize("blend", Blend)
def test_the_body_is_scaled_and_the_gloss_stays(library: ProceduralLibrary, blend: Blend):
    recipe = half(library, blend)
    before = gloss.Gloss.of(mix(library, recipe).values, library.grid)
    scaled = mix(library, replace(recipe, body_scale=(0.5, 0.25, 0.0))).values
    expected = np.array([0.5, 0.25, 0.0])[:, None, None] * before.body
    expected[:, : before.gloss.shape[1]] += before.gloss
    assert_allclose(gloss.to_lobes(scaled, library.grid), expected, rtol=1e-5, atol=1e-6)
    assert_array_equal(
        mix(library, replace(recipe, body_scale=(1.0, 1.0, 1.0))).values,
        mix(library, recipe).values,
    )


@libraries
def test_no_scale_makes_it_reflect_more_than_it_may(library: ProceduralLibrary):
    """Up to 1, and that it reaches; where it was more before, up to that."""
    recipe = half(library)
    before, after = (
        albedos(mix(library, each), ANGLES)
        for each in (recipe, replace(recipe, body_scale=(1e4, 1e4, 1e4)))
    )
    # Between the angles that are looked at a grazing body bends a little.
    assert (after <= np.maximum(before, 1) + 0.02).all()
    assert (after.max(axis=0) > np.maximum(before.max(axis=0), 0.5)).all()


def test_a_recipe_says_how_its_body_is_scaled_and_is_read_back():
    recipe = replace(half(THREE), body_scale=(0.5, 2.0, 0.0))
    document = json.loads(json.dumps(recipe.to_json()))
    assert document["body_scale"] == [0.5, 2.0, 0.0]
    assert Recipe.from_json(document).body_scale == recipe.body_scale
    assert "body_scale" not in half(THREE).to_json()
    assert not recipe.pictures_mix
    assert replace(Recipe.of(THREE, {"dark": 1.0}), body_scale=(1.0, 1.0, 0.5)).material is None
    for wrong in ([1, 2], [1, 1, -0.1], [1, 1, "nan"], "red"):
        with pytest.raises(RecipeError, match=r"the body scale is .*: expected three numbers"):
            Recipe.from_json({**document, "body_scale": wrong})


def test_its_picture_is_that_of_its_table():
    recipe = replace(half(THREE), body_scale=(0.2, 1.0, 0.5))
    looks = Looks.fit(THREE)
    table = mix(THREE, recipe)
    expected = Looks.fit(ProceduralLibrary("one", {"it": table}, grid=GRID)).images[0]
    # Small tables are resampled.
    off, unscaled = (
        np.abs(looks.of(each) - expected).mean() / expected.mean() for each in (recipe, half(THREE))
    )
    assert off < 0.1 < 0.3 < unscaled


@pytest.mark.parametrize("blend", [Blend.LINEAR, Blend.LOBES])
@pytest.mark.parametrize("draft", [False, True])
def test_a_material_in_a_colour_of_its_own_keeps_its_highlight(blend: Blend, draft: bool):
    control = Control.of(THREE)
    wishes = Wishes.of({"body": COLOUR / 2})
    recipe = control.find(wishes, like="shiny", blend=blend, draft=draft)
    assert recipe.names == ("shiny",)
    assert recipe.is_recoloured
    has, had = of_table(mix(THREE, recipe)), of_table(THREE.brdf("shiny"))
    # A draft is by smaller tables.
    assert_allclose(has["body"], COLOUR / 2, atol=0.02 if draft else 1e-5)
    assert control.given_up(control.attributes(recipe), wishes, "shiny") == {}
    for name in HELD:
        assert not changed(ATTRIBUTES[name], had[name], has[name])


def test_a_mix_is_found_where_it_has_it_all():
    """The body of a mix with a like highlight; and of any mix, where the highlight is released."""
    control = Control.of(THREE)
    near = Recipe.of(THREE, {"shiny": 0.96, "matte": 0.04})
    near_body = control.attributes(near)["body"]
    recipe = control.find(Wishes.of({"body": near_body}), like="shiny")
    assert not recipe.is_recoloured
    wishes = Wishes.of({"body": control.attributes(half(THREE))["body"]})
    assert control.find(wishes, like="shiny").is_recoloured
    released = control.find(wishes, like="shiny", release=HELD)
    assert set(released.names) >= {"shiny", "matte"}
    assert "gloss60" in control.given_up(control.attributes(released), wishes, "shiny")


def test_a_recipe_is_recoloured_from_its_own_body():
    """Not from one that was scaled before."""
    control = Control.of(THREE)
    once = control.find(Wishes.of({"body": COLOUR / 2}), like=half(THREE))
    twice = control.find(Wishes.of({"body": COLOUR / 4}), like=once)
    straight = control.find(Wishes.of({"body": COLOUR / 4}), like=half(THREE))
    assert_allclose(twice.body_scale, straight.body_scale, rtol=1e-6)


def test_what_no_body_has_is_refused():
    """More than a passive one can have; a colour darker than the highlight's own foot; a highlight that is never held."""
    with pytest.raises(OutOfReachError, match=r"the nearest is #"):
        find(THREE, "shiny", set={"body": (1.0, 1.0, 1.0)})
    metal = TabularBrdf(np.array(glossy((0, 0, 0), 1.0, 0.9).values), GRID)
    alone = ProceduralLibrary("metal", {"metal": metal, "dark": THREE.brdf("dark")}, grid=GRID)
    with pytest.raises(OutOfReachError, match=r"the nearest is #"):
        find(alone, "metal", set={"body": (0.0, 0.0, 0.2)})
    with pytest.raises(ControlError, match=r"albedo is not held: expected one of gloss20"):
        find(THREE, "shiny", set={"body": COLOUR}, release=["albedo"])


def test_the_command_line_tells_what_it_did(tmp_path, monkeypatch, capsys):
    for name in THREE.names:
        write_brdf(tmp_path / f"{name}.binary", glossy((0.3, 0.2, 0.1), 0.0, 0.1))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    run(monkeypatch, "library", "build", *map("{}.binary".format, THREE.names), "-o", "a.brdflib")
    asked = ["find", "a.brdflib", "--like", "dark", "--set", "body=#7a2a3a"]
    run(monkeypatch, *asked, "-o", "wine.json")
    told = capsys.readouterr().err
    assert "keeps the highlight of dark: its body alone is scaled, red, green and blue by" in told
    run(monkeypatch, "attributes", "wine.json", "--json")
    (read,) = json.loads(capsys.readouterr().out)
    assert read["attributes"]["body"] == "#7a2a3a"
    assert json.loads((tmp_path / "wine.json").read_text())["format"] == 3


def run(monkeypatch, *words: str) -> None:
    monkeypatch.setattr("sys.argv", ["halfway", *words])
    with pytest.raises(SystemExit) as stop:
        halfway()
    assert not stop.value.code


def test_an_anisotropic_material_is_recoloured():
    name = TURNED.names[0]
    had = of_table(TURNED.brdf(name))["body"]
    recipe = find(TURNED, name, set={"body": 0.5 * had + 0.02}, release=HELD)
    assert_allclose(of_table(mix(TURNED, recipe))["body"], 0.5 * had + 0.02, atol=2e-3)
    assert open_library("builtin:anisotropic").grid.is_isotropic is False
