"""Small dear results, kept in a folder under a key that changes when their input does."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..errors import OutputError
from ..files import replacing


def cached(
    folder: Path | None, key: str, compute: Callable[[], dict[str, np.ndarray]]
) -> dict[str, np.ndarray]:
    """The arrays that ``compute`` gives, from ``folder`` when it has them under ``key``.

    A folder that cannot be written costs the time to compute again, never the result; a damaged file is replaced.
    """
    if folder is None:
        return compute()
    path = folder / f"{key}.npz"
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            return dict(archive)
    except Exception:
        pass
    arrays = compute()
    try:
        with replacing(path) as temporary:
            np.savez(temporary, **arrays)  # pyright: ignore[reportArgumentType] (arrays by name)
    except OutputError:
        pass
    return arrays
