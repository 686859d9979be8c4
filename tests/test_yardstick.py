"""The yardstick: its measures, splits, methods, and the page."""

import json

import flip_evaluator
import numpy as np
import pytest
from numpy.testing import assert_allclose
from skimage.metrics import structural_similarity

from halfway import yardstick
from halfway.brdf import TabularBrdf, difference, tabulate
from halfway.colour import to_srgb
from halfway.errors import FormatError, HalfwayError
from halfway.formats import NeuralBrdf
from halfway.halfdiff import Grid
from halfway.library import open_library
from halfway.look import flip, shown
from halfway.tasks import Threads, Work
from halfway.yardstick import neural_fit
from halfway.yardstick.benchmark import _reconstructed, _Run, benchmark
from halfway.yardstick.data import gridded, part, values_of
from halfway.yardstick.journal import Journal
from halfway.yardstick.reconstruction import RECONSTRUCTIONS, Linear, LogRelative, Root
from halfway.yardstick.results import Result
from halfway.yardstick.scores import MEASURES, Judge, ssim
from halfway.yardstick.sparse import RECOVERIES, RecoveryMethod, Sampling
from halfway.yardstick.splits import kind_of, split

GRID = Grid.merl(8, 4, 6)


@pytest.fixture(scope="module")
def abc():
    return open_library("builtin:merl-abc")


@pytest.fixture(scope="module")
def tables(abc):
    """Ten published fits on a coarse grid."""
    return gridded(part(abc, abc.names[:10]), GRID)


@pytest.fixture(scope="module")
def judge():
    return Judge.of(GRID)


# Measures


def pictures(seed=0):
    rng = np.random.default_rng(seed)
    smooth = np.cumsum(rng.normal(size=(48, 48, 3)), axis=1) / 8
    return smooth % 1, np.clip(smooth % 1 + 0.1 * rng.normal(size=(48, 48, 3)), 0, 2)


def test_flip_is_that_of_its_authors():
    """Their filters are in single precision, of a picture as wide as they are: 1e-3 is a fourth of a grey level of its map."""
    a, b = pictures()
    coded = [np.ascontiguousarray(to_srgb(shown(x)), np.float32) for x in (a, b)]
    expected = flip_evaluator.evaluate(*coded, "LDR", applyMagma=False)[1]
    assert flip(a, b) == pytest.approx(float(expected), abs=1e-3)
    assert flip(a, a) == 0


def test_ssim_is_that_of_scikit_image():
    a, b = (to_srgb(x) for x in pictures())
    _, expected = structural_similarity(
        a, b, channel_axis=-1, data_range=1.0, gaussian_weights=True, use_sample_covariance=False, full=True
    )  # fmt: skip
    assert_allclose(ssim(a, b), expected.mean(axis=-1), atol=1e-10)


def test_a_table_is_no_different_from_itself(judge, tables):
    scores = judge.knowing(tables.row(0)).scores(tables.row(0))
    assert set(scores) == set(MEASURES)
    for name, value in scores.items():
        best = {"psnr": 99.0, "ssim": 1.0}.get(name.partition(".")[0], 0.0)
        assert value == pytest.approx(best, abs=1e-9), name


def test_what_is_negative_counts_as_0(judge, tables):
    known, row = judge.knowing(tables.row(0)), tables.row(0)
    assert known.scores(-row) == known.scores(0 * row)


def test_the_table_measures_are_those_of_the_package(judge, tables):
    a, b = tables.brdf(tables.names[0]), tables.brdf(tables.names[1])
    truth, estimate = (x.values.reshape(3, -1) for x in (a, b))
    scores = judge.knowing(truth).scores(estimate)
    assert scores["log-relative"] == difference(a, b, "log-relative").below


# Splits


def test_the_split_of_liu_leaves_20_of_100(abc):
    (fold,) = split("liu2023", abc.names).folds
    assert len(fold.train) == 80
    assert len(fold.test) == 20
    assert {"teflon", "pickled-oak-260"} <= set(fold.test)
    assert not set(fold.train) & set(fold.test)


@pytest.mark.parametrize("name", ["kind", "leave-one-out"])
def test_every_material_is_judged_once_by_others(abc, name):
    chosen = split(name, abc.names)
    assert sorted(chosen.test) == sorted(abc.names)
    assert all(not set(fold.train) & set(fold.test) for fold in chosen.folds)


def test_kinds_are_what_names_say():
    names = [
        "red-metallic-paint",
        "light-red-paint",
        "pink-felt",
        "ss440",
        "cherry-235",
        "hematite",
    ]
    kinds = ["metallic paint", "paint", "fabric", "metal", "wood", "stone and other"]
    assert [kind_of(name) for name in names] == kinds


def test_a_split_of_other_materials_is_refused():
    with pytest.raises(HalfwayError, match="20 of the 20 test materials of liu2023 are not in"):
        split("liu2023", ["a", "b"])
    with pytest.raises(HalfwayError, match="say the kind"):
        split("kind", ["a", "b"])
    with pytest.raises(HalfwayError, match="there is no split 'half'"):
        split("half", ["a", "b"])


# Methods


@pytest.mark.parametrize("mapping", [Linear, Root, LogRelative])
def test_a_mapping_goes_there_and_back(tables, mapping):
    mapped, values = mapping(tables), values_of(tables)
    counted = np.broadcast_to(GRID.mask().ravel(), values.shape)
    back = mapped.back(mapped.to(values))
    # Of the log-relative one what is below its epsilon loses digits of single precision.
    assert_allclose(back[counted], values[counted], rtol=1e-4, atol=2e-4)


@pytest.mark.parametrize("name", RECONSTRUCTIONS)
def test_a_method_reconstructs_what_it_learned(judge, tables, name):
    few = part(tables, tables.names[:3])
    k, values = list(RECONSTRUCTIONS[name](tables, few, [9]))[-1]
    assert k in (1, 9)
    scores = [judge.knowing(truth).scores(found) for truth, found in zip(*(np.moveaxis(x, 1, 0) for x in (values_of(few), values)), strict=True)]  # fmt: skip
    assert max(each["mean-log"] for each in scores) < 0.01


@pytest.mark.parametrize("name", RECOVERIES)
def test_a_method_recovers_what_it_learned_from_many_samples(judge, tables, name):
    sampling = RECOVERIES[name].method(tables, 12, np.random.default_rng(0))
    material = tables.brdf(tables.names[2])
    recovered = sampling.complete(material.eval(sampling.wi, sampling.wo))
    known = judge.knowing(tables.row(2))
    scores, nothing = known.scores(recovered), known.scores(0 * tables.row(2))
    assert scores["mean-log"] < nothing["mean-log"] / 4


def test_results_of_draws_have_an_interval():
    draws = [[{"log": x}, {"log": x + 2}] for x in (0.0, 1.0, 2.0)]
    result = Result.of("recover", "liu2023", "mine", 5, draws)
    assert (result.scores, result.n_materials, result.n_draws) == ({"log": 2.0}, 2, 3)
    assert result.low["log"] == pytest.approx(1.05)
    assert result.high["log"] == pytest.approx(2.95)


def test_a_network_fits_what_a_network_made():
    """Five times nearer than the best constant, in the loss that it lowers: where that is not lowered, it stays there."""
    rng = np.random.default_rng(4)
    layers = [rng.normal(size=shape, scale=0.4).astype(np.float32) for shape in neural_fit.SHAPES]
    grid = Grid.merl(12, 6, 8)
    truth = tabulate(NeuralBrdf(*layers), grid)
    known = Judge.of(grid).knowing(truth.values.reshape(3, -1))
    network = neural_fit.fitted(truth, n_steps=4000)
    constant = np.nanmedian(truth.values.reshape(3, -1), axis=1, keepdims=True)
    found = known.scores(network.sample_rows(grid, slice(None)).reshape(3, -1))
    assert found["mean-log"] < known.scores(constant + 0 * known.truth)["mean-log"] / 5


def test_a_network_that_is_dark_does_not_stay_so(monkeypatch):
    """It begins below 0 in every channel, where max(0, exp(y) - 1) has no slope."""
    begin = neural_fit._start

    def darkly(rng, f):
        layers = begin(rng, f)
        layers[-1][:] = -1
        return layers

    monkeypatch.setattr(neural_fit, "_start", darkly)
    white = TabularBrdf(np.full((3, *GRID.shape), 0.3, np.float32), GRID)
    values = neural_fit.fitted(white, n_steps=400).sample_rows(GRID, slice(None))
    assert np.nanmean(values) > 0.2


@pytest.mark.parametrize(("own", "settings"), [((4, 4, 4), [4]), ((3, 4, 5), [0])])
def test_a_method_that_chooses_its_numbers_by_fold_has_one_result(tables, own, settings):
    """Of all materials; k is 0 where it is not the same in all folds, also where it is by chance one that is asked for."""
    few = part(tables, tables.names[:3])
    numbers = iter(own)

    def method(train, test, ks):
        del train, ks
        yield next(numbers), values_of(test)

    run = _Run.of(few, Journal.open(None, {}), Work(Threads(1)))
    on = split("leave-one-out", few.names)
    results = list(_reconstructed(run, on, {"mine": method}, [3, 5]))
    assert [(r.setting, r.n_materials) for r in results] == [(k, 3) for k in settings]


# A run that is stopped


def twice(journal, stop_at=None):
    measured = []

    def measure(x):
        if x == stop_at:
            raise KeyboardInterrupt
        measured.append(x)
        return [2 * x]

    return journal.run(measure, [0, 1, 2], ("t", 5), Work(Threads(1)), label=""), measured


def test_what_was_measured_is_not_measured_again(tmp_path):
    path = tmp_path / "measured.jsonl"
    with pytest.raises(KeyboardInterrupt):
        twice(Journal.open(path, {"seed": 0}), stop_at=2)
    n_known = len(path.read_text().splitlines()) - 1
    results, measured = twice(Journal.open(path, {"seed": 0}))
    assert results == [[0], [2], [4]]
    assert measured == [0, 1, 2][n_known:]


def test_a_line_that_was_cut_off_is_measured_again(tmp_path):
    path = tmp_path / "measured.jsonl"
    twice(Journal.open(path, {"seed": 0}))
    path.write_text(path.read_text()[:-4])
    for again in ([2], []):
        results, measured = twice(Journal.open(path, {"seed": 0}))
        assert (results, measured) == ([[0], [2], [4]], again)


def test_a_run_that_goes_on_counts_the_time_before(tmp_path):
    path = tmp_path / "measured.jsonl"
    path.write_text('{"of": {"seed": 0}, "seconds": 0}\n{"unit": ["t", 5, 0], "scores": [0], "seconds": 60}\n')  # fmt: skip
    assert Journal.open(path, {"seed": 0}).seconds > 60
    twice(Journal.open(path, {"seed": 0}))
    assert all(json.loads(line)["seconds"] > 60 for line in path.read_text().splitlines())


def test_what_a_run_with_another_seed_measured_is_refused(tmp_path):
    path = tmp_path / "measured.jsonl"
    twice(Journal.open(path, {"seed": 0}))
    with pytest.raises(
        HalfwayError, match=r"measured\.jsonl .* of another seed: expected the same"
    ):
        Journal.open(path, {"seed": 1})


# The whole


@pytest.fixture(scope="module")
def measured(abc):
    """With two methods alone, one of each task, given as a user would."""

    def half(train, test, ks):
        del train
        yield ks[0], values_of(test) / 2

    def blind(train, n, rng):
        wi = np.tile([0.0, 0.0, 1.0], (n, 1))
        del train, rng
        return Sampling(wi, wi, lambda values: np.broadcast_to(values[0][:, None], (3, GRID.size)))

    return benchmark(
        abc,
        quick=True,
        grid=GRID,
        reconstructions={"half": half},
        recoveries={"blind": RecoveryMethod(blind)},
    )


def test_a_method_is_one_function(measured):
    assert {r.method for r in measured.of("reconstruct")} == {"half", "SGD fit"}
    assert {r.method for r in measured.of("recover")} == {"blind"}
    assert {r.method for r in measured.of("halfway")} == {"linear", "root", "log", "lobes"}
    assert measured.skipped["ABC fit"] == "the library is made of these fits"


def test_the_page_holds_itself(measured, tmp_path):
    yardstick.write_page(tmp_path, measured)
    html = (tmp_path / "benchmark.html").read_text()
    assert 'src="data:image/svg+xml' in html
    assert "|" not in html.partition("<h2>In short")[2].partition("<h2>What others")[0]
    assert "published" in html
    document = json.loads((tmp_path / "benchmark.json").read_text())
    assert document["format"] == 1
    assert len(document["results"]) == len(measured.results)


def test_what_is_no_neural_process_is_told(tmp_path):
    path = tmp_path / "weights.h5"
    path.write_bytes(b"nothing")
    with pytest.raises(FormatError, match="holds no neural process"):
        yardstick.NeuralProcess.read(path)


def test_the_published_neural_process_decodes_its_own_materials(judge, shared_data):
    """Against another fit of the same measurements."""
    networks = yardstick.NeuralProcess.read(shared_data / "npbrdf" / "np_weights.h5")
    fits = open_library(str(shared_data / "nbrdf" / "merl_nbrdf.zip"))
    few = gridded(part(fits, ["gold-paint", "teflon"]), GRID)
    latent = shared_data / "npbrdf" / "latent_vectors"
    for i, name in enumerate(few.names):
        z = np.load(latent / f"{name}_latentVector.npy")[0].ravel().astype(np.float32)
        table = TabularBrdf(networks.table(z, GRID).reshape(3, *GRID.shape), GRID)
        assert judge.knowing(few.row(i)).scores(table.values.reshape(3, -1))["mean-log"] < 0.02
