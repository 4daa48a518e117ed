"""The matplotlib map behind a colouring."""

from matplotlib import colormaps
from matplotlib.colors import Colormap, ListedColormap

from surfmesh.view.colouring import Colouring


def map_of(colours: Colouring) -> Colormap:
    """A continuous map, or the hues that occur."""
    found = colormaps[colours.colours]
    return ListedColormap(found.colors[: colours.hues]) if colours.hues else found
