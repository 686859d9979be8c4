"""What people say of materials."""

import csv

import numpy as np
import pytest
from glossy import library
from numpy.testing import assert_allclose

from halfway import TabularBrdf, tabulate
from halfway.formats import read_nbrdf_archive
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.people import Impressions, Perception, apart, distances
from halfway.people.networks import Network, networks
from halfway.people.perceived import ANCHOR, ANCHOR_SCORES, EXPLAINED, lightness, samples
from halfway.recipes import Blend, Recipe
from halfway.space import Route, route

ABC = builtin("merl-abc").models
BY_STAND_INS = Perception.of()


@pytest.fixture(scope="module")
def neural(shared_data):
    models = read_nbrdf_archive(shared_data / "nbrdf" / "merl_nbrdf.zip").models
    return ProceduralLibrary("neural", models, grid=Grid.merl(4, 4, 4))


def test_the_published_lightness_of_the_published_projection():
    """The editor's own numbers for gold-metallic-paint, L* of five components."""
    published = [18.05779539, -25.37558651, -98.01382911, 42.08695397, -68.9083537]
    assert_allclose(100 * lightness(ANCHOR_SCORES), published, rtol=1e-3)


def test_a_network_at_one_of_its_centres_far_from_the_others_says_that_ones_weight():
    centres = np.array([[0.0] * 5, [100.0] * 5])
    network = Network(0.5, np.array([0.25, 9.0]), centres)
    assert_allclose(network.of(centres[0]), 0.75)


def test_the_networks_give_the_values_that_were_derived_of_them(shared_data):
    """At the five numbers of each of MERL's materials, which are written to four digits."""
    path = shared_data / "serrano2016_attributes" / "derived_attributes_merl100.csv"
    rows = list(csv.DictReader(path.read_text().splitlines()))
    x = np.array([[float(row[f"x{k}"]) for k in range(1, 6)] for row in rows])
    derived = np.array([[float(v) for v in list(row.values())[1:15]] for row in rows])
    ours = np.stack([network.of(x) for network in networks().values()], axis=1)
    assert_allclose(ours, derived, atol=1e-3)


def test_the_projection_that_was_published_is_that_of_the_neural_fits(neural):
    """To .01 of scores of which the largest is .13: they are stand-ins of what was measured."""
    scores = Perception.of(neural).scores(samples(neural.material(ANCHOR)))
    assert_allclose(scores, ANCHOR_SCORES, atol=0.01)


@pytest.mark.parametrize("of", ["stand-ins", "neural"])
def test_chrome_is_metallic_and_white_fabric_is_matte(of: str, request):
    if of == "neural":
        library = request.getfixturevalue("neural")
        perception, material = Perception.of(library), library.material
    else:
        perception, material = BY_STAND_INS, ABC.__getitem__
    chrome, fabric = (perception.perceived(material(n)) for n in ("chrome", "white-fabric"))
    assert chrome["metallic"].value > 0.8 > fabric["metallic"].value
    assert fabric["matte"].value > 0.7 > chrome["matte"].value
    assert chrome["metallic"].trust == "high"
    assert chrome["ceramic"].trust == "low"


def test_what_is_beyond_the_rated_materials_is_not_trusted():
    chrome = tabulate(ABC["chrome"], Grid.merl(30, 20, 24))
    brighter = TabularBrdf(1000 * chrome.values, chrome.grid)
    assert {p.trust for p in BY_STAND_INS.perceived(brighter).values()} == {"low"}


def test_what_is_not_measured_counts_as_the_mean_material():
    values = np.full((3, len(BY_STAND_INS.mean)), np.nan)
    assert_allclose(BY_STAND_INS.scores(values), 0)


def test_how_much_of_each_network_a_straight_line_explains(neural):
    perception = Perception.of(neural)
    scores = perception.scores(np.stack([samples(neural.material(n)) for n in neural.names]))
    x = np.column_stack([np.ones(100), lightness(scores)])
    for name, network in networks().items():
        values = network.of(x[:, 1:])
        rest = values - x @ np.linalg.lstsq(x, values, rcond=None)[0]
        assert_allclose(1 - rest.var() / values.var(), EXPLAINED[name], atol=0.01)


def test_distances_are_distances():
    """None below 0, 0 to itself, the same both ways, and no way round is shorter."""
    d = distances(library(8))
    assert (d >= 0).all()
    assert_allclose(np.diag(d), 0)
    assert_allclose(d, d.T)
    assert (d[:, None] + d[None] >= d[..., None].swapaxes(1, 2) - 1e-9).all()


def test_a_mix_is_where_its_own_table_is():
    """By small tables, which are resampled; a material is among its neighbours, and those come in order."""
    some = library(5)
    impressions = Impressions.fit(some)
    half = np.full((3, 1, 5), [0.5, 0.5, 0, 0, 0])
    (mixed,) = impressions.mix(half, Blend.LOBES)
    own = impressions.of(Recipe.from_dense(some, some.names, half[:, 0], Blend.LOBES))
    assert apart(mixed, own) < 0.2 * apart(*impressions.points[:2])
    near = impressions.nearest(impressions.of("m3"), 5)
    assert near[0] == ("m3", 0)
    assert [d for _, d in near] == sorted(d for _, d in near)
    assert_allclose(dict(near)["m0"], distances(some)[0, 3])


def test_what_is_not_measured_of_a_material_does_not_count():
    a, b = np.array([1.0, np.nan, 2.0]), np.array([0.5, 7.0, 2.5])
    assert apart(a, b) == 1.0


def test_at_the_pace_of_people_steps_are_equal_to_them():
    some = library(5)
    impressions = Impressions.fit(some)
    way = route(some, "m0", "m1", space="linear", blend="lobes", pace="people")
    assert way.pace == "people"

    def jump(way: Route) -> float:
        points = impressions.mix(way.at(np.linspace(0, 1, 9)), way.blend)
        steps = apart(points[:-1], points[1:])
        return float(steps.max() / steps.mean())

    assert jump(way) < 1.05
    assert jump(way) < jump(route(some, "m0", "m1", space="linear", blend="lobes", pace="uniform"))


def test_chrome_is_more_like_steel_than_like_a_fabric():
    names = ["chrome", "steel", "white-fabric", "pink-felt"]
    tables = {name: tabulate(ABC[name], Grid.merl(45, 30, 24), name=name) for name in names}
    d = distances(ProceduralLibrary("four", tables, grid=Grid.merl(45, 30, 24)))
    assert 3 * d[0, 1] < d[0, 2]
    assert 3 * d[2, 3] < d[2, 1]


def test_the_distance_is_with_the_majority_of_the_answers(shared_data):
    """Those it was fitted to; ``benchmarks/human_distance.py`` judges it by others."""
    models = read_nbrdf_archive(shared_data / "nbrdf" / "merl_nbrdf.zip").models
    neural = ProceduralLibrary("neural", models, grid=Grid.merl(60, 30, 24))
    d, index = distances(neural), neural.names.index
    rows = csv.DictReader(
        (shared_data / "human_similarity" / "answers.csv").read_text().splitlines()
    )
    with_majority = [
        (d[index(row["reference"]), index(row["a"])] < d[index(row["reference"]), index(row["b"])])
        == (int(row["votes_a"]) > int(row["votes_b"]))
        for row in rows
        if row["votes_a"] != row["votes_b"]
    ]
    assert np.mean(with_majority) > 0.82
