"""``find`` and ``reach``: a recipe by what it shall be, and how far an attribute goes, in one call."""

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from ..errors import ControlError, OutOfReachError
from ..library import Library
from ..recipes import Blend, Recipe
from ..tasks import HERE, Work
from .control import Control
from .ranges import Range
from .reference import Like
from .wishes import Wishes


def find(
    library: Library | str,
    like: Like = None,
    *,
    set: Mapping[str, Any] | None = None,
    at_most: Mapping[str, Any] | None = None,
    at_least: Mapping[str, Any] | None = None,
    blend: Blend | str = Blend.LINEAR,
    few: bool = False,
    clamp: bool = False,
    release: Collection[str] = (),
    lights: np.ndarray | None = None,
    work: Work = HERE,
) -> Recipe:
    """The recipe that has what is asked for, and of those the one nearest to a reference.

    Where a body colour is asked for, and nothing of the highlight, gloss, haze and width of that are held. Where no mix has
    them all, it is the reference itself with its body scaled, which `Recipe.body_scale` says; where that does not do, the mix that
    gives up least.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    like : str, Recipe, Brdf or array
        What it shall be like: a material of the library, or anything that `attributes` takes; a colour such as ``#7a2a3a``; a
        picture of a sphere (`halfway.control.pictures`), as a file, or in linear light as an array of shape (n, n, 3). Without it, the material that has most of what is asked for.
    set, at_most, at_least : mapping
        Attributes by name, and their values: numbers, or a colour such as ``#7a2a3a`` for ``body``. So are the perceived
        qualities of `halfway.people.QUALITIES`: about 0 for not at all, 1 for very.
    blend : Blend or str
        How the recipe is mixed. Linear: what is asked of instruments is met to rounding. Others, and where a perceived
        quality is asked for: by some steps of Newton's method from there, to `Attribute.close`.
    few : bool
        Of no more materials than there are numbers asked for, and one.
    clamp : bool
        Where no mix has all that is asked for, the one that misses it least.
    release : collection of str
        What need not be held: of ``gloss20``, ``gloss60``, ``gloss85``, ``haze``, ``highlight_width``.
    lights : array, optional
        In which a picture was taken, and pictures are compared: directions to parallel lights, shape (n, 3), x to the right, y up, z
        to the viewer; or what surrounds the sphere, shape (height, width, 3), as `halfway.render.open_environment` gives it.
    work : Work
        Who sees how far it is, and where what is read of the library is kept.

    Raises
    ------
    OutOfReachError
        When no mix has what is asked for; the message says how far it goes.
    ControlError
        When there is no such attribute, or it cannot be asked for like this.
    """
    wishes = Wishes.of(set, at_most, at_least)
    if like is None and not list(wishes.each()):
        raise ControlError(
            "there is nothing to find: expected an attribute, or what it shall be like."
        )
    control = Control.of(library, lights=lights, work=work)
    return control.find(
        wishes, like=like, blend=Blend(blend), few=few, clamp=clamp, release=release
    )


def reach(
    library: Library | str,
    name: str,
    *,
    set: Mapping[str, Any] | None = None,
    at_most: Mapping[str, Any] | None = None,
    at_least: Mapping[str, Any] | None = None,
    work: Work = HERE,
) -> Range:
    """From the least to the most of an attribute, among the linear mixes of a library that have what is asked for.

    Of a perceived quality, or beside one, the ends are what a walk among mixes came to: some mix has them, and others may
    go farther. Parameters are those of `find`.

    Raises
    ------
    OutOfReachError
        When no mix has what is asked for.
    ControlError
        When there is no such attribute, or it cannot be asked for like this.
    """
    wishes = Wishes.of(set, at_most, at_least)
    control = Control.of(library, work=work)
    ends = control.reach(name, wishes)
    if ends is None:
        raise OutOfReachError(control.out_of_reach(wishes))
    return ends
