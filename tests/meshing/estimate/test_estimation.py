"""What ``estimate`` says beforehand against the meshes: small, stretched, thin, large."""

from functools import partial

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.faces import metric_areas_inward
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.meshing import model_mesh, parametric_mesh
from surfmesh.meshing.estimate import model_estimate, trial_mesh
from surfmesh.meshing.estimate.estimation import field_triangles
from surfmesh.meshing.estimate.face_counts import Alike, counts_of_faces
from surfmesh.meshing.estimate.trial_patches import triangles_per_unit
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.faces.face_mesh import face_field
from surfmesh.meshing.faces.face_queue import FaceQueue
from surfmesh.meshing.faces.inward_faces import InwardFaces
from surfmesh.sizing.field.metric_area import box_area, metric_area
from surfmesh.sizing.field.size_field import size_field

RING = np.stack([np.cos(t := np.linspace(0, 2 * np.pi, 200, endpoint=False)), np.sin(t)], axis=1)


@pytest.fixture
def nothing_is_small(monkeypatch):
    monkeypatch.setattr(parametric_mesh, "WHOLE", 0)
    monkeypatch.setattr(parametric_mesh, "FEW", 0)


@pytest.mark.parametrize(
    "name, sizing",
    [
        ("spring", sm.Sizing(chord=0.001, anisotropy=5)),
        ("klein", sm.Sizing(chord=0.01, anisotropy=100)),
        ("torus", sm.Sizing(angle=10)),
        ("torus", sm.Sizing(angle=8, anisotropy=5)),
        ("wavy", None),
    ],
)
def test_patches_tell_what_the_optimiser_makes_of_a_formula(nothing_is_small, name, sizing):
    surface = sm.load(name)
    found, mesh = sm.estimate(surface, sizing), sm.mesh(surface, sizing)
    assert found.triangles == pytest.approx(len(mesh.triangles), rel=0.12)


def test_patches_of_equal_sizes_add_nothing():
    surface = sm.load("sphere")
    field = size_field(surface, sm.Sizing(size=0.03), find_sides(surface))
    assert triangles_per_unit(surface, field, None) == pytest.approx(1.0, abs=0.05)
    box = np.concatenate([np.zeros(2), field.chart.extent])
    assert box_area(field, box, 200) == pytest.approx(metric_area(field), rel=0.01)
    assert field_triangles(field) > trial_mesh.WHOLE


def test_no_patch_fits_in_a_narrow_loop():
    surface = sm.load("sphere")
    field = size_field(surface, sm.Sizing(size=0.03), find_sides(surface))
    (u0, u1), (v0, v1) = surface.domain
    v = 0.5 * (v0 + v1)
    strip = np.array([[u0, v], [u1, v], [u1, v + 0.01], [u0, v + 0.01]])
    assert triangles_per_unit(surface, field, [strip]) is None


@pytest.mark.parametrize("size", [20.0, 6.0, 1.0, 0.5])
def test_rings_that_are_hardly_wider_than_their_triangles(size):
    ring = sm.PlanarDomain(10 * RING, holes=[9.7 * RING])
    mesh = sm.mesh(ring, size)
    assert sm.estimate(ring, size).triangles == pytest.approx(len(mesh.triangles), rel=0.12)


PARTS = {
    "box": (cq.Workplane().box(10, 20, 30), None),
    "stretched box": (cq.Workplane().box(10, 20, 30), sm.Sizing(anisotropy=20)),
    "pin": (cq.Workplane().cylinder(20, 0.2), sm.Sizing(chord=0.1)),
    "flat ring": (cq.Workplane().circle(10).circle(9.8).extrude(0.2), None),
    "cone": (cq.Solid.makeCone(5, 1, 12), sm.Sizing(anisotropy=20)),
    "named": (cq.Workplane().box(60, 40, 5), {"*": 3.0, ">Z": 1.0}),
}


@pytest.mark.parametrize("name", PARTS)
def test_parts(name):
    shape, sizing = PARTS[name]
    model = sm.from_cadquery(shape)
    found, mesh = sm.estimate(model, sizing), sm.mesh(model, sizing)
    assert found.triangles == pytest.approx(len(mesh.triangles), rel=0.12)
    by_face = np.bincount(mesh.face_ids)
    assert np.array(found.by_face) == pytest.approx(by_face, rel=0.25, abs=30)


def test_holes_that_the_volume_asks_to_be_finer_make_the_plate_finer_too():
    plate = cq.Workplane().box(60, 60, 3).faces(">Z").workplane().rarray(6, 6, 9, 9).hole(4)
    model = sm.from_cadquery(plate)
    found, mesh = (make(model, sm.Sizing(volume=0.005)) for make in (sm.estimate, sm.mesh))
    assert len(mesh.triangles) > trial_mesh.WHOLE
    assert found.triangles == pytest.approx(len(mesh.triangles), rel=0.15)


def no_mesh(*_, **__):
    raise AssertionError("a mesh is made")


@pytest.mark.parametrize("sizing", [sm.Sizing(size=0.6), sm.Sizing(chord=0.005)])
def test_where_the_first_round_tells_all_no_mesh_is_made(monkeypatch, sizing):
    plate = cq.Workplane().box(12, 9, 1).edges("|Z").fillet(2).faces(">Z").workplane().hole(3)
    model = sm.from_cadquery(plate)
    mesh = sm.mesh(model, sizing)
    assert trial_mesh.FEW < len(mesh.triangles) < trial_mesh.WHOLE
    monkeypatch.setattr(model_mesh, "mesh_model", no_mesh)
    assert sm.estimate(model, sizing).triangles == pytest.approx(len(mesh.triangles), rel=0.06)


def test_where_triangles_fold_at_first_a_small_mesh_is_made():
    """A torus of sizes that are larger than its tube needs far more triangles than they say."""
    model = sm.from_cadquery(cq.Workplane(obj=cq.Solid.makeTorus(20, 1)).box(30, 30, 0.5))
    found, mesh = (make(model, sm.Sizing(size=2.5)) for make in (sm.estimate, sm.mesh))
    assert found.triangles == pytest.approx(len(mesh.triangles), rel=0.1)
    surface = sm.load("spring")
    made = sm.mesh(surface, 1.5)
    assert sm.estimate(surface, 1.5).triangles == pytest.approx(len(made.triangles), rel=0.02)


def test_areas_in_the_core_are_those_of_the_size_fields():
    plate = cq.Workplane().box(12, 9, 1).edges("|Z").fillet(2).faces(">Z").workplane().hole(3)
    before = UnmeshedModel(sm.from_cadquery(plate), 0.6)
    makes = InwardFaces()
    areas = metric_areas_inward([makes.face(job) for job in before.jobs])
    fields = [face_field(job)[1] for job in before.jobs]
    wanted = [metric_area(field, job.rings) for field, job in zip(fields, before.jobs)]
    assert areas == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("growth", [1.2, 1.5, 2.0])
def test_where_sizes_change_steeply_there_are_more_triangles_than_fit_by_area(growth):
    plate = cq.Workplane().box(60, 40, 8).faces(">Z").workplane().rarray(20, 20, 3, 2).hole(3)
    model = sm.from_cadquery(plate)
    sizing = sm.Sizing(chord=0.006, max_size=8, growth=growth)
    mesh = sm.mesh(model, sizing)
    found = UnmeshedModel(model, sizing, few=True).counts(model_estimate.FaceFields())
    assert found.sum() == pytest.approx(len(mesh.triangles), rel=0.03)


def counts(subject, size):
    make = partial(sm.mesh, subject, size)
    return trial_mesh.counts_within_budget(lambda budget: make(progress=budget))


def test_a_trial_that_needs_too_much_work_is_given_up(monkeypatch):
    monkeypatch.setattr(trial_mesh, "BUDGET", 0)
    surface = sm.load("torus")
    assert counts(surface, 0.3) is None
    assert sm.estimate(surface, 0.3).triangles == pytest.approx(
        len(sm.mesh(surface, 0.3).triangles), rel=0.1
    )


@pytest.mark.parametrize("budget, faces_meshed", [(0, 1), (2_000, 5), (10**9, 6)])
def test_the_work_of_a_model_is_counted_face_by_face(monkeypatch, budget, faces_meshed):
    """Six faces, each of some 400 units: no clock decides where the trial ends."""
    model = sm.from_cadquery(cq.Workplane().box(1, 1, 1))
    work, meshed = FaceQueue.work, []

    def counted(queue, triangles):
        made = work(queue, triangles)
        meshed.extend(made)
        return made

    monkeypatch.setattr(FaceQueue, "work", counted)
    monkeypatch.setattr(trial_mesh, "BUDGET", budget)
    found = counts(model, 1.0)
    assert len(meshed) == faces_meshed
    assert (found is None) == (faces_meshed < 6)


def test_many_faces_are_counted_by_a_close_look_at_some():
    """Alike holes once; where all differ a sample, and the total is as near as the others are."""
    sizes = np.linspace(0.3, 0.9, 70)
    places = [(x, y) for x in range(10) for y in range(7)]
    plate = cq.Workplane().box(24, 18, 1)
    differing = plate
    alike = plate.faces(">Z").workplane().rarray(2.2, 2.2, 10, 7).hole(1.0)
    for (x, y), diameter in zip(places, sizes.tolist()):
        centre = (2.2 * (x - 4.5), 2.2 * (y - 3))
        top = differing.faces(">Z").workplane(origin=(0, 0, 0.5))
        differing = top.center(*centre).hole(diameter)
    looked = []
    for shape, most in ((alike, 20), (differing, 80)):
        model = sm.from_cadquery(shape)
        before = UnmeshedModel(model, 0.15)
        areas = np.array([face.area for face in model.faces])
        fields = model_estimate.FaceFields()
        every = model_estimate.counts_by_area(before.jobs, fields)
        looked.clear()

        def count(numbers, jobs=before.jobs, fields=fields):
            looked.extend(numbers)
            return model_estimate.counts_by_area([jobs[k] for k in numbers], fields)

        found = counts_of_faces(
            before.jobs, areas, before.most, Alike.among(before.jobs, areas), count
        )
        assert len(looked) < min(most, len(model.faces))
        assert found.sum() == pytest.approx(every.sum(), rel=0.03)


def test_faces_with_few_triangles_are_not_looked_at_however_they_are_curved(monkeypatch):
    """Balls beside a plate: fields of small ones are not made, those of large ones are."""

    def fields_made(radius):
        made = []
        monkeypatch.setattr(
            model_estimate, "face_field", lambda job: made.append(job) or face_field(job)
        )
        shape = cq.Workplane().box(60, 40, 2).union(
            cq.Workplane().sphere(radius).translate((0, 0, 10 + radius))
        )  # fmt: skip
        before = UnmeshedModel(sm.from_cadquery(shape), 0.8, few=True)
        counts = before.counts(model_estimate.FaceFields())
        return counts, len(made)

    counts, few = fields_made(0.5)
    assert few == 0 and counts.min() > 0.0
    assert fields_made(5.0)[1] == 1


def test_memory_is_said_of_the_mesh_and_with_the_program():
    small, large = (sm.estimate(sm.load("torus"), size) for size in (0.3, 0.03))
    assert 0 < small.mesh_memory < large.mesh_memory < large.memory
    assert small.mesh_memory < 10_000 * small.triangles
    assert large.to_dict()["mesh_memory_bytes"] == large.mesh_memory
    assert "of memory at the peak" in str(large) and "with the program" in str(large)
