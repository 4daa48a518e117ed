"""The size requests of each face of a model, and of the sources those that reach it."""

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.small_matrices import norm
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.options.sources import reaching

GRID = 9
"""Points each way of the grid whose box, with MARGIN of its diagonal, holds a face."""

MARGIN = 0.02


def face_sizings(model: CadModel, samples: EdgeSamples, wanted: ModelSizing) -> list[Sizing]:
    """For each face; a plane that no source reaches needs no background but its edges."""
    found = [wanted.base] * len(model.faces)
    for own, faces in wanted.sets(len(model.faces)):
        for number in faces.tolist():
            found[number] = _reaching(model, samples, own, number) if own.sources else own
    return found


def _reaching(model: CadModel, samples: EdgeSamples, own: Sizing, number: int) -> Sizing:
    """The sizes of one face with those of their sources that reach it."""
    low, high = face_box(model.faces[number], samples.points[samples.along(number)])
    largest = own.max_size or np.inf
    if isinstance(own.size, float):
        largest = min(largest, own.size)
    kept = reaching(own.sources, low, high, largest)
    return own.replaced(sources=kept) if len(kept) < len(own.sources) else own


def face_box(face: CadFace, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (3,), (3,) of a box around a face; points: (n, 3) of its edges."""
    grid = parameter_grid(face.surface.domain, GRID)
    places = np.concatenate([face.surface.evaluate(grid, 0)[0], points])
    low, high = places.min(axis=0), places.max(axis=0)
    away = MARGIN * norm(high - low)
    return low - away, high + away
