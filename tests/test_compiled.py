"""Compiled loops and kept results where nothing can be written: other users' installations, containers without a home."""

import numba
import pytest

from halfway import cache
from halfway.compiled import compiled


def test_a_loop_is_compiled_where_nothing_can_be_kept():
    """A function whose file is nowhere stands for an installation that is read-only, of a user without a home."""
    names = {}
    exec(compile("def double(x):\n    return 2 * x\n", "/nowhere/loops.py", "exec"), names)
    with pytest.raises(RuntimeError, match="no locator"):
        numba.njit(cache=True)(names["double"])
    assert compiled(names["double"])(21) == 42


def test_a_user_without_a_home_keeps_nothing(monkeypatch):
    """Python leaves ``~`` as it is for a user whom the system does not know: a folder of that name is not made."""
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr("os.path.expanduser", lambda path: path)
    assert cache.user_folder() is None
    monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere")
    assert str(cache.user_folder()) == "/somewhere/halfway"
