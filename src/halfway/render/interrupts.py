"""Ctrl-C while compiled code is under way.

Mitsuba calls back into Python while it is imported and while it traces a picture. A KeyboardInterrupt that is raised there comes
out as another error, or ends the process. So it waits; compiled code would not see it before its end anyway.
"""

import signal
import threading
from collections.abc import Generator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def interrupts_wait() -> Generator[None]:
    """Ctrl-C takes effect when the block is left, if it would in this thread at all."""
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield
        return
    pressed: list[int] = []

    def note(number: int, _: FrameType | None) -> None:
        pressed.append(number)

    signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if pressed:
            signal.raise_signal(signal.SIGINT)
