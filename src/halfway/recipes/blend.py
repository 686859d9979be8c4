"""How the weighted materials of a recipe become one."""

from enum import StrEnum

from ..errors import RecipeError


class Blend(StrEnum):
    """The ways to mix materials f_i with weights w_i, none negative, which sum to 1."""

    LINEAR = "linear"
    """``sum_i w_i f_i``, the paper's: keeps every linear functional of the BRDF, so pictures in direct light mix alike."""

    @classmethod
    def _missing_(cls, value: object) -> "Blend":
        raise RecipeError(
            f"there is no blend {value!r}: expected {', '.join(cls)}. "
            "A newer halfway may have written it: upgrade, or choose one of these."
        )
