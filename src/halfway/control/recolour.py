"""The same material in another colour.

Who asks for a body colour alone wants the highlight as it is. So gloss, haze and the highlight's width are held, as bounds of
the programme, to a share (`KEPT`) of what they would be if the body became lighter or darker by a matte layer:

    r = r(f) + (colour - body(f)) r(1 / pi)        the readings of f, and of a white matte surface

for the body sends light into a gloss meter, too. Where no mix has all that, the body of the material alone is scaled, per
channel, to the colour (`halfway.recipes.body`): f is linear in the scale, and so is what is read off the body.
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from jaxtyping import Float64

from ..brdf import TabularBrdf, gloss
from ..errors import ControlError
from ..halfdiff import Grid
from ..instruments import ATTRIBUTES, Attribute, read_table
from ..recipes import Recipe
from .wishes import Wishes

KEPT = 0.2
"""Share by which an attribute may change and still be what it was."""
HELD = ("gloss20", "gloss60", "gloss85", "haze", "highlight_width")
GRID = Grid.merl(90, 15, 18)
"""Of the matte surface, whose readings are the same on any."""

Reading = Float64[np.ndarray, "n_instruments 3"]


def leeway(of: Attribute, value: np.ndarray | float) -> np.ndarray:
    """By how much an attribute may change and still be what it was."""
    return np.asarray(of.close + KEPT * np.abs(value))


def changed(of: Attribute, was: np.ndarray | float, now: np.ndarray | float) -> bool:
    """Whether an attribute is no longer what it was."""
    return bool(np.any(np.abs(now - was) > leeway(of, was)))


def in_colour(own: Reading, wishes: Wishes) -> Reading:
    """The readings of a material whose body has the colour that is wished for, if one is."""
    if "body" not in wishes.exact:
        return own
    white = np.where(GRID.mask(), np.float32(1 / np.pi), np.float32(np.nan))
    matte = read_table(TabularBrdf(np.stack([white] * 3), GRID))
    return own + matte * (wishes.exact["body"] - ATTRIBUTES["body"].of(own))


def holding(wishes: Wishes, own: Reading | None, released: Collection[str]) -> Wishes | None:
    """The wishes, and that the highlight stays that of a material with these readings.

    None where that is none, no other body is asked for, or another highlight is.

    Raises
    ------
    ControlError
        When something is released that is never held.
    """
    if unknown := [name for name in released if name not in HELD]:
        raise ControlError(f"{unknown[0]} is not held: expected one of {', '.join(HELD)}.")
    if own is None or "body" not in wishes.exact or "reflections" not in wishes.held():
        return None
    expected = in_colour(own, wishes)
    at_most, at_least = dict(wishes.at_most), dict(wishes.at_least)
    for name in HELD:
        value = float(ATTRIBUTES[name].of(expected))
        if name not in released and not np.isnan(value):
            by = float(leeway(ATTRIBUTES[name], value))
            at_most[name], at_least[name] = max(value + by, 0.0), max(value - by, 0.0)
    return Wishes(wishes.exact, at_most, at_least)


def with_colour(
    recipe: Recipe, table: TabularBrdf, colour: Float64[np.ndarray, " 3"]
) -> Recipe | None:
    """A recipe whose ``table`` this is, with its body in a colour; None where no multiple of its body has it."""
    body = gloss.Gloss.of(table.values, table.grid).body.reshape(table.values.shape)
    whole, alone = (
        ATTRIBUTES["body"].of(read_table(each)) for each in (table, TabularBrdf(body, table.grid))
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1 + (colour - whole) / alone
    if not ((scale >= 0) & np.isfinite(scale)).all():
        return None
    r, g, b = scale.tolist()
    return replace(recipe, body_scale=(r, g, b))
