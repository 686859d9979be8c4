"""What several test modules share.

Shapes and dtypes in the package's annotations are checked while the tests run.
"""

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
def mitsuba_spectral():
    from halfway.render.variant import load_mitsuba

    mi = load_mitsuba()
    with mi.variant_context("scalar_spectral"):
        yield mi
