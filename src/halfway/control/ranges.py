"""Ranges: from the least to the most of an attribute that mixes have, where wishes hold.

From a mix that has them each step goes as far as can be beyond the value before, until there is nothing beyond: W. Dinkelbach, "On
Nonlinear Fractional Programming", Management Science 13, 1967. Where all is linear in the weights, that is the end. Where it is not,
a step goes towards what would be the farthest if it were, about the materials or else about where it stands, as far as what is wished for
stays near enough: what it ends with some mix has, and others may go farther.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..instruments import Attribute
from .newton import Linearised
from .programme import Weights, solve
from .reader import Reading
from .wishes import Values, Wishes, row_of

N_STEPS = 50
"""Of the search for an end; a ratio takes three or four."""
SAME = 1e-9
"""A step that moves the end by less, as a share, is the last."""
SHARES = tuple(0.5**k for k in range(6))
"""Of a step, which are tried in turn."""


class Range(NamedTuple):
    """From the least to the most of an attribute."""

    low: float
    high: float


@dataclass(frozen=True)
class Walk:
    """To the ends of an attribute, where wishes hold, among mixes."""

    wanted: Attribute
    wishes: Wishes
    mixes: Linearised

    def range(self, start: Weights) -> Range:
        """The ends, from a mix that has what is wished for."""
        return Range(self._end(start, -1), self._end(start, 1))

    def _end(self, weights: Weights, sign: int) -> float:
        readings = self.mixes.readings(weights)
        for _ in range(N_STEPS):
            farther = self._farther(weights, readings, sign)
            if farther is None:
                break
            weights = farther
            readings = self.mixes.readings(weights)
        return self._number(readings)

    def _farther(self, weights: Weights, readings: Reading, sign: int) -> Weights | None:
        value = self._number(readings)
        least = SAME * max(abs(value), SAME) if self.mixes.is_linear else self.wanted.close / 10
        (condition,) = self.wanted.conditions(value, self.wishes.exact)
        for about in self._abouts(weights):
            ahead = solve(-sign * row_of(condition, about), self.wishes.goals(about))
            for there in self._between(weights, ahead):
                if sign * (self._number(self.mixes.readings(there)) - value) > least:
                    return there
        return None

    def _between(self, weights: Weights, ahead: Weights | None) -> Iterator[Weights]:
        """Mixes on the way that have what is wished for, the farthest first."""
        if ahead is None:
            return
        for share in SHARES:
            there = self.mixes.corrected((1 - share) * weights + share * ahead)
            if there is not None:
                yield there

    def _abouts(self, weights: Weights) -> Iterator[Values]:
        yield self.mixes.values
        if not self.mixes.is_linear:
            yield self.mixes.about(weights)

    def _number(self, readings: Reading) -> float:
        """The value; the most there is where there is none, as a matte mix has no highlight."""
        value = float(self.wanted.of(readings))
        return self.wanted.most if np.isnan(value) else value
