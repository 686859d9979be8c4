"""Recipes by what they shall be."""

import json

import numpy as np
import pytest
from exr_files import exr
from glossy import GRID, glossy, library
from numpy.testing import assert_allclose
from PIL import Image

from halfway import TabularBrdf, attributes, find, mix, reach, write_brdf
from halfway.cli import main as halfway
from halfway.cli.arguments import open_like
from halfway.colour import to_hex
from halfway.control import Control, Range, Wishes
from halfway.errors import ControlError, HalfwayError, OutOfReachError
from halfway.instruments import ATTRIBUTES, of_readings, read_table
from halfway.look import portrait, to_png
from halfway.look.portraits import PORTRAIT_SCENE
from halfway.people import QUALITIES, Perception
from halfway.recipes import Blend, Recipe
from halfway.space import along

LIBRARY = library()
CONTROL = Control.of(LIBRARY)
N = len(LIBRARY)


def random_weights(n: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.dirichlet(np.ones(N), size=n)


def found(like: str | None = None, few: bool = False, clamp: bool = False, **asked) -> Recipe:
    """As `halfway.find` would, of a library that is read once."""
    exact = asked.pop("set", None)
    return CONTROL.find(Wishes.of(exact, **asked), like=like, few=few, clamp=clamp)


def ends(name: str, **asked) -> Range:
    return CONTROL.reach(name, Wishes.of(asked.get("set")))


def read(table: TabularBrdf) -> dict:
    """What instruments read off a table, and how people would perceive it."""
    perceived = Perception.of(LIBRARY).perceived(table)
    return {**attributes(table), **{name: each.value for name, each in perceived.items()}}


def values_of(weights: np.ndarray) -> dict:
    dense = np.broadcast_to(weights, (3, *weights.shape))
    return of_readings(CONTROL.readings.mix(dense, Blend.LINEAR))


@pytest.mark.parametrize(
    "names", [("gloss60", "albedo", "body"), ("L", "a", "b", "haze"), ("highlight_width", "doi")]
)
@pytest.mark.parametrize("seed", range(5))
def test_a_recipe_has_what_is_asked_for(names: tuple[str, ...], seed: int):
    """What a mix has can be asked for, and the found recipe has it to rounding: in the readings, and in its table."""
    of = values_of(random_weights(1, seed)[0])
    asked = {name: of[name] for name in names}
    recipe = found(set=asked)
    has = CONTROL.attributes(recipe)
    for name in names:
        assert_allclose(has[name], asked[name], rtol=1e-6, atol=1e-9)
    assert_allclose(attributes(mix(LIBRARY, recipe))[names[0]], asked[names[0]], rtol=1e-4)
    assert (recipe.weights == recipe.weights[0]).all()


@pytest.mark.parametrize("blend", [Blend.LINEAR, Blend.ROOT])
@pytest.mark.parametrize("names", [("metallic",), ("matte", "gloss60"), ("soft", "bright", "L")])
@pytest.mark.parametrize("seed", range(3))
def test_what_people_perceive_of_a_mix_can_be_asked_for(blend: Blend, names: tuple, seed: int):
    """Of a random mix; read off the table of what is found, with what instruments read of it."""
    dense = np.broadcast_to(random_weights(1, seed)[0], (3, N))
    of = read(mix(LIBRARY, Recipe.from_dense("glossy", LIBRARY.names, dense, blend)))
    has = read(mix(LIBRARY, CONTROL.find(Wishes.of({n: of[n] for n in names}), blend=blend)))
    for name in names:
        assert_allclose(has[name], of[name], atol=0.01 if name in QUALITIES else 0.1)


def test_more_of_what_people_perceive_goes_as_far_as_some_mix_does():
    """The ends of a walk are no narrower than the materials, and each is what a mix has, with what is held beside it."""
    each = [read(LIBRARY.brdf(name))["metallic"] for name in LIBRARY.names]
    low, high = ends("metallic")
    assert low <= min(each) + 0.01
    assert high >= max(each) - 0.01
    of = read(mix(LIBRARY, CONTROL.recipe(random_weights(1)[0], Blend.LINEAR)))
    held = {"gloss60": of["gloss60"]}
    low, high = ends("metallic", set=held)
    assert low - 0.01 <= of["metallic"] <= high + 0.01
    for end in (low, high):
        has = read(mix(LIBRARY, found(set={**held, "metallic": end})))
        assert_allclose(has["metallic"], end, atol=0.01)
        assert_allclose(has["gloss60"], of["gloss60"], atol=0.1)


def test_what_nobody_would_perceive_of_a_mix_is_told_in_one_line_and_the_nearest_taken():
    with pytest.raises(
        OutOfReachError, match=r"metallic = 1.9: it was found from .* --clamp"
    ) as told:
        found(set={"metallic": 1.9})
    assert "\n" not in str(told.value)
    has = read(mix(LIBRARY, found(set={"metallic": 1.9}, clamp=True)))
    assert_allclose(has["metallic"], ends("metallic").high, atol=0.05)


@pytest.mark.parametrize("blend", [blend for blend in Blend if blend is not Blend.LINEAR])
@pytest.mark.parametrize("seed", range(3))
def test_another_blend_has_what_is_asked_for_to_what_is_close(blend: Blend, seed: int):
    """What one of its own mixes has; read off the table of the recipe."""
    rng = np.random.default_rng(seed)
    names = rng.choice(LIBRARY.names, 3, replace=False).tolist()
    weights = dict(zip(names, rng.dirichlet(np.full(3, 3.0)), strict=True))
    of = attributes(mix(LIBRARY, Recipe.of(LIBRARY, weights, blend)))
    wishes = Wishes.of({name: of[name] for name in ("gloss60", "albedo", "body")})
    recipe = CONTROL.find(wishes, blend=blend)
    assert recipe.blend is blend
    assert wishes.missed(read_table(mix(LIBRARY, recipe))) <= 1


def test_what_another_blend_does_not_have_is_refused_or_the_nearest_taken():
    wishes = Wishes.of({"gloss60": 5000})
    with pytest.raises(OutOfReachError, match=r"blend 'root'.*--clamp"):
        CONTROL.find(wishes, blend=Blend.ROOT)
    has = CONTROL.attributes(CONTROL.find(wishes, blend=Blend.ROOT, clamp=True))
    assert has["gloss60"] > 0.9 * ends("gloss60").high


@pytest.mark.parametrize("blend", Blend)
def test_like_a_material_is_that_material(blend: Blend):
    assert CONTROL.find(Wishes(), like="m3", blend=blend).names == ("m3",)


def test_like_a_file_that_is_one_of_the_materials_is_that_material(tmp_path):
    write_brdf(tmp_path / "scan.binary", LIBRARY.brdf("m5"))
    assert CONTROL.find(Wishes(), like=str(tmp_path / "scan.binary")).names == ("m5",)


@pytest.mark.parametrize("exposure", [0.5, 0.8])
def test_like_a_picture_of_a_material_is_that_material_at_any_exposure(tmp_path, exposure: float):
    table = LIBRARY.brdf("m2")
    picture = exposure * portrait(table.values, GRID)
    (tmp_path / "sphere.png").write_bytes(to_png([picture.astype(np.float32)]))
    recipe = CONTROL.find(Wishes(), like=str(tmp_path / "sphere.png"))
    # 8 bits, and highlights that are white
    assert recipe.weights[0, recipe.names.index("m2")] > 0.9


def test_like_a_picture_in_linear_light_is_that_material(tmp_path):
    """As the command line opens it; nothing is white in it, and nothing rounded to 8 bits."""
    size, sphere = PORTRAIT_SCENE.size, PORTRAIT_SCENE.mask()
    linear = np.zeros((size, size, 3), np.float32)
    linear[sphere] = 3 * portrait(LIBRARY.brdf("m2").values, GRID)
    channels = [(name, 2, linear[..., c]) for c, name in enumerate("RGB")]
    (tmp_path / "sphere.exr").write_bytes(exr(channels))
    recipe = CONTROL.find(Wishes(), like=open_like(str(tmp_path / "sphere.exr")))
    assert recipe.weights[0, recipe.names.index("m2")] > 0.99


def test_a_picture_that_is_not_there_is_called_a_picture(tmp_path):
    with pytest.raises(HalfwayError, match=r"photo.exr is not there: expected a picture of"):
        open_like(str(tmp_path / "photo.exr"))


def test_like_a_colour_is_the_mix_with_that_body():
    body = values_of(random_weights(1)[0])["body"]
    has = CONTROL.attributes(CONTROL.find(Wishes(), like=to_hex(body)))
    assert_allclose(has["body"], body, atol=0.01)


@pytest.mark.parametrize(
    ("size", "told"), [((40, 30), "40 x 30 pixels: expected a square"), ((32, 32), "is black")]
)
def test_a_picture_of_no_sphere_is_refused(tmp_path, size: tuple[int, int], told: str):
    Image.new("RGB", size).save(tmp_path / "none.png")
    with pytest.raises(ControlError, match=told):
        CONTROL.find(Wishes(), like=str(tmp_path / "none.png"))


def test_what_is_not_asked_for_stays():
    """A change of gloss keeps the body colour where some mix does; a change of colour keeps the gloss."""
    own = attributes(LIBRARY.brdf("m0"))
    target = (own["gloss60"] + CONTROL.reach("gloss60", Wishes({"body": own["body"]})).high) / 2
    has = CONTROL.attributes(CONTROL.find(Wishes({"gloss60": target}), like="m0"))
    assert_allclose(has["body"], own["body"], rtol=1e-6)
    assert_allclose(has["gloss60"], target, rtol=1e-6)


def test_what_is_given_up_is_told():
    """Nothing of the material itself; of a far one at least what makes it another."""
    wishes = Wishes.of({"albedo": 0.3})
    own = CONTROL.attributes(CONTROL.find(Wishes(), like="m1"))
    assert CONTROL.given_up(own, wishes, "m1") == {}
    shiny, matte = (
        np.argmax(x * ATTRIBUTES["gloss60"].of(CONTROL.readings.values)) for x in (1, -1)
    )
    other = CONTROL.attributes(CONTROL.find(Wishes(), like=f"m{shiny}"))
    was, now = CONTROL.given_up(other, wishes, f"m{matte}")["gloss60"]
    assert was < now


def test_bounds_hold():
    for seed in range(5):
        of = values_of(random_weights(1, seed)[0])
        bounds = {"at_most": {"gloss60": of["gloss60"]}, "at_least": {"albedo": of["albedo"]}}
        has = CONTROL.attributes(found("m0", **bounds))
        assert has["gloss60"] <= of["gloss60"] * (1 + 1e-9)
        assert has["albedo"] >= of["albedo"] * (1 - 1e-9)


def test_few_takes_no_more_materials_than_numbers_and_one():
    """Where the nearest takes many: of what is like a mix of all."""
    of_all = Recipe.of(LIBRARY, dict(zip(LIBRARY.names, random_weights(1)[0], strict=True)))
    of = CONTROL.attributes(of_all)
    wishes = Wishes.of({"gloss60": 1.1 * of["gloss60"]})
    near, few = (CONTROL.find(wishes, like=mix(LIBRARY, of_all), few=few) for few in (False, True))
    assert len(few.names) <= 2 < len(near.names)


def test_what_is_held_counts_for_more_than_the_picture():
    reference = CONTROL.nearness.points[0]
    plain = CONTROL.nearness.scaled(reference, held=[])
    held = CONTROL.nearness.scaled(reference, held=["colour"])
    assert held.shape[1] == plain.shape[1] + 3
    assert_allclose(held[:, :-3], plain)
    body = (CONTROL.nearness.points - reference)[:, -3:]
    assert_allclose(held[:, -3:], 4 / 3 * body / (reference[-3:] + 0.02) ** (2 / 3))


@pytest.mark.parametrize("name", [n for n, a in ATTRIBUTES.items() if a.is_number and not a.needs])
def test_alone_an_attribute_goes_as_far_as_the_materials_do(name: str):
    """A mix is never beyond its materials, neither in a sum nor in a ratio: the ends are at two of them."""
    values = ATTRIBUTES[name].of(CONTROL.readings.values)
    assert_allclose(ends(name), [values.min(), values.max()], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ["haze", "doi", "highlight_width", "a"])
def test_a_range_holds_what_is_held_and_ends_where_it_says(name: str):
    of = values_of(random_weights(1, 3)[0])
    held = {"gloss60": of["gloss60"], "L": of["L"]}
    low, high = ends(name, set=held)
    assert low <= of[name] <= high
    size = high - low
    for end, beyond in ((low, low - 1e-3 * size), (high, high + 1e-3 * size)):
        inside = end + 1e-6 * (np.mean([low, high]) - end)
        assert_allclose(
            CONTROL.attributes(found(set={**held, name: inside}))[name], inside, rtol=1e-6
        )
        with pytest.raises(OutOfReachError):
            found(set={**held, name: beyond})


def test_the_verbs_make_what_is_asked_and_ask_it():
    of = values_of(random_weights(1)[0])
    low, high = reach(LIBRARY, "gloss60", set={"L": of["L"]}, at_most={"haze": of["haze"]})
    assert low <= of["gloss60"] <= high
    recipe = find(LIBRARY, "m1", set={"gloss60": high, "L": of["L"]}, at_most={"haze": of["haze"]})
    assert_allclose(CONTROL.attributes(recipe)["gloss60"], high, rtol=1e-6)


def test_what_is_out_of_reach_is_told_with_its_range_and_the_nearest_taken():
    with pytest.raises(
        OutOfReachError, match=r"gloss60 = 5000: it goes from .* to .* there.*--clamp"
    ) as told:
        found(set={"gloss60": 5000})
    assert "\n" not in str(told.value)
    has = CONTROL.attributes(found(set={"gloss60": 5000}, clamp=True))
    assert_allclose(has["gloss60"], ends("gloss60").high, rtol=1e-6)


def test_what_only_the_others_forbid_is_told_with_them():
    of = values_of(random_weights(1)[0])
    body = tuple(float(x) for x in of["body"])
    beyond = ends("gloss60", set={"body": body}).high * 1.01
    assert beyond < ends("gloss60").high
    with pytest.raises(
        OutOfReachError,
        match=r"no mix of glossy has body = #.* where gloss60 = .*: the nearest is #",
    ):
        found(set={"body": body, "gloss60": beyond})


def test_a_colour_out_of_reach_is_told_with_the_nearest():
    with pytest.raises(OutOfReachError, match="body = #ff0000: the nearest is #"):
        found(set={"body": "#ff0000"})


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"set": {"a": 10}}, "Set L too"),
        ({"set": {"L": 50}, "at_most": {"body": "#102030"}}, "has no least and no most"),
        ({}, "there is nothing to find"),
        ({"set": {"shine": 1}}, "there is no attribute 'shine'"),
    ],
)
def test_wishes_that_make_no_sense_are_refused(asked: dict, told: str):
    with pytest.raises(ControlError, match=told):
        find(LIBRARY, **asked)


def test_a_route_along_an_attribute_has_every_value_on_the_way():
    """At its knots, and between two of them by linear mixes."""
    low, high = ends("gloss60")
    start, stop = low + 0.2 * (high - low), low + 0.6 * (high - low)
    way = along(LIBRARY, "m1", "gloss60", start, stop, n=3)
    for t in (0.0, 0.3, 0.5, 1.0):
        has = CONTROL.attributes(way.recipe(t))
        assert_allclose(has["gloss60"], (1 - t) * start + t * stop, rtol=1e-6)
    assert len(way.to_json(way.steps(5))["recipes"]) == 5
    with pytest.raises(OutOfReachError, match="gloss60 = 5000: it goes from"):
        along(LIBRARY, "m1", "gloss60", start, 5000, n=3)


def test_the_command_line_finds_and_tells(tmp_path, monkeypatch, capsys):
    """A recipe found, and its attributes read again."""
    names = ["dark", "matte", "shiny"]
    bodies = [(0.02, 0.02, 0.02), (0.5, 0.4, 0.3), (0.1, 0.1, 0.2)]
    for name, body, strength in zip(names, bodies, (0.1, 0.0, 1.0), strict=True):
        write_brdf(tmp_path / f"{name}.binary", glossy(body, strength, 0.1, GRID))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    run(
        monkeypatch,
        "library",
        "build",
        *(f"{name}.binary" for name in names),
        "-o",
        "three.brdflib",
    )
    run(
        monkeypatch,
        "find",
        "three.brdflib",
        "--like",
        "matte",
        "--set",
        "gloss60=4",
        "-o",
        "new.json",
        "--json",
    )
    found = json.loads(capsys.readouterr().out)
    assert found["attributes"]["gloss60"] == pytest.approx(4, rel=1e-6)
    more = "find three.brdflib --like matte --set metallic=.4"
    run(monkeypatch, *more.split())
    (line,) = [x for x in capsys.readouterr().out.splitlines() if x.startswith("metallic")]
    assert line.split()[1:3] == ["0.40", "trust:"]
    run(monkeypatch, "attributes", "new.json", "--json")
    (read,) = json.loads(capsys.readouterr().out)
    assert read["attributes"]["gloss60"] == pytest.approx(4, rel=1e-4)
    run(
        monkeypatch, "route", "three.brdflib", "dark", "--along", "gloss60=2:3", "-n", "3", "--json"
    )
    route = json.loads(capsys.readouterr().out)
    assert route["stops"] == ["gloss60=2", "gloss60=3"]
    # A recipe's file is the recipe: in any blend, it is its own body that is scaled.
    mixed = {"library": "three.brdflib", "blend": "root", "weights": {"dark": 0.5, "shiny": 0.5}}
    (tmp_path / "mixed.json").write_text(json.dumps(mixed))
    like = "find three.brdflib --like mixed.json --blend root --set body=#102030 --json"
    run(monkeypatch, *like.split())
    recoloured = json.loads(capsys.readouterr().out)
    assert recoloured["weights"] == mixed["weights"]
    assert len(recoloured["body_scale"]) == 3
    run(monkeypatch, "attributes", "three.brdflib")
    assert [line.split()[-1] for line in capsys.readouterr().out.splitlines()] == [
        "material",
        *names,
    ]


def run(monkeypatch, *words: str) -> None:
    monkeypatch.setattr("sys.argv", ["halfway", *words])
    with pytest.raises(SystemExit) as stop:
        halfway()
    assert not stop.value.code
