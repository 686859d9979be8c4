"""Fetch published data sets: resumed, verified, with their licence recorded beside them."""

from dataclasses import dataclass
from pathlib import Path

import httpx

from ..files import write_text
from .catalogue import Dataset, Download, dataset, rgl_names
from .download import Line, Progress, download
from .unpack import unpack

__all__ = ["Dataset", "Download", "Fetched", "Progress", "dataset", "fetch", "rgl_names"]

TIMEOUT = 30.0
"""Seconds without an answer."""


@dataclass(frozen=True)
class Fetched:
    """What is on disk now."""

    dataset: Dataset
    files: tuple[Path, ...]
    """The files as they were published."""
    unpacked: tuple[Path, ...]
    """What was in them, where they are zips that are unpacked."""
    licence: Path
    """Where the licence and the source are recorded."""


def fetch(
    name: str,
    folder: str | Path,
    *,
    base_url: str = "",
    progress: Progress | None = None,
) -> Fetched:
    """Get a data set into ``folder``; what is there already and verified is not fetched again.

    Parameters
    ----------
    name : str
        ``nbrdf-merl``, ``merl``, ``rgl:NAME`` or ``rgl:all``.
    folder : path
        Made if need be.
    base_url : str
        A mirror: the address before the files' names.
    progress : callable, optional
        Called with a file's name, the bytes that are there, and how many it will have (None where that is not known).

    Raises
    ------
    FetchError
        When there is no such data set, it cannot be reached, or what came is not what it should be.
    OutputError
        When it cannot be written.
    """
    wanted = dataset(name, base_url=base_url)
    folder = Path(folder)
    # A redirect may lead elsewhere, but only to http(s); proxies are taken from the environment, as users expect.
    with httpx.Client(follow_redirects=True, max_redirects=5, timeout=TIMEOUT) as client:
        line = Line(client, progress or _silent)
        files = [download(item, folder, line) for item in wanted.downloads]
    licence = folder / f"{wanted.name}.licence.txt"
    write_text(licence, _licence(wanted))
    unpacked = [path for file in files for path in unpack(file, folder)] if wanted.unpack else []
    return Fetched(wanted, tuple(files), tuple(unpacked), licence)


def _licence(wanted: Dataset) -> str:
    files = "\n".join(f"  {item.file}  {item.url}" for item in wanted.downloads)
    return (
        f"{wanted.title}\n\nLicence: {wanted.licence}\nSource: {wanted.source}\n\nFiles:\n{files}\n"
    )


def _silent(file: str, n_done: int, n_expected: int | None) -> None: ...
