"""What several test modules share."""

from pathlib import Path

import pytest

SHARED_DATA = Path(__file__).parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Published and measured data that are not part of the repository, in ``../shared/data`` beside the checkout."""
    if not SHARED_DATA.is_dir():
        pytest.skip("needs the data folder ../shared/data, which is not part of the repository")
    return SHARED_DATA
