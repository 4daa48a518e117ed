"""What a CAD model says of its parts, in the plain form that a mesh carries."""

from weakref import WeakKeyDictionary

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.result.mesh_groups import MeshGroups

_KNOWN: WeakKeyDictionary[CadModel, MeshGroups] = WeakKeyDictionary()  # asked for every round


def groups_of(model: CadModel) -> MeshGroups:
    """Names, colours, kinds of surface and the unit of ``model``; by its own numbers."""
    if model not in _KNOWN:
        _KNOWN[model] = _groups_of(model)
    return _KNOWN[model]


def _groups_of(model: CadModel) -> MeshGroups:
    return MeshGroups(
        face_names=tuple(face.name for face in model.faces),
        face_colours=tuple(face.colour for face in model.faces),
        face_kinds=tuple(face.kind for face in model.faces),
        solid_names=tuple(solid.name for solid in model.solids),
        solid_colours=tuple(solid.colour for solid in model.solids),
        edge_names=tuple(edge.name for edge in model.edges),
        unit=model.unit,
    )
