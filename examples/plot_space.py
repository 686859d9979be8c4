"""
Materials as points
===================

The first two scores of the red channel, and their Delaunay triangulation: the paper's Figure 2, around the origin.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import Pca, open_library
from halfway.space import Triangulation

library = open_library("builtin:merl-abc")
points = Pca.fit(library).scores(2)[0]

# %%
# A few mirror-like materials stand far away, so the picture shows where the middle 80 % are.

left_bottom, right_top = np.percentile(points, [10, 90], axis=0)
inside = ((points > left_bottom) & (points < right_top)).all(axis=1)

figure, ax = plt.subplots(figsize=(9, 6), layout="constrained")
ax.triplot(*points.T, Triangulation.of(points).simplices, color="#c8442f", lw=0.5, alpha=0.5)
ax.plot(*points.T, "o", color="#c8442f", ms=4)
for i in np.flatnonzero(inside)[::3]:
    ax.annotate(library.names[i], points[i], xytext=(4, 4), textcoords="offset points", fontsize=8)
ax.set(
    xlim=(left_bottom[0], right_top[0]),
    ylim=(left_bottom[1], right_top[1]),
    xlabel="score 1 (1/sr)",
    ylabel="score 2 (1/sr)",
)
