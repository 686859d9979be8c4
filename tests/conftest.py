"""What several test modules share.

Shapes and dtypes in the package's annotations are checked while the tests run.
"""

import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from jaxtyping import install_import_hook

SOURCE = Path(__file__).parents[1] / "src"
# Compiled code has types of its own; a class of the renderer is made by it.
UNCHECKED = ("halfway.recipes.kernel", "halfway.render.bsdf")
MODULES = [
    ".".join(path.relative_to(SOURCE).with_suffix("").parts) for path in SOURCE.rglob("*.py")
]
install_import_hook([name for name in MODULES if name not in UNCHECKED], "typechecker.check")

from strategies import random_tables  # noqa: E402

from halfway.halfdiff import Grid  # noqa: E402 (after the hook)
from halfway.library import ProceduralLibrary  # noqa: E402

# A script's jobs in the background ignore Ctrl-C, and so does all that they start.
signal.signal(signal.SIGINT, signal.default_int_handler)

# On a busy machine a draw may take long; what a test may take is CI's business.
settings.register_profile(
    "halfway", deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("halfway")

SHARED_DATA = Path(__file__).parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Published and measured data that are not part of the repository, in ``../shared/data`` beside the checkout."""
    if not SHARED_DATA.is_dir():
        pytest.skip("needs the data folder ../shared/data, which is not part of the repository")
    return SHARED_DATA


@pytest.fixture(scope="session")
def small_library() -> ProceduralLibrary:
    """Nine random materials on a small grid, held in memory."""
    return ProceduralLibrary("small", random_tables(9, Grid.merl(6, 5, 8)), grid=Grid.merl(6, 5, 8))


@pytest.fixture
def run(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Callable[..., tuple[int, str, str]]:
    """Run a command in an empty folder; gives (exit code, stdout, stderr)."""
    from halfway.cli import console
    from halfway.cli import main as halfway

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(console, "cache_folder", lambda: tmp_path / "cache")

    def run(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["halfway", *words])
        code = 0
        try:
            halfway()
        except SystemExit as stop:
            code = stop.code or 0
        return code, *capsys.readouterr()

    return run


@pytest.fixture
def lib(run: Callable[..., tuple[int, str, str]], tmp_path: Path) -> str:
    """A library in that folder, and the files it was built of in ``measured``."""
    from halfway.formats import write_merl

    source = tmp_path / "measured"
    for name, table in random_tables(7, Grid.merl(4, 3, 5)).items():
        write_merl(source / f"{name}.binary", table)
    (source / "README").write_text("Measured on a Sunday.")
    code, _, talk = run("library", "build", "measured", "-o", "tiny.brdflib", "--licence", "CC0")
    assert code == 0, talk
    return "tiny.brdflib"


@pytest.fixture
def mitsuba_spectral():
    from halfway.render.variant import load_mitsuba

    mi = load_mitsuba()
    with mi.variant_context("scalar_spectral"):
        yield mi
