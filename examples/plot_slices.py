"""
Slices of tables
================

All values at phi_d = 90 degrees: theta_h runs to the right, theta_d upwards. The highlight is the left edge, grazing reflection the upper one.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import open_library
from halfway.render import pictures

library = open_library("builtin:merl-abc")
names = ("blue-fabric", "cherry-235", "gold-paint", "pearl-paint", "steel")

figure, axes = plt.subplots(1, len(names), figsize=(9, 2.4), layout="constrained", sharey=True)
for ax, name in zip(axes, names, strict=True):
    values = library.brdf(name).values[..., library.grid.shape[2] // 2]
    # Rows are theta_d from below; what was not measured is NaN, and black here.
    ax.imshow(
        pictures.to_8_bit(np.sqrt(np.nan_to_num(values)).transpose(2, 1, 0)),
        origin="lower",
        extent=(0, 90, 0, 90),
    )
    ax.set_title(name, fontsize=10)
    ax.set_xlabel("theta_h cell")
axes[0].set_ylabel("theta_d (degrees)")
