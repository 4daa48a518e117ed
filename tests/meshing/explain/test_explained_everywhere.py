"""explain is the field: at random points of the gallery, of CAD parts and of files, isotropic and
stretched, what it says decides is the field's own size, and where the field is lower by gradation
it says from where. SURFMESH_EXPLAINED=10000 looks at so many points.
"""

import os
from functools import cache, lru_cache

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cad.reading.readers import read_here
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.meshing.edges.edge_rules import EdgeRules
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.explain import explanation
from surfmesh.meshing.explain.axis_sizes import LOWERED
from surfmesh.meshing.explain.nearest_place import GRID, nearest_on_model, nearest_on_surface
from surfmesh.meshing.explain.origins import EdgePlaces
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.metric_roots import unpacked
from surfmesh.sizing.rules.rim_rule import Rims

POINTS = int(os.environ.get("SURFMESH_EXPLAINED", "0"))
FEW = 6
"""Points of each case otherwise."""

SIZES = (
    {"chord": 0.02}, {"chord": 0.5, "max_size": 5.0}, {"angle": 15.0}, {"size": 0.2}, {},
    {"chord": 0.01, "angle": 80.0, "min_size": 0.2, "growth": 2.0},
    {"chord": 0.01, "sources": (sm.InBall((0.5, 0.5, 0.5), 0.2, 0.05),)},
    {"size": sm.InBox((-1, -1, -1), (0, 0, 0), 0.1), "max_size": 1.0},
)  # fmt: skip
SURFACES = (
    "torus", "cylinder", "hyperbolic_paraboloid", "wavy", "dini", "ellipsoid", "seashell",
    "pierced_saddle", "monkey_saddle", "cone", "helicoid", "plane",
)  # fmt: skip
OF_PARTS = (
    {"*": sm.Sizing(chord=0.05)},
    {"*": sm.Sizing(angle=20.0, max_size=4.0), "face:1": sm.Sizing(chord=0.01)},
    {"*": sm.Sizing(chord=0.2, gap=2.0), ">Z": 1.0, "edge:1": 0.5, "vertex:0": 0.1},
    {"*": sm.Sizing(gap_faces=True, min_size=0.2)},
    {"*": sm.Sizing(chord=0.1, sources=(sm.Near((0, 0, 4), 0.1),)), "<Z": sm.Sizing(min_size=1.0)},
)
FILES = (
    "cadquery__red_cube_blue_cylinder.step", "trimesh__featuretype.STEP",
    "librepcb_base.lplib__66b0d775-2450-4f25-a826-3e86cd81d5cc.step", "dealii__wigley.iges",
)  # fmt: skip
RATIOS = (1.0, 6.0)


def block():
    part = cq.Workplane().box(20, 20, 8).edges("|Z").fillet(3).faces(">Z").workplane().hole(6)
    return sm.from_cadquery(part)


def tube():
    return sm.from_cadquery(
        cq.Workplane().circle(5).circle(4).extrude(12).rotate((0,) * 3, (1, 0, 0), 20)
    )


def lens():
    half = cq.Workplane("XZ").moveTo(0, 0).lineTo(6, 0).threePointArc((3.5, 2), (0, 3)).close()
    return sm.from_cadquery(half.revolve(250, (0, 0, 0), (0, 1, 0)))


PARTS = {"block": block, "tube": tube, "lens": lens}


def check(found, law, field, uv):
    """That ``found`` is what the law and the field have at uv (2,); how many sizes grew."""
    xy = field.chart.to_plane(uv[None])
    nodes = law(xy)
    rows = [found] if not found.axes else found.axes
    exact = [float(nodes.target_size[0])]
    if found.axes:
        exact.append(float(nodes.long_target_size[0]))
        roots = unpacked(field.metric_roots_3d(xy)[0])
        lengths = [1.0 / (axis.direction @ roots @ axis.direction) for axis in found.axes]
        slack = 0.02 if found.ratio == 1.0 else 1e-9  # nearly round: one size
        assert [axis.size for axis in found.axes] == pytest.approx(lengths, rel=slack)
    else:
        assert found.size == pytest.approx(float(field.sizes(xy)[0]), rel=1e-12)
    assert sorted(row.target_size for row in rows) == pytest.approx(sorted(exact), rel=1e-9)
    for row in rows:
        if row.origin:
            assert row.size < LOWERED * row.target_size
        else:
            assert row.winner.size == pytest.approx(row.target_size, rel=1e-9)
            assert row.winner in row.rows and row.size >= LOWERED * row.target_size
    return np.array([len(rows), sum(bool(row.origin) for row in rows)])


def inside(surface, rng):
    low, high = np.transpose(surface.domain)
    t = rng.uniform(0, 1, 2)
    t[rng.integers(2)] = rng.choice([0.0, 1.0]) if rng.uniform() < 0.1 else t[0]  # on a side
    return low + t * (high - low)


@cache
def of_surface(name, row, ratio):
    surface, sizing = sm.load(name), sm.Sizing(**SIZES[row], anisotropy=ratio)
    sides = find_sides(surface)
    return surface, sizing, size_field(surface, sizing, sides, rims=Rims(surface, sides))


def test_on_the_gallery():
    rng = np.random.default_rng(14)
    cases = [(n, r, ratio) for n in SURFACES for r in range(len(SIZES)) for ratio in RATIOS]
    counts = np.zeros(2, int)
    few = [cases[k] for k in rng.permutation(len(cases))[:8]]
    for case in cases if POINTS else few:
        surface, sizing, field = of_surface(*case)
        of_surface.cache_clear()
        places = parameter_grid(surface.domain, GRID)
        for _ in range(-(-POINTS // (2 * len(cases))) or FEW):
            point = surface.evaluate(inside(surface, rng)[None], 0)[0][0]
            found = explanation.explain_surface(surface, sizing, field, point)
            uv = nearest_on_surface(surface, point, places)[0]
            counts += check(found, field.law.without_limits(), field, uv)
    print(f"{counts[0]} sizes, {counts[1]} of them grown from elsewhere")
    assert counts[1] < counts[0]


def check_model(model, sizing, count, rng, monkeypatch):
    before = UnmeshedModel(model, sizing)
    wanted, samples, jobs = before.wanted, before.samples, before.jobs
    fields = lru_cache(None)(lambda number: made(jobs[number]))
    made = explanation.face_field
    numbers = {id(job): number for number, job in enumerate(jobs)}
    monkeypatch.setattr(explanation, "face_field", lambda job: fields(numbers[id(job)]))
    edges = EdgePlaces(EdgeRules(model, wanted), samples)
    counts = np.zeros(2, int)
    for _ in range(count):
        face = model.faces[rng.integers(len(model.faces))]
        point = face.surface.evaluate(inside(face.surface, rng)[None], 0)[0][0]
        found = explanation.explain_model(model, wanted, samples, jobs, point)
        number, uv, _, _ = nearest_on_model(model, samples, point)
        assert found.face == number
        field = fields(number)[1]
        counts += check(found, field.law.without_limits(), field, uv)
        sample = int(rng.integers(len(samples.points)))
        exact = samples.target_size[sample]
        assert edges.winner(sample).size == pytest.approx(exact, rel=1e-9), sample
    monkeypatch.undo()
    return counts


def test_on_parts(monkeypatch):
    rng = np.random.default_rng(15)
    cases = [(n, r, ratio) for n in PARTS for r in range(len(OF_PARTS)) for ratio in RATIOS]
    counts = np.zeros(2, int)
    few = [cases[k] for k in rng.permutation(len(cases))[:5]]
    for name, row, ratio in cases if POINTS else few:
        sizing = dict(OF_PARTS[row])
        sizing["*"] = sizing["*"].replaced(anisotropy=ratio)
        each = -(-POINTS // (4 * len(cases))) or FEW
        counts += check_model(PARTS[name](), sizing, each, rng, monkeypatch)
    print(f"{counts[0]} sizes, {counts[1]} of them grown from elsewhere")
    assert 0 < counts[1] < counts[0]


def test_on_files(cad_folder, monkeypatch):
    rng = np.random.default_rng(16)
    counts = np.zeros(2, int)
    for name in FILES if POINTS else FILES[:1]:
        model = read_here(cad_folder / name, True, None)
        for ratio in RATIOS:
            sizing = sm.Sizing(chord=2e-3 * model.diagonal, anisotropy=ratio)
            each = -(-POINTS // (8 * len(FILES))) or FEW
            counts += check_model(model, sizing, each, rng, monkeypatch)
    print(f"{counts[0]} sizes, {counts[1]} of them grown from elsewhere")
    assert 0 < counts[1] < counts[0]
