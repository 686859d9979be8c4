"""Fit the distance that agrees with people, and judge it by answers about other materials.

    python benchmarks/human_distance.py answers.csv merl_nbrdf.brdflib [--write]

``answers.csv`` holds the answered triplets of Lagunas et al. 2019 by name: reference, a, b, votes_a, votes_b; it is no part of
the package. Cross-validation: the materials are split into groups, and for each pair of groups the answers that choose between
a material of one and a material of the other are foretold by weights that were fitted to answers in which no material of
either occurs, neither as a choice nor as the reference.

raw        share of the votes that the distance is with
majority   share of the triplets in which it is with the larger number of votes; ties are left out
"""

import argparse
import csv
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

from halfway.brdf.metrics import Metric
from halfway.cache import user_folder
from halfway.library import Library, open_library
from halfway.look import CellSamples
from halfway.people import features
from halfway.tasks import Work

N_GROUPS = 10
SHRINKAGE = 1e-3
"""Of the squared weights of features of unit variance, against the mean log likelihood of a vote."""
N_BOOTSTRAPS = 1000
METRICS: dict[str, Metric] = {
    "L2": "cosine",
    "cube root": "cube-root",
    "log-relative": "log-relative",
}


def main() -> None:
    """Print how well each distance agrees with people, and the weights of ours."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("answers", type=Path)
    parser.add_argument("library")
    parser.add_argument("--write", action="store_true", help="the weights into the package")
    options = parser.parse_args()
    library, work = open_library(options.library), Work(cache=user_folder())
    triplets, votes = read(options.answers, library)
    values = features(library, work=work)
    phi = np.stack(list(values.values()), axis=1)
    spread = phi.std(axis=0)
    print(f"{len(votes):,} triplets; {(votes[:, 0] == votes[:, 1]).mean():.1%} of them ties")
    print(f"{'':14}  raw                    majority")
    samples = CellSamples.fit(library, work=work)
    for name, metric in METRICS.items():
        mapped = samples.features(samples.values, metric)
        report(name, margins(pairwise(mapped), triplets), triplets, votes)
    near, far = apart(phi / spread, triplets)
    report("ours", foretold(near, far, triplets, votes), triplets, votes)
    weights = fitted(near, far, votes) / spread
    report("ours, fitted", (far - near) @ (weights * spread), triplets, votes)
    if options.write:
        write(dict(zip(values, weights, strict=True)))


def read(path: Path, library: Library) -> tuple[np.ndarray, np.ndarray]:
    """Indices of reference, a and b, and the votes for a and b."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    names = ("reference", "a", "b")
    indices = np.array([[library.index(row[name]) for name in names] for row in rows])
    votes = np.array([[row["votes_a"], row["votes_b"]] for row in rows], float)
    return indices, votes


def pairwise(features: np.ndarray) -> np.ndarray:
    """Euclidean distances."""
    return np.stack([np.linalg.norm(features - row, axis=1) for row in features])


def margins(distances: np.ndarray, triplets: np.ndarray) -> np.ndarray:
    """How much farther b is from the reference than a."""
    reference, a, b = triplets.T
    return distances[reference, b] - distances[reference, a]


def apart(phi: np.ndarray, triplets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """By feature, how far a and b are from the reference."""
    reference, a, b = phi[triplets.T]
    return np.abs(reference - a), np.abs(reference - b)


def foretold(
    near: np.ndarray, far: np.ndarray, triplets: np.ndarray, votes: np.ndarray
) -> np.ndarray:
    """The margin of each triplet, by weights that know neither of its choices."""
    group = np.random.default_rng(0).permutation(triplets.max() + 1) % N_GROUPS
    _, a, b = (groups := group[triplets]).T
    margin = np.full(len(votes), np.nan)
    for i in range(N_GROUPS):
        for j in range(i, N_GROUPS):
            test = ((a == i) & (b == j)) | ((a == j) & (b == i))
            known = ~np.isin(groups, (i, j)).any(axis=1)
            margin[test] = (far - near)[test] @ fitted(near[known], far[known], votes[known])
    return margin


def fitted(near: np.ndarray, far: np.ndarray, votes: np.ndarray) -> np.ndarray:
    """Weights, none negative, of the largest likelihood of the votes: a logistic regression."""
    margins = far - near
    for_a, for_b = (votes / votes.sum()).T

    def loss(w: np.ndarray) -> tuple[float, np.ndarray]:
        margin = margins @ w
        value = for_a @ np.logaddexp(0, -margin) + for_b @ np.logaddexp(0, margin)
        share = 1 / (1 + np.exp(-margin))
        gradient = ((for_a + for_b) * share - for_a) @ margins
        return value + SHRINKAGE * w @ w, gradient + 2 * SHRINKAGE * w

    start = np.full(near.shape[1], 0.1)
    options = {"ftol": 1e-12, "gtol": 1e-8}
    bounds = [(0, None)] * len(start)
    return minimize(loss, start, jac=True, bounds=bounds, method="L-BFGS-B", options=options).x


def report(name: str, margin: np.ndarray, triplets: np.ndarray, votes: np.ndarray) -> None:
    """Raw and majority agreement, with intervals of 95 % by drawing references anew."""
    with_a = margin > 0
    won, total = np.where(with_a, *votes.T), votes.sum(axis=1)
    decided = votes[:, 0] != votes[:, 1]
    right = decided & (with_a == (votes[:, 0] > votes[:, 1]))
    sums = np.stack([np.bincount(triplets[:, 0], x) for x in (won, total, right, decided)])
    drawn = np.random.default_rng(0).integers(0, sums.shape[1], (N_BOOTSTRAPS, sums.shape[1]))
    again = sums[:, drawn].sum(axis=2)
    shown = []
    for k in (0, 2):
        low, high = np.percentile(again[k] / again[k + 1], [2.5, 97.5])
        shown.append(f"{sums[k].sum() / sums[k + 1].sum():.2%} ({low:.1%} to {high:.1%})")
    print(f"{name:14}  {'  '.join(shown)}")


def write(weights: dict[str, float]) -> None:
    """Those that count, into the package."""
    import halfway.people

    path = Path(halfway.people.__file__).parent / "data" / "similarity.csv"
    least = 1e-6 * max(weights.values())
    lines = [f"{name},{weight:.6g}" for name, weight in weights.items() if weight > least]
    path.write_text("\n".join(["feature,weight", *lines]) + "\n")
    print(f"{path}: {len(lines)} of {len(weights)} features")


if __name__ == "__main__":
    main()
