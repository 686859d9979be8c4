"""What may be written over: a file that this command line wrote, and that nobody has changed since; nothing else unasked."""

from collections.abc import Generator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path

from ..errors import OutputError
from ..locations import Location, absolute
from . import console


@contextmanager
def writing(*files: Location | None, force: bool) -> Generator[None]:
    """The block writes these files.

    Raises
    ------
    OutputError
        When one of them is there, is not as an earlier command left it, and ``force`` is not given.
    """
    named = [file for file in files if file is not None]
    for file in named:
        if not force and file.exists() and _noted(file) != _state(file):
            raise OutputError(
                f"{file} is there, and was not written by halfway or was changed since: expected a new file. "
                "Choose another with -o, or add --force to replace it."
            )
    yield
    for file in named:
        with suppress(OSError):  # what is not noted is not written over
            note = _note(file)
            note.parent.mkdir(parents=True, exist_ok=True)
            note.write_text(_state(file), encoding="utf-8")


def _state(file: Location) -> str:
    status = file.stat()
    return f"{status.st_size} {getattr(status, 'st_mtime_ns', 0)}"


def _noted(file: Location) -> str:
    with suppress(OSError):
        return _note(file).read_text(encoding="utf-8")
    return ""


def _note(file: Location) -> Path:
    """Where the state of a file is kept, as it was when it was written."""
    name = sha256(str(absolute(file)).encode()).hexdigest()[:32]
    folder = console.cache_folder()
    if folder is None:
        raise FileNotFoundError("this user has no home")
    return folder / "written" / name
