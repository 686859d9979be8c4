"""The two plain spaces.

paper     each channel by itself: the first k scores and their Delaunay triangulation (the paper's method)
linear    no space at all: the two end materials in plain proportion, for comparison
"""

from dataclasses import dataclass

from ..components import Pca
from ..errors import SpaceError
from ..library import Library, LibraryRef
from ..recipes import Blend
from .chart import Channel, Chart
from .coordinates import Coordinates, Scores
from .space import Space
from .way import Way

CHANNELS: tuple[Channel, Channel, Channel] = ("r", "g", "b")
SIMPLICES_PER_POINT = (1, 2, 6.8, 32, 190, 1300)
"""Of the Delaunay triangulation of many points that are spread evenly, in 1 to 6 dimensions."""
MOST_SIMPLICES = 1e6
"""More are not made: a million takes a gigabyte in six dimensions."""


@dataclass(frozen=True, eq=False, repr=False)
class PaperSpace(Space):
    """The paper's space: three triangulations, one per channel, of the first k scores.

    Reference: Nunes, Miranda, Andrade, sections III B to E.
    """

    name = "paper"
    summary = "one triangulation per channel, of its first three scores"

    @classmethod
    def fit(
        cls,
        library: Library,
        pca: Pca,
        *,
        n_components: int | None = None,
        blend: Blend = Blend.LINEAR,
    ) -> "PaperSpace":
        """The space of the first ``n_components`` scores (1 to 6; the paper uses 3)."""
        k = 3 if n_components is None else n_components
        if not 1 <= k <= 6:
            raise SpaceError(
                f"a space of {k} components cannot be made: expected 1 to 6 "
                "(a triangulation of 100 points has 530 simplices in 3 dimensions, 20,000 in 6)."
            )
        walked = len(library) * SIMPLICES_PER_POINT[k - 1] > MOST_SIMPLICES
        charts = tuple(
            Chart.of(Coordinates((Scores.of_channel(pca, k, i),)), channel, walked=walked)
            for i, channel in enumerate(CHANNELS)
        )
        return cls(LibraryRef.of(library), library.names, charts, blend=blend)

    def leg(self, start: int, stop: int) -> Way:
        return Way.of_channels([chart.way(start, stop) for chart in self.charts])


@dataclass(frozen=True, eq=False, repr=False)
class LinearSpace(Space):
    """Plain linear interpolation of the two end materials."""

    name = "linear"
    summary = "the two end materials in plain proportion"

    @classmethod
    def of(cls, library: Library, *, blend: Blend = Blend.LINEAR) -> "LinearSpace":
        """The linear space of a library."""
        return cls(LibraryRef.of(library), library.names, (), blend=blend)

    def leg(self, start: int, stop: int) -> Way:
        return Way.of_channels([Way.between(start, stop, len(self.names))])
