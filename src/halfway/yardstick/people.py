"""The task `triplets`: which of two materials looks more like a third, as people answered.

    reference,a,b,votes_a,votes_b       a CSV file, materials by name

raw        share of the votes that a distance is with
majority   share of the triplets in which it is with the larger number of votes; ties are left out
"""

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float64

from ..errors import FormatError
from ..library import Library
from ..look import CellSamples
from ..people import distances
from ..tasks import Work

METRICS: Mapping[str, str] = {
    "L2 of f cos": "cosine",
    "cube root": "cube-root",
    "log": "log",
    "log-relative": "log-relative",
}
COLUMNS = ("reference", "a", "b", "votes_a", "votes_b")


def agreements(path: Path, library: Library, *, work: Work) -> dict[str, dict[str, float]]:
    """How far each distance agrees with people.

    Raises
    ------
    FormatError
        When the file does not hold answers about materials of the library.
    """
    triplets, votes = _read(path, library)
    samples = CellSamples.fit(library, work=work)
    apart = {
        name: _pairwise(samples.features(samples.values, metric))  # pyright: ignore[reportArgumentType]
        for name, metric in METRICS.items()
    }
    apart["halfway.distances"] = distances(library, work=work)
    return {name: _agreement(each, triplets, votes) for name, each in apart.items()}


def _agreement(
    apart: Float64[np.ndarray, "N N"] | np.ndarray, triplets: np.ndarray, votes: np.ndarray
) -> dict[str, float]:
    reference, a, b = triplets.T
    with_a = apart[reference, a] < apart[reference, b]
    decided = votes[:, 0] != votes[:, 1]
    right = with_a == (votes[:, 0] > votes[:, 1])
    return {
        "raw": float(np.where(with_a, *votes.T).sum() / votes.sum()),
        "majority": float(right[decided].mean()),
    }


def _pairwise(features: np.ndarray) -> np.ndarray:
    return np.stack([np.linalg.norm(features - row, axis=1) for row in features])


def _read(path: Path, library: Library) -> tuple[np.ndarray, np.ndarray]:
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows or not set(COLUMNS) <= set(rows[0]):
        raise FormatError(f"{path} holds no answers: expected the columns {', '.join(COLUMNS)}.")
    triplets = [[library.index(row[name]) for name in COLUMNS[:3]] for row in rows]
    return np.array(triplets), np.array(
        [[row[name] for name in COLUMNS[3:]] for row in rows], float
    )
