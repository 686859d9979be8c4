"""How long a test waits for what must come."""

import time
from collections.abc import Callable

PATIENCE = 300.0
"""Seconds: hundreds of times what any wait takes, so that a machine which is slow, or busy, fails no test."""


def wait_until(
    condition: Callable[[], object], pause: Callable[[], object] = lambda: time.sleep(0.001)
) -> None:
    """Until the condition holds; ``pause`` is what to do meanwhile.

    Raises
    ------
    TimeoutError
        When it does not in all of `PATIENCE`.
    """
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"what was waited for did not come in {PATIENCE:g} s")
        pause()
