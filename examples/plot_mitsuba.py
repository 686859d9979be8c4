"""
A new material in Mitsuba
=========================

Three parts gold paint and seven of teflon, mixed into a full table and rendered as it is.
"""

import matplotlib.pyplot as plt

from halfway import mix, open_library
from halfway.render import Renderer, pictures

library = open_library("builtin:merl-abc")

# %%
# The first picture compiles the scene; the next ones only take the table.

renderer = Renderer("teapot", size=(320, 260), spp=32)
shown = {
    "gold-paint": library.brdf("gold-paint"),
    "the mix": mix(library, "gold-paint=0.3, teflon=0.7"),
    "teflon": library.brdf("teflon"),
}
strip = pictures.strip([renderer.picture(table) for table in shown.values()], labels=list(shown))

figure, ax = plt.subplots(figsize=(9, 2.8), layout="constrained")
ax.imshow(strip)
ax.axis("off")
