"""From the surface to tetrahedra: other programs fill the solids, the surface stays as it is.

tetrahedralize: the one call, ``surfmesh.SurfaceMesh.tetrahedralize``.
volume_mesh: what it gives, a grid of tetrahedra with solids by number and faces by name.
solid_regions: which tetrahedra lie in which solid, and whether the surface is still there.
curved_tetrahedra: whether those of second order are valid.
untangling: those that are not are mended from within.
by_tetgen, by_gmsh, by_netgen, by_ftetwild: the programs that fill, each an optional dependency.
gmsh_model: the mesh as a model of Gmsh, ready for its ``generate(3)``.
volume_files: the grid as .vtu, .msh, .inp, .su2 and .mesh.
"""

from surfmesh.volume.tetrahedralize import ENGINES, tetrahedralize
from surfmesh.volume.volume_mesh import VolumeMesh

__all__ = ["ENGINES", "VolumeMesh", "tetrahedralize"]
