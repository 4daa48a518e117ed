"""Surfaces and models that meet, as one model whose faces end on their common curves.

surfaces, models -> models (``sheets``) -> cut by each other (``meeting``) -> what is kept
(``keeping``) -> a model, with a tag for each input and each side of another.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadModel, CadNode, CadTag
from surfmesh.cad.model.extent import diagonal
from surfmesh.errors import SurfaceError, shown
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.bounds import are_known
from surfmesh.intersection.complex import Complex, Patch, compacted, with_areas
from surfmesh.intersection.curve_fitting import NEAR
from surfmesh.intersection.keeping import Keeping
from surfmesh.intersection.meeting import joined
from surfmesh.intersection.seams import with_clear_seams
from surfmesh.intersection.sheets import as_model
from surfmesh.intersection.tracing import place

COINCIDENT = ("refuse", "merge")


def intersected(
    things: Sequence[Any], keep: Any = "all", name: str = "", coincident: str = "refuse"
) -> CadModel:
    """The model of surfaces and models that cut each other; see ``surfmesh.intersect``.

    name: of the model; that of all inputs together where it is empty.
    """
    if coincident not in COINCIDENT:
        raise SurfaceError(f"coincident={shown(coincident)}: one of {', '.join(COINCIDENT)}")
    if len(things) < 2:
        raise SurfaceError(f"two surfaces or more are needed to intersect, not {len(things)}")
    names = _names(things)
    clear = with_clear_seams(things)
    models = [as_model(thing, name) for thing, name in zip(clear, names)]
    _refuse_units(models)
    size = _size(models)
    keeping = Keeping(keep, names, models, size)
    whole, remarks = joined(
        [Complex.of(model, k, names[k]) for k, model in enumerate(models)],
        size,
        coincident == "merge",
    )
    kept = keeping.kept(whole)
    vertices, edges, faces = compacted(whole.vertices, whole.edges, [p.face for p, _ in kept])
    faces = with_areas(faces)
    solids = keeping.solids(faces, edges, vertices, [against for _, against in kept])
    patches = [patch for patch, _ in kept]
    called = name or " and ".join(names)
    held = {face for solid in solids for shell in solid.shells for face, _ in shell}
    free = tuple(k for k in range(len(faces)) if k not in held)
    return CadModel(
        vertices=tuple(vertices),
        edges=tuple(edges),
        faces=tuple(faces),
        solids=tuple(solids),
        free_shells=(),
        free_faces=free,
        name=called,
        unit=models[0].unit,
        file_unit=models[0].file_unit,
        diagonal=diagonal(vertices, edges, faces),
        tree=CadNode(
            called,
            tuple(range(len(solids))),
            (),
            tuple(
                CadNode(name, (), tuple(k for k, p in enumerate(patches) if p.is_of(number)))
                for number, name in enumerate(names)
            ),
        ),
        healing=(*_remarks(models, names), *remarks, *_loose_curves(models, edges, size)),
        source=called,
        tags=_tags(keeping, patches, names, models),
    )


def _names(things: Sequence[Any]) -> list[str]:
    """What each is called: by its own name, with a number where several have the same."""
    names: list[str] = []
    for number, thing in enumerate(things):
        own = str(getattr(thing, "name", "") or f"surface {number + 1}")
        name, count = own, 1
        while name in names:
            count += 1
            name = f"{own} {count}"
        names.append(name)
    return names


def _refuse_units(models: Sequence[CadModel]) -> None:
    units = {model.unit for model in models}
    if len(units) > 1:
        raise SurfaceError(
            f"the models have different units ({', '.join(sorted(units))}): load them in one"
        )


def _size(models: Sequence[CadModel]) -> float:
    """The diagonal of the box around all of them."""
    points = []
    line = np.linspace(0.0, 1.0, 17)
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    for face in (face for model in models for face in model.faces):
        box = np.array(face.surface.domain)
        points.append(face.surface.evaluate(box[:, 0] + grid * (box[:, 1] - box[:, 0]), 0)[0])
    every = np.concatenate(points)
    return norm(np.ptp(every, axis=0))


def _remarks(models: Sequence[CadModel], names: Sequence[str]) -> tuple[str, ...]:
    said = [sentence for model in models for sentence in model.healing]
    for model, name in zip(models, names):
        unknown = sorted({_kind(face.surface) for face in model.faces} - {""})
        if unknown:
            said.append(
                f"{name}: the bends of {', '.join(unknown)} surfaces are known from samples only; "
                "a branch of its curves that is smaller than these may have been missed"
            )
    return tuple(said)


def _loose_curves(
    models: Sequence[CadModel], edges: Sequence[CadEdge], size: float
) -> Iterator[str]:
    """Of the curves found, those that do not keep as near to both surfaces as is tried."""
    given = {edge.name for model in models for edge in model.edges}
    for edge in edges:
        is_found = "/" in edge.name and edge.name not in given
        if is_found and edge.tolerance > 2.0 * NEAR * size:  # twice what was measured
            middle = edge.evaluate(np.array([0.5]))[0][0]
            yield (
                f"{edge.name}: the curve through {place(middle)} is up to "
                f"{0.5 * edge.tolerance:.1g} off its surfaces, not {NEAR * size:.1g}: one of them "
                "bends too abruptly there to be followed closer"
            )


def _kind(surface: FaceSurface) -> str:
    return "" if are_known(surface) else surface.kind


def _tags(
    keeping: Keeping, patches: Sequence[Patch], names: Sequence[str], models: Sequence[CadModel]
) -> tuple[CadTag, ...]:
    """The faces of each input, and those on each side of another: "wing", "wing+body"."""
    faces: dict[str, list[int]] = {name: [] for name in names}
    for number, patch in enumerate(patches):
        for source in dict.fromkeys(origin.source for origin in patch.origins):
            faces[names[source]].append(number)
            for other, sign in keeping.sides(patch).items():
                if sign:
                    name = f"{names[source]}{'+' if sign > 0 else '-'}{names[other]}"
                    faces.setdefault(name, []).append(number)
    return tuple(
        CadTag(name, f"{len(found)} face{'s' * (len(found) != 1)}", tuple(found))
        for name, found in faces.items()
    )
