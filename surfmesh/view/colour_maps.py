"""The matplotlib map behind a colouring."""

from typing import TYPE_CHECKING

import numpy as np

from surfmesh.errors import needs
from surfmesh.view.colouring import Colouring

if TYPE_CHECKING:
    from matplotlib.colors import Colormap


def map_of(colours: Colouring) -> "Colormap":
    """A continuous map, or the hues that occur."""
    with needs("view", "a coloured mesh"):
        from matplotlib import colormaps
        from matplotlib.colors import ListedColormap

    found = colormaps[colours.colours]
    return ListedColormap(found(np.arange(colours.hues))) if colours.hues else found


def table_of(colours: Colouring) -> str:
    """The map as text: six hexadecimal digits a colour, 256 of them or the hues that occur."""
    steps = np.arange(colours.hues) if colours.hues else np.linspace(0.0, 1.0, 256)
    return map_of(colours)(steps, bytes=True)[:, :3].tobytes().hex()
