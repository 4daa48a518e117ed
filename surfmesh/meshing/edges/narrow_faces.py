"""Faces that are narrower than the chord all along: two sides, and what joins them at the ends.

      a ----------- a ----------- a          sides a and b, nowhere farther apart than the narrow
      |  start                    |  end     width; an end is a short chain of edges, or a tip in
      b ----------- b ----------- b          which the sides meet

    strip, fillet, chamfer    ends are short edges       crescent, lens    ends are tips
    tube, needle hole, torus  both sides are the seam    flat ring         two loops, no ends

Triangles of good shape in such a face would be as small as it is narrow, and its neighbours would
be flooded with them. It has no inside to be meshed: see ``strip_triangulation``.
"""

from __future__ import annotations

import numpy as np

from surfmesh._core import edges
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import ModelArrays, model_arrays
from surfmesh.meshing.edges.edge_samples import EdgeSamples, NarrowFace
from surfmesh.sizing.options.defaults import DEFAULT_CHORD
from surfmesh.sizing.options.sizing import Sizing

NARROW = 1.0
"""Faces are narrow up to this fraction of ``chord``: any triangle across them lies within it."""

OF_SIZE = 0.25
"""And up to this fraction of the sizes that are asked for in so many words."""

OF_SIZE_ALONE = 0.1
"""Where nothing but a size is asked for, faces are narrow up to this fraction of it."""

ROUND = edges.ROUND_A_TUBE
"""Ends, and ways across, are at most so many narrow widths long: round a tube."""

SURELY = 1.0 + 1e-9
"""For sums that are rounded in another order."""


def narrow_width(sizing: Sizing, diagonal: float, points: np.ndarray) -> float:
    """What is narrow on a face with these size requests; points (n, 3): samples of its edges."""
    if sizing.gap is not None:
        return 0.0  # triangles across are asked for
    width = NARROW * (sizing.chord or DEFAULT_CHORD * diagonal)
    sizes = []
    if isinstance(sizing.size, float):
        sizes.append(sizing.size)
        if sizing.chord is None and sizing.angle is None:
            width = max(width, OF_SIZE_ALONE * sizing.size)
    sizes += [sizing.max_size] if sizing.max_size else []
    if sizing.has_law and len(points):
        sizes.append(float(sizing.law_sizes(points).min()))
    return min([width, *(OF_SIZE * size for size in sizes)])


def may_be_narrow(arrays: ModelArrays, width: np.ndarray) -> np.ndarray:
    """Numbers of the faces that lengths and areas do not show to be wider; width: (f,)."""
    is_wide = 2.0 * arrays.area > SURELY * ROUND * width * arrays.around
    return np.flatnonzero(arrays.has_coedges & ~is_wide)


def narrow_faces(model: CadModel, samples: EdgeSamples) -> dict[int, NarrowFace]:
    """By number the faces that are narrower everywhere than their ``samples.narrow_width``."""
    arrays = model_arrays(model)
    faces = may_be_narrow(arrays, samples.narrow_width)
    if not len(faces):
        return {}
    runs, width = edges.narrow_faces(
        arrays.curves, samples.points, samples.t, samples.first, arrays.first_of_face,
        arrays.first_of_loop, arrays.coedge_edge, arrays.coedge_reversed.astype(np.uint8),
        arrays.length, arrays.area, model.diagonal, faces, samples.narrow_width[faces],
        arrays.pcurves, [model.faces[face].surface.core for face in faces],
    )  # fmt: skip
    rows = runs.reshape(-1, 9).tolist()
    found = {}
    for k in np.flatnonzero(width >= 0.0).tolist():
        face, (*parts, is_closed) = int(faces[k]), rows[k]
        count = int(arrays.first_of_face[face + 1] - arrays.first_of_face[face])
        one, other, end, start = (
            tuple((first + step) % count for step in range(number))
            for first, number in zip(parts[::2], parts[1::2])
        )
        found[face] = NarrowFace((one, other), (end, start), bool(is_closed), float(width[k]))
    return found
