"""Meshes to files and back. The extension says the format; see ``FORMATS``.

formats: which module writes and reads which extension, and the verbs ``save`` and ``read``.
atomic, leftovers: a file is written in full or not at all, and what is left when that is killed.
asked_date: the date that files carry when one is asked for.
stl, obj, off, ply, glb, threemf, vtk_xml, xdmf, msh, inp, bdf, med, su2, medit: one format each,
    ``write`` and ``read``.
dagmc: solids with materials for DAGMC (.h5m), through another library; written only.
pvtu: a mesh in several .vtu files and an index of them.
ply_reading, msh_reading, vtk_xml_reading, vtk_xml_arrays, lz4_block, xml_writing: parts of these.
to_trimesh, to_meshio: as meshes of other libraries, for what is not written here.
group_record, colours: what is known of faces, solids and edges, in formats that have no place
    for it, and colours as bytes.
text_columns, xml_reading: numbers as text, and XML that somebody else wrote.
expansion, glb_bounds, hdf5_bounds: how large a file may become, looked at before it is unpacked.
welding: corners of triangles to shared vertices.
found_mesh, numbers_of_groups: what is asked of a mesh from a file before anybody computes with it.
manifests: what files were made with, and their hashes, for another machine to compare.

Others use what is named below and ``atomic``, ``formats``, ``vtk_xml``, ``to_trimesh`` and
``to_meshio``; tetrahedra are written with parts of ``msh``, ``inp`` and ``xml_writing``.
"""

from typing import TYPE_CHECKING, Any

from surfmesh.io.formats import FORMATS, IN_PIECES, read, save

if TYPE_CHECKING:
    from surfmesh.io.manifests import Entry, Manifest

__all__ = ["FORMATS", "IN_PIECES", "Entry", "Manifest", "read", "save"]


def __getattr__(name: str) -> Any:
    """Manifests are imported when they are asked for: they need what judges a mesh."""
    if name in ("Entry", "Manifest"):
        from surfmesh.io import manifests

        return getattr(manifests, name)
    raise AttributeError(f"module 'surfmesh.io' has no attribute {name!r}")
