"""Puts the explorer's page and its notebook widget into the wheel: runs npm and Vite, with Node from PyPI where the machine has none."""

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class PageHook(BuildHookInterface):
    """Builds the page unless it came ready-made."""

    def dependencies(self) -> list[str]:
        """What the build needs besides hatchling."""
        building = _building(Path(self.root))
        return [] if self._is_ready() or building.has_npm() else [building.NODE_WHEEL]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build; an editable install builds when `halfway view` first runs."""
        del build_data
        if version != "editable" and not self._is_ready():
            _building(Path(self.root)).build(Path(self.root))

    def _is_ready(self) -> bool:
        # Only a source distribution (it has PKG-INFO) comes with a page; in a checkout it may be an old one.
        root = Path(self.root)
        return (root / "PKG-INFO").is_file() and _building(root).is_built(root)


def _building(root: Path) -> ModuleType:
    """`halfway.server.building`, from its file: the package is not installed yet."""
    path = root / "src" / "halfway" / "server" / "building.py"
    spec = importlib.util.spec_from_file_location("halfway_page_building", path)
    if spec is None or spec.loader is None:
        raise RuntimeError(f"{path} is missing")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
