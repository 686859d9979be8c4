"""The benchmark: fixed data, splits, tasks, measures and methods, so that two numbers from it can be compared."""

import time
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from ..halfdiff import Grid
from ..judge import ladder_errors, ladders
from ..library import Library, ProceduralLibrary
from ..models import builtin
from ..recipes import Blend
from ..tasks import HERE, Work
from .data import Values, gridded, part, values_of
from .people import agreements
from .reconstruction import RECONSTRUCTIONS, Reconstruction, beside, fitted
from .results import Benchmark, Result
from .scores import Judge, Scores
from .sparse import RECOVERIES, RecoveryMethod
from .splits import Fold, Split, split

GRID = Grid.merl(90, 30, 36)
QUICK_GRID = Grid.merl(30, 10, 12)
KS = (1, 2, 3, 5, 7, 10, 15, 20, 30)
NS = (1, 2, 5, 10, 20, 40, 100, 400)
QUICK_KS = (3, 10)
QUICK_NS = (5, 20)
N_DRAWS, QUICK_N_DRAWS = 20, 3
PUBLISHED_FITS = {"ABC fit": ("merl-abc", 9), "SGD fit": ("merl-sgd", 33)}
"""Published fits by method: the set, and its numbers per material."""
MODEL_FITS = {"GGX fit (glTF)": "gltf", "OpenPBR fit": "openpbr"}
TASKS = ("reconstruct", "recover", "halfway", "triplets")
SPLITS = ("liu2023", "kind", "leave-one-out")


def benchmark(
    library: Library,
    *,
    quick: bool = False,
    grid: Grid | None = None,
    splits: Sequence[str] | None = None,
    seed: int = 0,
    answers: Path | None = None,
    reconstructions: Mapping[str, Reconstruction] = RECONSTRUCTIONS,
    recoveries: Mapping[str, RecoveryMethod] = RECOVERIES,
    work: Work = HERE,
) -> Benchmark:
    """Every task, measured.

    Parameters
    ----------
    library : Library
        The MERL materials: measured, or stand-ins. Others take the split ``leave-one-out``.
    quick : bool
        A coarse grid, one split, few settings and draws: minutes, to see that all works.
    grid : Grid, optional
        Where materials are tabulated and compared; 90 x 30 x 36 cells unless told otherwise, 30 x 10 x 12 of the quick one.
    answers : path, optional
        Triplets that people answered (`halfway.yardstick.people`).
    reconstructions, recoveries
        The methods by name.

    Raises
    ------
    HalfwayError
        When the library does not have the materials that a split or the answers name.
    """
    start = time.monotonic()
    on = grid or (QUICK_GRID if quick else GRID)
    tables, judge = gridded(library, on, work=work), Judge.of(on)
    chosen = [split(name, library.names) for name in splits or (SPLITS[:1] if quick else SPLITS)]
    given, skipped = _without_learning(library, quick, work)
    results: list[Result] = []
    for i, each in enumerate(chosen):
        methods = dict(reconstructions) | (given if i == 0 else {})
        ks = QUICK_KS if quick else KS
        results += _reconstructed(tables, each, methods, ks, judge, work)
    draws = QUICK_N_DRAWS if quick else N_DRAWS
    ns = QUICK_NS if quick else NS
    results += _recovered(tables, chosen[0], recoveries, ns, draws, seed, judge, work)
    results += _halfway(on, work)
    if answers:
        results += _triplets(answers, library, work)
    else:
        skipped["triplets"] = "no file of answers was given (--answers)"
    seconds = time.monotonic() - start
    return Benchmark(
        library.name,
        library.checksum,
        library.origin,
        on.shape,
        seed,
        tuple(results),
        seconds,
        skipped,
    )


def _without_learning(
    library: Library, quick: bool, work: Work
) -> tuple[dict[str, Reconstruction], dict[str, str]]:
    """Fits that learn from no other material, and those that are not judged, with the reason."""
    methods: dict[str, Reconstruction] = {}
    skipped: dict[str, str] = {}
    for name, (set_name, n_numbers) in PUBLISHED_FITS.items():
        fits = builtin(set_name)
        if fits.origin.source == library.origin.source:
            skipped[name] = "the library is made of these fits"
        elif not set(library.names) <= set(fits.models):
            skipped[name] = "there are none of these materials"
        else:
            methods[name] = beside(ProceduralLibrary(set_name, fits.models), n_numbers)
    for name, model in MODEL_FITS.items():
        if quick:
            skipped[name] = "takes too long for the quick benchmark"
        else:
            methods[name] = fitted(model, work)
    return methods, skipped


def _reconstructed(
    tables: Library,
    on: Split,
    methods: Mapping[str, Reconstruction],
    ks: Sequence[int],
    judge: Judge,
    work: Work,
) -> Iterator[Result]:
    for name, method in methods.items():
        rows: dict[int, list[Scores]] = {}
        run = partial(_fold, tables, method, ks, judge)
        for per_setting in work.run(run, on.folds, label=f"{on.name}: {name}"):
            for k, scores in per_setting:
                rows.setdefault(k if k in ks or len(on.folds) == 1 else 0, []).extend(scores)
        for k, scores in rows.items():
            yield Result.of("reconstruct", on.name, name, k, [scores])


def _fold(
    tables: Library, method: Reconstruction, ks: Sequence[int], judge: Judge, fold: Fold
) -> list[tuple[int, list[Scores]]]:
    train, test = part(tables, fold.train), part(tables, fold.test)
    truth = values_of(test)
    return [(k, _scores(judge, truth, values)) for k, values in method(train, test, ks)]


def _scores(judge: Judge, truth: Values, values: Values) -> list[Scores]:
    return [judge.scores(truth[:, i], values[:, i]) for i in range(truth.shape[1])]


def _recovered(
    tables: Library,
    on: Split,
    methods: Mapping[str, RecoveryMethod],
    ns: Sequence[int],
    n_draws: int,
    seed: int,
    judge: Judge,
    work: Work,
) -> Iterator[Result]:
    """On the first fold of a split."""
    fold = on.folds[0]
    train, test = part(tables, fold.train), part(tables, fold.test)
    for name, method in methods.items():
        for n in ns:
            draw = partial(_draw, train, test, method, n, judge, seed)
            label = f"{n} samples: {name}"
            drawn = work.run(draw, range(n_draws if method.is_random else 1), label=label)
            draws = [rows for rows in drawn if rows]
            if draws:
                yield Result.of("recover", on.name, name, n, draws)


def _draw(
    train: Library, test: Library, method: RecoveryMethod, n: int, judge: Judge, seed: int, i: int
) -> list[Scores]:
    sampling = method.method(train, n, np.random.default_rng([seed, n, i]))
    if sampling is None:
        return []
    truth = values_of(test)
    values = [test.brdf(name).eval(sampling.wi, sampling.wo) for name in test.names]
    return [
        judge.scores(truth[:, j], np.asarray(sampling.complete(each)))
        for j, each in enumerate(values)
    ]


def _halfway(grid: Grid, work: Work) -> Iterator[Result]:
    pairs = [(ladder, blend) for ladder in ladders(grid) for blend in Blend]
    errors = work.run(lambda pair: ladder_errors(*pair), pairs, label="Ladders")
    for (ladder, blend), each in zip(pairs, errors, strict=True):
        rows = [
            {"log": float(log), "seen": float(seen)}
            for log, seen in zip(each.log, each.seen, strict=True)
        ]
        yield Result.of("halfway", ladder.name, str(blend), 0, [rows])


def _triplets(answers: Path, library: Library, work: Work) -> Iterator[Result]:
    for name, scores in agreements(answers, library, work=work).items():
        yield Result("triplets", answers.name, name, 0, len(library), scores)
