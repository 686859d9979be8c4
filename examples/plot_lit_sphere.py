"""
A material on a lit sphere
==========================

The smallest picture of a material: a sphere under a few lights, straight from its table. No renderer is needed.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import open_library
from halfway.look import PACING_SCENE, SphereOperator
from halfway.render import pictures

library = open_library("builtin:merl-abc")
names = ("cherry-235", "blue-fabric", "gold-paint", "chrome")

# %%
# The picture is a linear function of the table: one sparse matrix per scene and grid serves every material.

operator = SphereOperator.of(PACING_SCENE, library.grid)
on_sphere = PACING_SCENE.mask()

figure, axes = plt.subplots(1, len(names), figsize=(9, 2.6), layout="constrained")
for ax, name in zip(axes, names, strict=True):
    picture = np.full((*on_sphere.shape, 3), 255, np.uint8)
    picture[on_sphere] = pictures.to_8_bit(operator.picture(library.row(library.index(name))))
    ax.imshow(picture, interpolation="bicubic")
    ax.set_title(name)
    ax.axis("off")
