"""Recipes by numbers, as the page asks for them."""

from dataclasses import replace
from typing import Any

import pytest
from fastapi.testclient import TestClient
from glossy import library
from numpy.testing import assert_allclose

from halfway import attributes, find, mix, reach
from halfway.control import Control
from halfway.control.recolour import HELD
from halfway.instruments import ATTRIBUTES
from halfway.library import Subset
from halfway.people import Impressions, Perception, apart, distances
from halfway.recipes import Blend, Mixer, Recipe
from halfway.server import create_app
from halfway.server.finding import found_view
from halfway.server.schema import RecipeDocument, Wanted

LIBRARY = library()
HALF = {"m0": 0.5, "m1": 0.5}


@pytest.fixture(scope="module")
def client() -> TestClient:
    return TestClient(create_app(LIBRARY), base_url="http://127.0.0.1:8765")


def found(client: TestClient, *, blend: Blend = Blend.LINEAR, **asked: Any) -> Any:
    like = {"library": "glossy", "blend": str(blend), "weights": HALF}
    answer = client.post("/api/find", json={"like": like, "set": {}, **asked})
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_all_materials_have_their_attributes(client: TestClient) -> None:
    listed = {each["name"]: each for each in client.get("/api/attributes").json()["attributes"]}
    assert list(listed) == [name for name, each in ATTRIBUTES.items() if each.is_number]
    own = attributes(LIBRARY.brdf("m3"))
    for name in ("gloss60", "albedo", "b"):
        assert_allclose(listed[name]["values"][3], own[name], rtol=1e-6)
    assert (listed["b"]["needs"], listed["L"]["needs"]) == ("L", "")


def test_without_wishes_it_is_the_material_itself(client: TestClient) -> None:
    for blend in (Blend.LINEAR, Blend.LOBES):
        answer = found(client, blend=blend)
        assert answer["recipe"]["weights"] == HALF
        table = mix(LIBRARY, Recipe.of("glossy", HALF, blend=blend))
        assert_allclose(answer["attributes"]["gloss60"], attributes(table)["gloss60"], rtol=1e-4)


def test_how_people_would_perceive_a_mix_is_that_of_its_table(client: TestClient) -> None:
    recipe = Recipe.of("glossy", HALF, blend=Blend.LOBES)
    answer = client.post("/api/perceived", json=recipe.to_json())
    assert answer.status_code == 200, answer.text
    has = Perception.of(LIBRARY).perceived(mix(LIBRARY, recipe))
    got = {each["name"]: each for each in answer.json()["perceived"]}
    assert list(got) == list(has)
    for name, (value, trust) in has.items():
        assert_allclose(got[name]["value"], value, rtol=1e-6)
        assert got[name]["trust"] == trust


@pytest.mark.parametrize("blend", [Blend.LINEAR, Blend.ROOT, Blend.LOBES])
def test_what_is_asked_for_is_found(client: TestClient, blend: Blend) -> None:
    asked = {"gloss60": 6.0, "albedo": 0.3}
    rough, full = (found(client, blend=blend, set=asked, draft=draft) for draft in (True, False))
    table = mix(LIBRARY, Recipe.from_json(full["recipe"]))
    has = attributes(table)
    for name, value in asked.items():
        near = 1e-5 * value if blend is Blend.LINEAR else ATTRIBUTES[name].close
        assert_allclose(has[name], value, atol=near)
        assert_allclose(full["attributes"][name], has[name], rtol=1e-4)
    # A draft is by smaller tables, of the same materials.
    assert_allclose(rough["attributes"]["gloss60"], 6.0, rtol=0.25)
    assert rough["recipe"]["blend"] == full["recipe"]["blend"] == str(blend)


@pytest.mark.parametrize("draft", [False, True])
def test_what_people_perceive_is_found_beside_a_number(client: TestClient, draft: bool) -> None:
    asked = {"metallic": 0.3, "albedo": 0.3}
    answer = found(client, set=asked, draft=draft, ranges=["gloss60"])
    table = mix(LIBRARY, Recipe.from_json(answer["recipe"]))
    has = Perception.of(LIBRARY).perceived(table)["metallic"].value
    assert_allclose(has, 0.3, atol=0.03 if draft else 0.01)
    assert_allclose(answer["attributes"]["metallic"], has, atol=0.03 if draft else 1e-6)
    assert_allclose(attributes(table)["albedo"], 0.3, atol=0.005 if draft else 0.001)
    assert (answer["missed"], answer["ranges"]) == ([], {})


@pytest.mark.parametrize("asked", [{}, {"gloss60": 6.0}])
def test_a_draft_mixes_no_full_table(asked: dict[str, float]) -> None:
    # A mixer that cannot: it knows no such material.
    control = replace(Control.of(LIBRARY), mixer=Mixer(Subset(LIBRARY, ["m2", "m3"])))
    like = Recipe.of("glossy", HALF, blend=Blend.LOBES)
    document = RecipeDocument.model_validate(like.to_json())
    rough = found_view(control, like, Wanted(like=document, set=asked, draft=True))
    has = Control.of(LIBRARY).attributes(Recipe.from_json(rough.recipe.model_dump()))
    read = rough.attributes["gloss60"]
    assert read is not None
    assert_allclose(read, has["gloss60"], rtol=0.25)


def test_a_range_is_that_with_the_others_held(client: TestClient) -> None:
    asked = {"gloss60": 6.0, "L": 60.0, "b": 10.0}
    answer = found(client, set=asked, ranges=["albedo", "b", "L", "gloss60"])
    assert_allclose(answer["ranges"]["albedo"], reach(LIBRARY, "albedo", set=asked), rtol=1e-6)
    rest = {"gloss60": 6.0, "L": 60.0}
    assert_allclose(answer["ranges"]["b"], reach(LIBRARY, "b", set=rest), rtol=1e-6)
    # b* is read beside a lightness: where that goes, b* is free.
    assert_allclose(answer["ranges"]["L"], reach(LIBRARY, "L", set={"gloss60": 6.0}), rtol=1e-6)


def test_a_colour_alone_is_ranged_beside_the_lightness_that_there_is(client: TestClient) -> None:
    answer = found(client, set={"gloss60": 6.0}, ranges=["b"])
    held = {"gloss60": 6.0, "L": answer["attributes"]["L"]}
    assert_allclose(answer["ranges"]["b"], reach(LIBRARY, "b", set=held), rtol=1e-6)


def test_out_of_reach_the_nearest_is_found(client: TestClient) -> None:
    most = reach(LIBRARY, "gloss60").high
    answer = found(client, set={"gloss60": 2 * most}, ranges=["gloss60", "haze"])
    assert answer["missed"] == ["gloss60"]
    assert_allclose(answer["attributes"]["gloss60"], most, rtol=1e-6)
    # No mix has that, so nothing can go anywhere beside it.
    assert list(answer["ranges"]) == ["gloss60"]


def test_another_body_colour_keeps_the_highlight_or_says_what_it_cost(client: TestClient) -> None:
    asked = "#a07ea3"
    held = found(client, set={"body": asked})
    recipe = Recipe.from_json(held["recipe"])
    by_hand = find(LIBRARY, Recipe.of("glossy", HALF), set={"body": asked})
    assert recipe.to_json() == by_hand.to_json()
    assert recipe.is_recoloured
    # The document of the page is the recipe: what it is drawn and taken home by has that body, too.
    assert ATTRIBUTES["body"].written(attributes(mix(LIBRARY, recipe))["body"]) == held["body"]
    assert held["body"] == asked
    assert held["difference"] < 1e-3
    free = found(client, set={"body": asked}, release=list(HELD))
    assert free["recipe"]["body_scale"] is None
    changed = {each["name"] for each in free["given_up"]}
    assert "gloss60" in changed
    assert changed.isdisjoint({each["name"] for each in held["given_up"]})


def test_how_alike_people_find_materials_is_their_distance(client: TestClient) -> None:
    own = client.post("/api/alike", json={"library": "glossy", "weights": {"m3": 1}}).json()
    assert_allclose(own["distances"], distances(LIBRARY)[3], atol=1e-12)
    recipe = Recipe.of("glossy", HALF, blend=Blend.LOBES)
    mixed = client.post("/api/alike", json=recipe.to_json()).json()["distances"]
    impressions = Impressions.fit(LIBRARY)
    assert_allclose(mixed, apart(impressions.points, impressions.of(recipe)), rtol=1e-6)


def test_what_cannot_be_asked_for_is_said(client: TestClient) -> None:
    like = {"library": "glossy", "weights": HALF}
    answer = client.post("/api/find", json={"like": like, "set": {"glos60": 5}})
    assert answer.status_code == 400
    assert answer.json()["error"].startswith("there is no attribute 'glos60': did you mean gloss60")
