"""Triangle meshes of curved surfaces by circle packing, checked against the true surface.

    import surfmesh as sm

    surface = sm.ParametricSurface("u", "v", "u**2 - v**2", u=(-1, 1), v=(-1, 1))
    mesh = sm.mesh(surface, sm.Sizing(chord=1e-3))
    print(sm.check(mesh))
    mesh.save("saddle.vtu")

Names are imported when they are first used: ``import surfmesh`` alone loads nothing heavy.
"""

import logging
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from surfmesh import errors, io, view
    from surfmesh.api import estimate, explain, load, mesh, show
    from surfmesh.cad.from_cadquery import from_cadquery
    from surfmesh.cad.model import CadModel
    from surfmesh.geometry.numeric import NumericSurface
    from surfmesh.geometry.parametric import ParametricSurface
    from surfmesh.geometry.planar_domain import PlanarDomain
    from surfmesh.geometry.surface_file import gallery
    from surfmesh.meshing.circle_packing import CirclePacking, pack
    from surfmesh.quality import Report, check
    from surfmesh.sizing.distance_size import DistanceSize
    from surfmesh.sizing.radius_laws import TensorField, UniformRadius
    from surfmesh.sizing.sizing import Sizing
    from surfmesh.sizing.sources import InBall, InBox, Near, SizeCloud
    from surfmesh.surface_mesh import SurfaceMesh

    __version__: str

logging.getLogger("surfmesh").addHandler(logging.NullHandler())  # silent unless asked for

# No submodule may be called like a public name (mesh, check, load): importing it would put
# the module where the function should be.
_HOMES = {
    "CadModel": "surfmesh.cad.model",
    "CirclePacking": "surfmesh.meshing.circle_packing",
    "DistanceSize": "surfmesh.sizing.distance_size",
    "InBall": "surfmesh.sizing.sources",
    "InBox": "surfmesh.sizing.sources",
    "Near": "surfmesh.sizing.sources",
    "NumericSurface": "surfmesh.geometry.numeric",
    "ParametricSurface": "surfmesh.geometry.parametric",
    "PlanarDomain": "surfmesh.geometry.planar_domain",
    "Report": "surfmesh.quality",
    "SizeCloud": "surfmesh.sizing.sources",
    "Sizing": "surfmesh.sizing.sizing",
    "SurfaceMesh": "surfmesh.surface_mesh",
    "TensorField": "surfmesh.sizing.radius_laws",
    "UniformRadius": "surfmesh.sizing.radius_laws",
    "check": "surfmesh.quality",
    "estimate": "surfmesh.api",
    "explain": "surfmesh.api",
    "from_cadquery": "surfmesh.cad.from_cadquery",
    "gallery": "surfmesh.geometry.surface_file",
    "load": "surfmesh.api",
    "mesh": "surfmesh.api",
    "pack": "surfmesh.meshing.circle_packing",
    "show": "surfmesh.api",
}
_MODULES = ("errors", "io", "view")

__all__ = [
    "CadModel",
    "CirclePacking",
    "DistanceSize",
    "InBall",
    "InBox",
    "Near",
    "NumericSurface",
    "ParametricSurface",
    "PlanarDomain",
    "Report",
    "SizeCloud",
    "Sizing",
    "SurfaceMesh",
    "TensorField",
    "UniformRadius",
    "__version__",
    "check",
    "errors",
    "estimate",
    "explain",
    "from_cadquery",
    "gallery",
    "io",
    "load",
    "mesh",
    "pack",
    "show",
    "view",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        value = getattr(import_module(_HOMES[name]), name)
    elif name in _MODULES:
        value = import_module(f"surfmesh.{name}")
    elif name == "__version__":
        from importlib.metadata import version

        value = version("surfmesh")
    else:
        raise AttributeError(f"module 'surfmesh' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
