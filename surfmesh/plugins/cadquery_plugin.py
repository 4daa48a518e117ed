"""``Workplane.surfmesh(...)``: importing this module adds it to CadQuery.

    import cadquery as cq
    import surfmesh.plugins.cadquery_plugin

    mesh = cq.Workplane().box(2, 1, 1).surfmesh(chord=0.01)

``Shape``, ``Sketch`` and ``Assembly`` get it too.
"""

from typing import Any

import cadquery

from surfmesh import api
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import Sizing


def surfmesh(self: Any, sizing: Sizing | float | None = None, **options: Any) -> SurfaceMesh:
    """The mesh of what is on the stack: ``surfmesh.mesh`` with its options."""
    return api.mesh(self, sizing, **options)


for kind in (cadquery.Workplane, cadquery.Shape, cadquery.Sketch, cadquery.Assembly):
    setattr(kind, surfmesh.__name__, surfmesh)
