"""Shapes and dtypes of the arrays that pass between modules.

The names in quotes are dimensions; ``...`` stands for any leading batch axes. The tests check them at run time.
"""

from typing import TypeAlias

import numpy as np
from jaxtyping import Bool, Float, Float32, Float64, Int

Angle: TypeAlias = Float[np.ndarray | np.floating, "..."]
"""Radians."""
Directions: TypeAlias = Float[np.ndarray, "... 3"]
"""Unit vectors in the local frame: normal +z, tangent +x."""
Values: TypeAlias = Float[np.ndarray, "... 3"]
"""BRDF values in 1/sr, one per channel (RGB); NaN where unmeasured."""
Table: TypeAlias = Float32[np.ndarray, "3 ..."]
"""Samples of one material on a grid: channel, then the grid's axes."""
Samples: TypeAlias = Float64[np.ndarray, "3 ..."]
"""A table as a MERL file holds it: divided by the channel's scale, negative where unmeasured."""
Part: TypeAlias = slice | tuple[slice, ...]
"""Of a grid: a range of its first axis, or of each of its leading axes."""
Mask: TypeAlias = Bool[np.ndarray, "..."]
Rows: TypeAlias = Float32[np.ndarray, "3 n_materials n_cells"]
"""Samples of several materials on a range of cells."""
Weights: TypeAlias = Float64[np.ndarray, "3 n_materials"]
"""A weight per channel and material."""
Points: TypeAlias = Float64[np.ndarray, "n_points n_dimensions"]
Indices: TypeAlias = Int[np.ndarray | np.integer, "..."]
