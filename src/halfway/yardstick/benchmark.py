"""The benchmark: fixed data, splits, tasks, measures and methods, so that two numbers from it can be compared."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from importlib.metadata import version
from itertools import chain, product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..halfdiff import Grid
from ..judge import ladder_errors, ladders
from ..library import Library, ProceduralLibrary
from ..models import builtin
from ..recipes import Blend
from ..tasks import HERE, Work
from . import neural_fit
from .data import gridded, part
from .journal import Journal
from .people import agreements
from .reconstruction import RECONSTRUCTIONS, Reconstruction, beside, fit_each, fitted
from .results import Benchmark, Result
from .scores import Judge, Known, Scores
from .sparse import N_DRAWS, RECOVERIES, RecoveryMethod
from .splits import Fold, Split, split

GRID = Grid.merl(90, 30, 36)
QUICK_GRID = Grid.merl(30, 10, 12)
KS = (1, 2, 3, 5, 7, 10, 15, 20, 30)
NS = (1, 2, 5, 10, 20, 40, 100, 400)
QUICK_KS = (3, 10)
QUICK_NS = (5, 20)
QUICK_N_DRAWS = 3
PUBLISHED_FITS = {"ABC fit": ("merl-abc", 9), "SGD fit": ("merl-sgd", 33)}
"""Published fits by method: the set, and its numbers per material."""
MODEL_FITS = {"GGX fit (glTF)": "gltf", "OpenPBR fit": "openpbr"}
NETWORK_FIT = "NBRDF fit"
NO_FITS: Mapping[str, Reconstruction] = {}
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
    fits: Mapping[str, Reconstruction] = NO_FITS,
    journal: Path | None = None,
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
    fits
        Reconstructions that learn from no training material, beside those that are here: on the first split alone.
    journal : path, optional
        A file that notes what is measured, so that a run that was stopped goes on from there; methods count by their names.

    Raises
    ------
    HalfwayError
        When the library does not have the materials that a split or the answers name, or the journal is of another run.
    """
    on = grid or (QUICK_GRID if quick else GRID)
    chosen = [split(name, library.names) for name in splits or (SPLITS[:1] if quick else SPLITS)]
    kept = Journal.open(journal, _identity(library, on, quick, seed))
    answered = [*_triplets(answers, library, work)] if answers else []
    run = _Run.of(gridded(library, on, work=work), kept, work)
    others, skipped = _fits(library, quick, work)
    ks, ns, n_draws = (QUICK_KS, QUICK_NS, QUICK_N_DRAWS) if quick else (KS, NS, N_DRAWS)
    draws = [(seed, i) for i in range(n_draws)]
    first, *rest = chosen
    results = [*_reconstructed(run, first, {**reconstructions, **others, **fits}, ks)]
    results += _recovered(run, first, recoveries, ns, draws)
    for each in rest:
        results += _reconstructed(run, each, reconstructions, ks)
    results += _halfway(on, work)
    results += answered
    if not answers:
        skipped["triplets"] = "no file of answers was given (--answers)"
    return Benchmark(
        library.name,
        library.checksum,
        library.origin,
        on.shape,
        seed,
        tuple(results),
        kept.seconds,
        skipped,
    )


class _Run(NamedTuple):
    """What all tasks share."""

    tables: Library
    known: Mapping[str, Known]
    journal: Journal
    work: Work

    @classmethod
    def of(cls, tables: Library, journal: Journal, work: Work) -> "_Run":
        judge = Judge.of(tables.grid)
        known = {name: judge.knowing(tables.row(i)) for i, name in enumerate(tables.names)}
        return cls(tables, known, journal, work)

    def parts(self, fold: Fold) -> tuple[Library, Library]:
        """What is learned from, and what is judged."""
        return part(self.tables, fold.train), part(self.tables, fold.test)


def _identity(library: Library, grid: Grid, quick: bool, seed: int) -> dict[str, Any]:
    """What results must have in common to be of one run."""
    return {
        "version": version("halfway"),
        "library": library.checksum,
        "grid": list(grid.shape),
        "quick": quick,
        "seed": seed,
    }


def _fits(
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
    if quick:
        skipped[NETWORK_FIT] = "takes too long for the quick benchmark"
    else:
        methods[NETWORK_FIT] = fit_each(neural_fit.fitted, neural_fit.N_NUMBERS, "NBRDF", work)
    return methods, skipped


def _reconstructed(
    run: _Run, on: Split, methods: Mapping[str, Reconstruction], ks: Sequence[int]
) -> Iterator[Result]:
    for name, method in methods.items():
        rows: dict[int, list[Scores]] = {}
        fold, unit = partial(_fold, run, method, ks), ("reconstruct", on.name, name)
        by_fold = run.journal.run(fold, on.folds, unit, run.work, label=f"{on.name}: {name}")
        # Numbers of components that the method chooses itself.
        own = {k for each in by_fold for k, _ in each if len(each) == 1}
        for k, scores in chain.from_iterable(by_fold):
            rows.setdefault(k if len(own) < 2 else 0, []).extend(scores)
        for k, scores in rows.items():
            yield Result.of("reconstruct", on.name, name, k, [scores])


def _fold(
    run: _Run, method: Reconstruction, ks: Sequence[int], fold: Fold
) -> list[tuple[int, list[Scores]]]:
    train, test = run.parts(fold)
    return [
        (k, [run.known[name].scores(values[:, i]) for i, name in enumerate(test.names)])
        for k, values in method(train, test, ks)
    ]


def _recovered(
    run: _Run,
    on: Split,
    methods: Mapping[str, RecoveryMethod],
    ns: Sequence[int],
    draws: Sequence[tuple[int, int]],
) -> Iterator[Result]:
    """On the first fold of a split."""
    train, test = run.parts(on.folds[0])
    for (name, method), n in product(methods.items(), ns):
        draw, unit = partial(_draw, run, train, test, method, n), ("recover", on.name, name, n)
        tasks, label = draws[: method.n_draws], f"{n} samples: {name}"
        drawn = run.journal.run(draw, tasks, unit, run.work, label=label)
        if rows := [each for each in drawn if each]:
            yield Result.of("recover", on.name, name, n, rows)


def _draw(
    run: _Run, train: Library, test: Library, method: RecoveryMethod, n: int, draw: tuple[int, int]
) -> list[Scores]:
    seed, i = draw
    sampling = method.method(train, n, np.random.default_rng([seed, n, i]))
    if sampling is None:
        return []
    values = {name: test.brdf(name).eval(sampling.wi, sampling.wo) for name in test.names}
    return [
        run.known[name].scores(np.asarray(sampling.complete(each))) for name, each in values.items()
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
