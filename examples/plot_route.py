"""
A route, in the paper's space and in ours
=========================================

From brown cherry wood to dark tungsten carbide. The paper's space (above) passes foreign colours; the anchored space goes straight.
"""

import matplotlib.pyplot as plt

import halfway
from halfway.look import Looks
from halfway.render import pictures

library = halfway.open_library("builtin:merl-abc")
looks = Looks.fit(library)

# %%
# One picture per measured material is enough: with direct light the picture of a mix is the mix of the pictures.

frames = []
for name in ("paper", "anchored"):
    route = halfway.route(library, "cherry-235", "tungsten-carbide", space=name)
    frames += [looks.picture(recipe) for recipe in route.recipes(route.steps(9))]

figure, ax = plt.subplots(figsize=(9, 2.2), layout="constrained")
ax.imshow(pictures.sheet(frames, columns=9))
ax.axis("off")
