"""halfway in Blender: measured materials as node trees, and the way from one to another.

space      a `.brdfspace` file as a library; routes
lobes      a table as lobes that Cycles samples
nodes      node trees
making     a material of Blender's from a table
importing  File > Import
panel      the library: stops, a slider, materials, assets
halfway/   the part of the package that needs numpy alone, as it is
"""

from . import importing, panel, preferences

MODULES = (preferences, importing, panel)


def register() -> None:
    for module in MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(MODULES):
        module.unregister()
