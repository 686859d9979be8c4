"""What the paper reports, as numbers and names.

Reference: M. da Silva Nunes, G. F. Miranda Jr., B. Trinchão Andrade, "Using Dimensionality Reduction to Create New
Materials from Tabular BRDFs": Table I, and section IV for the rest.
"""

from dataclasses import dataclass

import numpy as np

TABLE_1 = {3: 0.211647, 5: 0.152568, 15: 0.063301, 30: 0.027881, 36: 0.019620, 45: 0.010056}
"""Mean relative error of the reconstruction, by number of components."""
SMALL_EIGENVALUE = 1e-3
N_COMPONENTS = 36
"""With so many components the eigenvalues are below `SMALL_EIGENVALUE` in all three channels."""
SECONDS_PER_MATERIAL = 2 * 60 + 67
SECONDS_PER_PICTURE = 19 * 60
N_STEPS = 51
"""Materials on a run, both ends included."""


@dataclass(frozen=True)
class Run:
    """One navigation: where it goes, how it is shown, and the t of the pictures."""

    figure: int
    stops: tuple[str, str]
    scene: str
    ts: tuple[float, ...]


FABRICS = Run(
    5,
    ("light-brown-fabric", "blue-fabric"),
    "teapot",
    (0, 0.06, 0.10, 0.20, 0.28, 0.42, 0.50, 0.56, 0.62, 0.70, 0.76, 0.78, 0.80, 0.94, 1),
)
SPECULARS = Run(
    6, ("alum-bronze", "color-changing-paint2"), "teapot", (0, 0.06, 0.20, 0.40, 0.60, 0.94, 1)
)
FAR_APART = Run(7, ("cherry-235", "tungsten-carbide"), "spheres", (0, 0.2, 0.4, 0.6, 0.8, 1))
RUNS = (FABRICS, SPECULARS, FAR_APART)
FINE_TS = np.arange(10_001) / 10_000
"""The finer list of t of Figure 7, with 0 before it."""
