"""Weights along a way: piecewise linear functions of t.

A straight line through a triangulation has barycentric weights that are linear between the places where it changes its
simplex. So a way is a few *knots* with the weights at each, exact everywhere between; a route is ways one after another,
and another pace moves its knots.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64


@dataclass(frozen=True, eq=False)
class Way:
    """The weights of N materials as a function of t in [0, 1], linear between knots."""

    knots: Float64[np.ndarray, " n_knots"]
    """Ascending from 0 to 1."""
    weights: Float64[np.ndarray, "*channels n_knots N"]
    """At the knots: for each channel, or the same for all."""

    @classmethod
    def between(
        cls, start: int, stop: int, n: int, crossings: Sequence[tuple[float, np.ndarray]] = ()
    ) -> "Way":
        """The way from one of ``n`` materials to another, exactly, through the weights at each t of ``crossings``."""
        weights = np.zeros((2 + len(crossings), n))
        weights[0, start] = weights[-1, stop] = 1.0
        for i, (_, here) in enumerate(crossings, 1):
            weights[i] = here
        return cls(np.array([0.0, *(t for t, _ in crossings), 1.0]), weights)

    @classmethod
    def of_channels(cls, ways: Sequence["Way"]) -> "Way":
        """One way for several channels, at the knots of all; a knot more on a linear piece changes nothing."""
        if len(ways) == 1:
            return cls(ways[0].knots, np.stack([ways[0].weights] * 3))
        knots = np.unique(np.concatenate([way.knots for way in ways]))
        return cls(knots, np.stack([way.at(knots) for way in ways]))

    @classmethod
    def chain(cls, ways: Sequence["Way"]) -> "Way":
        """The ways one after another, each in an equal share of t; each begins where the one before ends."""
        # The last knot of a way is the first of the next.
        knots = [(i + way.knots[:-1]) / len(ways) for i, way in enumerate(ways)]
        weights = [way.weights[..., :-1, :] for way in ways]
        return cls(
            np.append(np.concatenate(knots), 1.0),
            np.concatenate([*weights, ways[-1].weights[..., -1:, :]], axis=-2),
        )

    @classmethod
    def mean(cls, ways: Sequence["Way"], shares: Float64[np.ndarray, "3 n_ways"]) -> "Way":
        """The weighted mean of ways, with a share of each for each channel, at the knots of all."""
        if len(ways) == 1:
            return ways[0]
        knots = np.unique(np.concatenate([way.knots for way in ways]))
        weights = sum(
            share[:, None, None] * way.at(knots) for share, way in zip(shares.T, ways, strict=True)
        )
        return cls(knots, np.asarray(weights))

    def at(self, t: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, "*channels n N"]:
        """Weights at each ``t``, exact on the knots."""
        piece = np.clip(np.searchsorted(self.knots, t, side="right") - 1, 0, len(self.knots) - 2)
        start, stop = self.knots[piece], self.knots[piece + 1]
        share = ((t - start) / (stop - start))[:, None]
        return (1 - share) * self.weights[..., piece, :] + share * self.weights[..., piece + 1, :]
