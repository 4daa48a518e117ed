"""How a surface of Python becomes one of the compiled core."""

from __future__ import annotations

from surfmesh._core import surfaces
from surfmesh.geometry.surface import Surface


def as_core_surface(surface: Surface) -> surfaces.Surface:
    """The surface's own one of the core, its attribute ``core``, where it has it.

    Any other is called back for each block of points, with the interpreter held.
    """
    core = getattr(surface, "core", None)
    return core if isinstance(core, surfaces.Surface) else surfaces.CallbackSurface(surface)
