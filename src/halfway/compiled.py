"""Inner loops compiled by numba, wherever they are installed."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """``function``, compiled when it is first called, without Python's lock.

    What is compiled is kept beside the function or in the user's cache folder; where neither can be written, as in a
    container or on a cluster node, it is compiled anew in each process. ``NUMBA_CACHE_DIR`` names a folder for it.
    """
    kernel: Any
    try:
        kernel = numba.njit(nogil=True, cache=True)(function)
    except RuntimeError:  # numba's word for having no folder
        kernel = numba.njit(nogil=True)(function)
    return kernel
