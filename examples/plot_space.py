"""
Materials as points
===================

The first two scores of the red channel, and their Delaunay triangulation: the paper's Figure 2.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import Pca, open_library
from halfway.space import Triangulation

library = open_library("builtin:merl-abc")
points = Pca.fit(library).scores(2)[0]

# %%
# A few mirror-like materials stand far away: the axes are linear around the origin and logarithmic beyond.

figure, ax = plt.subplots(figsize=(9.5, 6), layout="constrained")
ax.set_xscale("asinh", linear_width=np.median(np.abs(points[:, 0])))
ax.set_yscale("asinh", linear_width=np.median(np.abs(points[:, 1])))
ax.triplot(*points.T, Triangulation.of(points).simplices, color="#c8442f", lw=0.5, alpha=0.5)
ax.plot(*points.T, "o", color="#c8442f", ms=4)
named = ("blue-fabric", "yellow-phenolic", "blue-acrylic", "green-plastic", "chrome", "steel")
for name in named:
    at = points[library.index(name)]
    ax.annotate(name, at, xytext=(6, 6), textcoords="offset points", fontsize=8)
ax.margins(x=0.12)
ax.set(xlabel="score 1 (1/sr)", ylabel="score 2 (1/sr)")
