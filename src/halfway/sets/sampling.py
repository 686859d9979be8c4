"""New materials drawn evenly from a space, none that looks like another, and no parent in two splits."""

from collections.abc import Mapping
from fractions import Fraction
from functools import partial
from math import inf
from typing import Any

import numpy as np
from jaxtyping import Int

from ..errors import SpaceError
from ..library import Library, Permuted, open_library
from ..look import Looks
from ..recipes import Blend
from ..space import Space, make_space
from ..tasks import HERE, Work
from .apart import Apart
from .candidates import THINNING, Candidate, Weighed, candidates, materials
from .diversity import Diversity
from .drawing import Drawing, squared_distances
from .sets import SampleSet

LEAST = 1.0
"""How different any two samples, and a sample and a material of the library, look at the least."""
SPLITS: Mapping[str, float] = {"train": 80, "validation": 10, "test": 10}
"""Shares of the samples, and of the materials that they are mixed from."""
N_AT_ONCE = 256
"""Candidates that are looked at before any is taken, at the most."""
MOST_TRIES = 20
"""Candidates for each sample, before a set is found too crowded."""


def sample(
    library: Library | str,
    n: int = 2400,
    *,
    seed: int = 0,
    space: Space | str = "anchored",
    blend: Blend | str | None = None,
    permute_channels: bool = False,
    least: float = LEAST,
    splits: Mapping[str, float] = SPLITS,
    work: Work = HERE,
) -> SampleSet:
    """``n`` new materials, drawn evenly by what is seen; the same for the same seed.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    space : Space or str
        Where they are drawn from.
    blend : Blend or str, optional
        How they are mixed; the space's own, where none is given.
    permute_channels : bool
        Put the colour channels of each in an order that is drawn too.
    least : float
        How different any two, and one and a material of the library, look at the least: mean CIELAB difference on a lit sphere.
    splits : mapping of str to float
        Shares of samples by name. The samples of each are mixed from materials of its own, as large a share of them.

    Examples
    --------
    >>> from halfway.sets import sample
    >>> new = sample("builtin:synthetic-8", 3, splits={"train": 80, "test": 20})
    >>> parents = {split: set(names) for split, names in new.splits.items()}
    >>> parents["train"] & parents["test"]
    set()

    Raises
    ------
    SpaceError
        When so many do not fit, a split has fewer than two materials, or there is nothing to be drawn from.
    """
    if n < 1:
        raise SpaceError(f"a set of {n} materials is none: expected 1 or more.")
    opened = open_library(library)
    parents = _parents(len(opened), splits, seed)
    whole = Looks.fit(opened, work=work)
    fit = partial(make_space, blend=blend, looks=whole, work=work)
    fitted = fit(space, opened) if isinstance(space, str) else space
    looks = whole.thinned(THINNING)
    alone = materials(looks, work=work)
    squares = squared_distances(np.stack([each.picture for each in alone]))
    apart = Apart(np.stack([each.picture for each in alone]))
    orders = Permuted.ORDERS if permute_channels else Permuted.ORDERS[:1]
    chosen: dict[str, list[Candidate]] = {}
    counts = dict(zip(splits, _apportioned(n, splits), strict=True))
    for i, (split, own) in enumerate(parents.items()):
        drawn = _Drawn(Drawing.of(fitted, own, squares), orders, np.random.default_rng([seed, i]))
        chosen[split] = _taken(drawn, counts[split], looks, fitted.blend, apart, least, work)
    how: dict[str, Any] = {
        "by": "halfway sample",
        "n": n,
        "seed": seed,
        "space": fitted.name,
        "least": least,
        "permute_channels": permute_channels,
    }
    return SampleSet.of(
        opened,
        fitted.blend,
        chosen,
        {split: [opened.names[j] for j in np.sort(own)] for split, own in parents.items()},
        how=how,
        diversity=Diversity.of(
            [each for some in chosen.values() for each in some], alone, work=work
        ),
    )


class _Drawn:
    """Weights one after another, in orders of the channels that are drawn too."""

    def __init__(self, drawing: Drawing, orders: tuple[str, ...], rng: np.random.Generator) -> None:
        self._drawing, self._orders, self._rng = drawing, orders, rng

    def more(self, n: int) -> list[Weighed]:
        weights = self._drawing.draw(self._rng, n)
        orders = self._rng.integers(len(self._orders), size=n)
        return [Weighed(weights[:, i], self._orders[k]) for i, k in enumerate(orders)]


def _taken(
    drawn: _Drawn, n: int, looks: Looks, blend: Blend, apart: Apart, least: float, work: Work
) -> list[Candidate]:
    """``n`` candidates that look different enough from all that are there, which they then are among."""
    taken: list[Candidate] = []
    n_tried = 0
    while len(taken) < n:
        # A set fills up: if it takes more tries than that now, it does so all the more later.
        if n_tried >= MOST_TRIES * min(n, len(taken) + N_AT_ONCE):
            raise SpaceError(
                f"only {len(taken):,} of {n:,} materials look at least {least:g} different from each other after {n_tried:,} "
                "tries: expected room for all. Take fewer, let them be nearer with --least, or permute their channels."
            )
        some = drawn.more(min(n, N_AT_ONCE))
        n_tried += len(some)
        for candidate in candidates(looks, blend, some, work=work):
            if len(taken) < n and apart.nearest(candidate.picture, within=least) >= least:
                taken.append(candidate)
                apart.add(candidate.picture)
    return taken


def _parents(
    n: int, splits: Mapping[str, float], seed: int
) -> dict[str, Int[np.ndarray, " n_own"]]:
    """The materials that each split has for its own, in an order that is drawn."""
    counts = _apportioned(n, splits)
    for split, count in zip(splits, counts, strict=True):
        if count < 2:
            raise SpaceError(
                f"the split {split!r} gets {count} of {n} materials to mix: expected 2 or more. "
                "Take fewer splits or other shares, such as --split all=100."
            )
    order = np.random.default_rng(seed).permutation(n)
    return dict(zip(splits, np.split(order, np.cumsum(counts)[:-1]), strict=True))


def _apportioned(n: int, splits: Mapping[str, float]) -> list[int]:
    """``n`` things by shares, as whole numbers that sum to n: the largest remainders are rounded up."""
    if not splits or not all(0 < share < inf for share in splits.values()):
        raise SpaceError(
            f"the splits {dict(splits)} are none: expected positive shares, such as train=80,test=20."
        )
    total = sum(map(Fraction, splits.values()))
    quotas = [n * Fraction(share) / total for share in splits.values()]
    counts = [int(quota) for quota in quotas]
    remainders = sorted(range(len(quotas)), key=lambda i: counts[i] - quotas[i])
    for i in remainders[: n - sum(counts)]:
        counts[i] += 1
    return counts
