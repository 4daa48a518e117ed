"""Which edges of a face are looked at as mates: the core against a slow twin that looks at all."""

from itertools import permutations

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core.edges import edges_beside
from surfmesh._core.space import edge_gaps, edge_sags
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.sizing.options.model_sizing import model_sizing

ACUTE = 0.85


def found(model, samples, width):
    arrays = model_arrays(model)
    return edges_beside(
        samples.points, samples.first, arrays.mesh_ends, samples.first_of_face, samples.face_edges,
        arrays.coedge_edge, arrays.coedge_face, arrays.coedge_reversed.view(np.uint8),
        *arrays.successions, width, ACUTE,
    ).tolist()  # fmt: skip


def twin_meeting(model, samples, width):
    arrays, pairs = model_arrays(model), []
    for one, other in zip(*arrays.successions):
        ways = []
        for coedge, is_end in ((one, True), (other, False)):
            points = samples.points[samples.of(arrays.coedge_edge[coedge])]
            points = points[::-1] if arrays.coedge_reversed[coedge] else points
            ways.append(points[-2] - points[-1] if is_end else points[1] - points[0])
        into, out = ways
        a, b = arrays.coedge_edge[[one, other]].tolist()
        face = int(arrays.coedge_face[one])
        if width[face] > 0 and into @ out > ACUTE * np.linalg.norm(into) * np.linalg.norm(out):
            pairs += [[face, a, b], [face, b, a]]
    return pairs


def twin_near(model, samples, width):
    """Rows of one width, which all faces have."""
    ends, sag = model_arrays(model).mesh_ends, edge_sags(samples.points, samples.first)
    reach = np.repeat(width[0] + sag + sag.max(), np.diff(samples.first))
    gap, boxes = edge_gaps(
        samples.points, reach, samples.first, ends, samples.face_edges, samples.first_of_face
    )
    near = {samples.edge_of(row) for row in np.flatnonzero(np.isfinite(gap)).tolist()}
    rows = []
    for face in range(len(width)):
        own = [edge for edge in samples.edges_of(face).tolist() if edge in near]
        for a, b in permutations(own, 2):
            apart = np.maximum(boxes[a, :3] - boxes[b, 3:], boxes[b, :3] - boxes[a, 3:])
            close = np.linalg.norm(np.maximum(apart, 0.0)) <= width[0] + sag[a] + sag[b]
            if close and not set(ends[a]) & set(ends[b]):
                rows.append([face, a, b])
    return rows


@settings(max_examples=15, deadline=None)
@given(apart=st.floats(0.02, 0.4), height=st.floats(0.5, 2.0), width=st.floats(0.05, 0.5))
def test_edges_beside_are_those_of_a_slow_twin(apart, height, width):
    lens = (
        cq.Workplane().moveTo(-5, 0).threePointArc((0, height + apart), (5, 0))
        .threePointArc((0, height), (-5, 0)).close().extrude(3)
    )  # fmt: skip
    plate = cq.Workplane().box(6, 6, 1).faces(">Z").workplane().rarray(2 + apart, 3, 2, 1).hole(2)
    for shape in (lens, plate):
        model = sm.from_cadquery(shape)
        samples = sample_edges(model, model_sizing(model, sm.Sizing(chord=0.1)))
        widths = np.full(len(model.faces), width)
        wanted = twin_meeting(model, samples, widths) + twin_near(model, samples, widths)
        assert found(model, samples, widths) == wanted


def test_faces_that_nothing_is_narrow_on_are_not_looked_at():
    """The widths are looked at in the order of their first faces."""
    model = sm.from_cadquery(cq.Workplane().box(9, 5, 0.05))
    samples = sample_edges(model, model_sizing(model, sm.Sizing(chord=0.01)))
    every = np.array([0.2, 0.1, 0.2, 0.1, 0.2, 0.1])
    rows = found(model, samples, every)
    faces = [face for face, *_ in rows]
    assert faces and faces == sorted(faces, key=lambda face: (face % 2, face))
    some = np.where(np.arange(6) % 2 == 0, every, 0.0)
    assert found(model, samples, some) == [row for row in rows if row[0] % 2 == 0]
    assert found(model, samples, np.zeros(6)) == []


def test_widths_of_all_faces_are_asked_for():
    model = sm.from_cadquery(cq.Workplane().box(9, 5, 1))
    samples = sample_edges(model, model_sizing(model, None))
    with pytest.raises(ValueError, match="first_of_face"):
        found(model, samples, np.ones(5))
