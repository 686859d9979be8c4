"""Races in one run: both sides are timed in turn, round by round, so that what else the machine does hits both alike.

A ratio is the median over the rounds.
"""

import time
from collections.abc import Callable

import numpy as np


def race(
    *runners: Callable[[], object], rounds: int = 7, after: Callable[[], object] = lambda: None
) -> np.ndarray:
    """Seconds of each of the runners in each round, (rounds, runners), in turn; one round before that warms up.

    What follows each run, such as taking away what it wrote, is not timed.
    """
    seconds = np.empty((rounds + 1, len(runners)))
    for times in seconds:
        for i, run in enumerate(runners):
            start = time.perf_counter()
            run()
            times[i] = time.perf_counter() - start
            after()
    return seconds[1:]


def ratio(seconds: np.ndarray, i: int, j: int) -> float:
    """How many times longer runner i takes than runner j."""
    return float(np.median(seconds[:, i] / seconds[:, j]))
