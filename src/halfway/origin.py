"""Where materials come from, for people: what they are, who made them, what one may do with them."""

from collections.abc import Iterable
from dataclasses import astuple, dataclass


@dataclass(frozen=True)
class Origin:
    """What is known of where materials come from; empty where nobody says."""

    description: str = ""
    """One line; says "stand-in" where the materials are fits and not measurements."""
    source: str = ""
    licence: str = ""

    @classmethod
    def of_all(cls, origins: Iterable["Origin"]) -> "Origin":
        """That of materials from several: every text that one of them has, once."""
        texts = zip(*map(astuple, origins), strict=True)
        return cls(*("; ".join(dict.fromkeys(filter(None, each))) for each in texts))
