"""Routes along an attribute: everything else as it was, as far as it goes.

The recipes at evenly spaced values, each found by itself (`halfway.find`), are the knots of a way. Between two of them a linear mix
has the values between, exactly in what is linear in the table.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..control import Control, Wishes
from ..errors import OutOfReachError, SpaceError
from ..library import Library, LibraryRef
from ..recipes import Blend
from ..tasks import HERE, Work
from .routes import Route
from .way import Way


def along(
    library: Library | str,
    like: str,
    name: str,
    start: float,
    stop: float,
    *,
    n: int = 9,
    set: Mapping[str, Any] | None = None,
    blend: Blend | str = Blend.LINEAR,
    work: Work = HERE,
) -> Route:
    """The route of ``n`` recipes like a material whose attribute ``name`` goes evenly from ``start`` to ``stop``.

    ``set`` are attributes that stay as they are given.

    Raises
    ------
    OutOfReachError
        When no mix has a value on the way.
    ControlError
        When there is no such attribute, or it cannot be asked for like this.
    SpaceError
        With fewer than two recipes.
    """
    if n < 2:
        raise SpaceError(f"a route of {n} recipes goes nowhere: expected -n 2 or more.")
    control = Control.of(library, work=work)
    weights = np.zeros((3, n, len(control.library)))
    values = np.linspace(start, stop, n)
    # The ends first, for these are what a person asked for.
    for i in (0, n - 1, *range(1, n - 1)):
        wishes = Wishes.of({**(set or {}), name: values[i]})
        recipe = control.find(wishes, like=like, blend=Blend(blend))
        if recipe.is_recoloured:  # on a way there are weights alone
            raise OutOfReachError(control.out_of_reach(wishes))
        weights[:, i] = recipe.dense(control.library.names)
    t = np.linspace(0, 1, n)
    stops = (f"{name}={start:g}", f"{name}={stop:g}")
    return Route(
        LibraryRef.of(control.library),
        f"along {name}",
        "uniform",
        stops,
        control.library.names,
        Way(t, weights),
        t[[0, -1]],
        Blend(blend),
    )
