"""The explorer in a notebook.

    from halfway.notebook import Explorer

    explorer = Explorer(stops=["cherry-235", "gold-paint"])
    explorer

It takes the extra ``notebook`` (the package ``anywidget``). Tables, recipes and routes show themselves as lit
spheres without it.
"""

from importlib.util import find_spec

from ..errors import MissingExtraError

if find_spec("anywidget") is None:
    raise MissingExtraError("halfway.notebook", "anywidget", "notebook")

from .explorer import Explorer

__all__ = ["Explorer"]
