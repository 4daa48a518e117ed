"""How parts become one model: healed, scaled, placed, joined, and walked through."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID

from surfmesh.cad.conversion.contents_of_file import unread_bodies, without_faces
from surfmesh.cad.conversion.placing import placed, scaled_together
from surfmesh.cad.conversion.topology import Walk
from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.model.cad_model import CadFace, CadModel, CadSolid
from surfmesh.cad.model.extent import diagonal
from surfmesh.cad.model.loop_faults import fault_of_pieces
from surfmesh.cad.model.near_poles import pcurves_at_near_poles
from surfmesh.cad.model.singular_cuts import cut_at_singular_lines
from surfmesh.cad.model.tolerances import (
    Measured,
    curves_on_their_faces,
    listed,
    pcurves_that_follow,
    tolerances_that_hold,
)
from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import each
from surfmesh.cad.units import MILLIMETRES, checked_unit
from surfmesh.errors import CadError


def model_of(
    root: Part, *, heal: bool, units: str | None = None, file_unit: str = "mm", source: str = "",
    joining: Joining | None = None, path: Path | None = None,
) -> CadModel:  # fmt: skip
    """Heal, scale and place every part, join them if asked to, and walk through all of them.

    Shapes are in millimetres; units: what the model is wanted in (None: millimetres). path: of
    the file they were read from. Raises CadError when a part cannot be used, or the parts cannot
    be joined.
    """
    unit = checked_unit(units)
    scale = 1.0 / MILLIMETRES[unit]
    if joining is None or not joining:
        ready = placed(root, heal, scale)
    else:
        joined = joining.applied(placed(root, heal, 1.0), MILLIMETRES[unit])
        ready = scaled_together(joined, scale)
    return _model_of_placed(
        ready, heal=heal, unit=unit, file_unit=file_unit, source=source, path=path
    )


def _model_of_placed(
    root: Part, *, heal: bool = True, unit: str = "mm", file_unit: str = "mm", source: str = "",
    path: Path | None = None,
) -> CadModel:  # fmt: skip
    """The plain data of a tree of parts that are healed and in place.

    heal: also replace p-curves that stray from their edges. path: of the file it was read from.

    Faces that cannot be used are left out, and listed. Raises CadError when there is no other.
    """
    walk = Walk(heal)
    tree = walk.part(root, None)
    if not walk.faces:
        called = source or root.name or "the model"
        raise CadError(without_faces(called, root, path, walk.left_out))
    if path is not None:
        walk.left_out += unread_bodies(path)
    healing = _in_words(walk, root)
    measured = Measured(walk.edges, walk.vertices, walk.faces)
    if heal:
        healing += pcurves_that_follow(measured, unit)
        healing += pcurves_at_near_poles(walk.edges, walk.vertices, walk.faces)
        healing += curves_on_their_faces(measured, unit)
    healing += tolerances_that_hold(measured, unit)
    _fault_split_faces(walk, root)
    model = CadModel(
        vertices=tuple(walk.vertices),
        edges=tuple(walk.edges),
        faces=tuple(walk.faces),
        solids=tuple(walk.solids),
        free_shells=tuple(walk.free_shells),
        free_faces=tuple(walk.free_faces),
        name=root.name,
        unit=unit,
        file_unit=file_unit,
        diagonal=diagonal(walk.vertices, walk.edges, walk.faces),
        tree=tree,
        healing=tuple(healing + walk.remarks() + _touching(walk.faces, walk.solids)),
        source=source,
        tags=walk.tags(root),
        left_out=tuple(walk.left_out),
    )
    return cut_at_singular_lines(model)


def _touching(faces: list[CadFace], solids: list[CadSolid]) -> list[str]:
    """Edges along which a solid touches itself: no mesh of it is a manifold there."""
    sentences = []
    for number, solid in enumerate(solids):
        uses: Counter[int] = Counter()
        for face, _ in (use for shell in solid.shells for use in shell):
            uses.update(coedge.edge for coedge in faces[face].coedges)
        many = [str(edge) for edge, count in sorted(uses.items()) if count > 2]
        if many:
            sentences.append(
                f"solid {number} touches itself along edge{'s' if len(many) > 1 else ''} "
                f"{listed(many)}: more than two of its faces meet there, and so do triangles"
            )
    return sentences


def _fault_split_faces(walk: Walk, root: Part) -> None:
    """Pieces that healing has made of one face, and that cross each other, are no faces."""
    for part in root:
        for shape, _ in part.remarks:
            if shape is None or shape.IsNull():
                continue
            known = {walk.face_number(face) for face in each(shape, TopAbs_FACE)}
            numbers = sorted(number for number in known if number is not None)
            pieces = [walk.faces[number] for number in numbers]
            if len(pieces) < 2:
                continue
            fault = fault_of_pieces(pieces, walk.edges, len(walk.vertices))
            for number in numbers if fault else ():
                said = f"{fault}, before it was split by healing"
                walk.faces[number] = replace(walk.faces[number], fault=said)


def _in_words(walk: Walk, root: Part) -> list[str]:
    """What healing did, by face or edge; what was done to many of them in one sentence."""
    places: dict[tuple[str, str], list[str]] = {}
    for part in root:
        for shape, text in part.remarks:
            found = [] if shape is None or shape.IsNull() else [shape]
            if any(s.ShapeType() not in (TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE) for s in found):
                found = list(each(shape, TopAbs_FACE))  # a face that was split
            names = [name for name in map(walk.number_of, found) if name]
            kind = names[0].split()[0] if names else ""
            numbers = places.setdefault((kind, text), [])
            numbers += [name.split()[1] for name in names] or [part.name]
    sentences = []
    for (kind, text), numbers in places.items():
        numbers = list(dict.fromkeys(numbers))
        label = f"{kind}{'s' * (len(numbers) > 1)} " if kind else "part "
        sentences.append(f"{label}{listed(numbers)}: {text}")
    for shape, text in (note for part in root for note in part.notes):
        place = "" if shape is None else walk.number_of(shape)
        sentences.append(f"{place}: {text}" if place else text)
    return sentences
