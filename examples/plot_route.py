"""
A route, in the paper's space and in ours
=========================================

From brown cherry wood to dark tungsten carbide. The paper's space (above) passes foreign colours; the anchored space goes straight.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import Route, open_library
from halfway.look import Looks
from halfway.render import pictures
from halfway.space import make_space, perceptual

library = open_library("builtin:merl-abc")
images = Looks.fit(library)

# %%
# One picture per measured material is enough: with direct light the picture of a mix is the mix of the pictures.

frames = []
for name in ("paper", "anchored"):
    route = Route.through(make_space(name, library), ["cherry-235", "tungsten-carbide"])
    route = perceptual(route, images)
    weights = route.at(np.linspace(0, 1, 9))
    frames += [images.picture(weights[:, i]) for i in range(9)]

figure, ax = plt.subplots(figsize=(9, 2.2), layout="constrained")
ax.imshow(pictures.sheet(frames, columns=9))
ax.axis("off")
