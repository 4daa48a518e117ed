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
    from surfmesh.api import check, estimate, explain, intersect, mesh, show
    from surfmesh.cad.cadquery.from_cadquery import from_cadquery
    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.circle_packing import CirclePacking, pack
    from surfmesh.geometry.files.surface_file import gallery
    from surfmesh.geometry.formulas.parametric import ParametricSurface
    from surfmesh.geometry.functions.numeric import NumericSurface
    from surfmesh.geometry.planar.planar_domain import PlanarDomain
    from surfmesh.loading import load
    from surfmesh.partitioned_mesh import PartitionedMesh, mesh_into_pieces
    from surfmesh.quality import Report
    from surfmesh.result.surface_mesh import SurfaceMesh
    from surfmesh.sizing.options.distance_size import DistanceSize
    from surfmesh.sizing.options.radius_laws import TensorField, UniformRadius
    from surfmesh.sizing.options.size_cloud import SizeCloud
    from surfmesh.sizing.options.sizing import Sizing
    from surfmesh.sizing.options.sources import InBall, InBox, Near

    __version__: str

logging.getLogger("surfmesh").addHandler(logging.NullHandler())  # silent unless asked for

# No submodule may be called like a public name (mesh, check, load): importing it would put
# the module where the function should be.
_HOMES = {
    "CadModel": "surfmesh.cad.model.cad_model",
    "CirclePacking": "surfmesh.circle_packing",
    "DistanceSize": "surfmesh.sizing.options.distance_size",
    "InBall": "surfmesh.sizing.options.sources",
    "InBox": "surfmesh.sizing.options.sources",
    "Near": "surfmesh.sizing.options.sources",
    "NumericSurface": "surfmesh.geometry.functions.numeric",
    "ParametricSurface": "surfmesh.geometry.formulas.parametric",
    "PartitionedMesh": "surfmesh.partitioned_mesh",
    "PlanarDomain": "surfmesh.geometry.planar.planar_domain",
    "Report": "surfmesh.quality",
    "SizeCloud": "surfmesh.sizing.options.size_cloud",
    "Sizing": "surfmesh.sizing.options.sizing",
    "SurfaceMesh": "surfmesh.result.surface_mesh",
    "TensorField": "surfmesh.sizing.options.radius_laws",
    "UniformRadius": "surfmesh.sizing.options.radius_laws",
    "check": "surfmesh.api",
    "estimate": "surfmesh.api",
    "explain": "surfmesh.api",
    "from_cadquery": "surfmesh.cad.cadquery.from_cadquery",
    "gallery": "surfmesh.geometry.files.surface_file",
    "intersect": "surfmesh.api",
    "load": "surfmesh.loading",
    "mesh": "surfmesh.api",
    "mesh_into_pieces": "surfmesh.partitioned_mesh",
    "pack": "surfmesh.circle_packing",
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
    "PartitionedMesh",
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
    "intersect",
    "io",
    "load",
    "mesh",
    "mesh_into_pieces",
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
    return sorted(__all__)
