"""Small dear results, kept in a folder under a key that changes when their input does.

A key is never used again once its library has changed, so the folder is kept from growing: what was used longest ago goes.
"""

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import OutputError
from .files import replacing

if TYPE_CHECKING:
    import numpy as np

MOST_BYTES = 2e9
"""What the folder holds at most, beside the newest result."""


def user_folder() -> Path | None:
    """Where results are kept for this user; None where the system does not say who that is, as in some containers."""
    import platformdirs

    try:
        folder = platformdirs.user_cache_path("halfway")
    except RuntimeError:  # of newer versions; older ones give a folder called ~
        return None
    return folder if folder.is_absolute() else None


def cached(
    folder: Path, key: str, compute: "Callable[[], dict[str, np.ndarray]]"
) -> "dict[str, np.ndarray]":
    """The arrays that ``compute`` gives, from ``folder`` when it has them under ``key``.

    A folder that cannot be written costs the time to compute again, never the result; a damaged file is replaced.
    """
    import numpy as np  # a tenth of a second, which a command without arrays does not wait for

    path = folder / f"{key}.npz"
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            arrays = dict(archive)
    except Exception:
        pass
    else:
        with suppress(OSError):
            os.utime(path)  # used now
        return arrays
    arrays = compute()
    with suppress(OutputError):
        with replacing(path) as temporary:
            np.savez(temporary, **arrays)  # pyright: ignore[reportArgumentType] (arrays by name)
        _forget_oldest(folder, path)
    return arrays


def _forget_oldest(folder: Path, newest: Path) -> None:
    """Remove what was used longest ago from ``folder``, down to `MOST_BYTES`; others may be at it too."""
    files = []
    for path in folder.glob("*.npz"):
        with suppress(OSError):
            about = path.stat()
            files.append((about.st_mtime_ns, about.st_size, path))
    n_bytes = sum(size for _, size, _ in files)
    for _, size, path in sorted(files):
        if n_bytes > MOST_BYTES and path != newest:
            n_bytes -= size
            with suppress(OSError):
                path.unlink()
