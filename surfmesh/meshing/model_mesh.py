"""A whole CAD model: edges, then faces, joined by number into one mesh.

edges cut once -> one job a face -> faces meshed -> joined by node numbers
  ^                                     |
  +---- smaller sizes where faces ------+
        failed or lie too far away
"""

import math
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.cad.model.facts import model_facts
from surfmesh.cad.model.loop_faults import exact_loops
from surfmesh.errors import MeshingError
from surfmesh.meshing.edges.edge_nodes import EdgeNodes, cut_edges
from surfmesh.meshing.edges.edge_samples import EdgeSamples, sample_edges
from surfmesh.meshing.edges.face_proximity import with_face_gaps
from surfmesh.meshing.edges.narrow_faces import NarrowFace
from surfmesh.meshing.estimate.estimation import Estimate
from surfmesh.meshing.estimate.model_estimate import model_counts, require_model_within
from surfmesh.meshing.estimate.trial_faces import ratios
from surfmesh.meshing.estimate.trial_mesh import ROUNDS as TRIAL_ROUNDS
from surfmesh.meshing.estimate.trial_mesh import WHOLE, WHOLE_STRETCHED, tried
from surfmesh.meshing.explain.explanation import Explanation, explain_model
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, FaceMesh
from surfmesh.meshing.faces.face_mesh import edge_wishes, mesh_face
from surfmesh.meshing.faces.face_sizings import face_sizings
from surfmesh.meshing.faces.opposite_faces import copied, opposite_pairs
from surfmesh.meshing.finishing.edge_collapse import LEAST, simplified
from surfmesh.meshing.progress import Progress, Stopwatch
from surfmesh.meshing.solids.groups import groups_of
from surfmesh.meshing.solids.volumes import VolumeAims
from surfmesh.result.findings import Finding, FindingKind
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.model_sizing import ModelSizing, model_sizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits
from surfmesh.sizing.rules.volume_rule import with_volume_rule

ROUNDS = 8
"""How often everything that depends on refined edges is done again, at most."""

PATIENCE, HOPE, GROWN = 2, 0.9, 1.02
"""A face is meshed again for its own wishes until so many rounds running have left more than this
share of the places, and made it no finer than this: smaller sizes do not reach what is wrong."""

VOLUME_ROUNDS = 4
"""How often a model is meshed for the sake of its volumes, at most: once in most cases."""

LONG_PATIENCE = 3
"""Or, however much finer it has become, until so many rounds have not left fewer places."""

SPREAD = 1.5
"""Where the segments that cross are so many times more after each round, it is not at a place
that they cross but all along: cutting them finer only makes more of them."""

MOST_GROWN, MANY_NODES = 8, 2000
"""A face whose boundary has so many times the nodes that it had at first, and more than so many,
asks for no smaller sizes any more."""

FINER = 0.6
"""Factor on the sizes where faces share an edge of triangles that they should not."""


def mesh_model(
    model: CadModel, sizing: Any, optimise: bool = True, progress: Progress | None = None,
    strict: bool = True, simplify: bool = False, workers: int = 1, rounds: int = ROUNDS,
) -> SurfaceMesh:  # fmt: skip
    """Mesh all faces of a model; neighbours share the nodes of their common edges.

    sizing: what ``model_sizing`` takes, sizes by name among it.
    simplify=True collapses what is shorter than ``min_size``, or else than a two-thousandth of
    the diagonal, at the end. workers: threads that mesh faces; the mesh is the same with any
    number of them.
    strict=False delivers what could be meshed and lists the other faces in ``warnings``.
    Raises ``MeshingError`` that names the faces that could not be meshed, with the reasons.
    """
    if strict:
        require_all_faces(model)
    watch = Stopwatch(progress)
    asked = model_sizing(model, sizing)
    aims = VolumeAims(model, asked.base.volume)
    for _ in range(VOLUME_ROUNDS):
        with watch.stage("sizing"):
            wanted = _wanted(model, asked, aims.by_solid)
        mesh = _mesh_faces(model, wanted, optimise, watch, strict, workers, rounds)
        if not aims.lowered_after(mesh):
            break
    return simplified(mesh, asked.base.min_size or LEAST * model.diagonal) if simplify else mesh


def _mesh_faces(
    model: CadModel, wanted: ModelSizing, optimise: bool, watch: Stopwatch, strict: bool,
    workers: int, rounds: int,
) -> SurfaceMesh:  # fmt: skip
    """The mesh for one set of sizes."""
    sizing = wanted.base
    with watch.stage("sizing"):
        samples = sample_edges(model, wanted)
        of_face = face_sizings(model, samples, wanted)
        opposite = opposite_pairs(model, samples)
    limits: dict[int, SizeLimits] = {}
    jobs: list[FaceJob | None] = [None] * len(model.faces)
    done: list[FaceMesh] = [FaceMesh()] * len(model.faces)
    nodes: list[EdgeNodes | None] = []
    hopes = [_Hope() for _ in model.faces]
    exact = [exact_loops(model, number, samples.vertex) for number in range(len(model.faces))]
    for _ in range(rounds):
        before = nodes
        with watch.stage("sizing"):
            nodes = cut_edges(model, sizing, samples, limits, before)
            if not before:
                first = partial(_jobs, model, nodes, samples, of_face, optimise)
                require_model_within(model, first, nodes, of_face, sizing)
        with watch.stage("packing"):
            changed = []
            for number, face in enumerate(model.faces):
                job, limit = jobs[number], limits.get(number)
                if (
                    job is None
                    or job.limits is not limit
                    or any(nodes[c.edge] is not before[c.edge] for c in face.coedges)
                ):
                    own = of_face[number]
                    narrow = samples.narrow.get(number)
                    job = _job(model, face, nodes, samples, own, limit, optimise, narrow)
                    jobs[number] = replace(job, exact=exact[number])
                    changed.append(number)
            meshes = _in_order(mesh_face, [jobs[number] for number in changed], workers)
            for count, (number, face_mesh) in enumerate(zip(changed, meshes), 1):
                done[number] = face_mesh
                hopes[number].hear(face_mesh, jobs[number].nodes)
                watch.pulse(count / len(changed))
            for first, second, width in opposite:
                if first in changed or second in changed:
                    twin = copied(done[first], jobs[first], jobs[second], width)
                    done[second] = done[second] if twin is None else twin
        with watch.stage("mapping"):
            asking = [k for k, found in enumerate(done) if found.wishes is not None]
            wishes = {k: done[k].wishes for k in asking if hopes[k].is_left}
            if not wishes or any(len(found.triangles) for found in done):
                mesh = _joined(model, jobs, done, nodes, samples, sizing, watch)
                _refine_crowded(model, mesh, sizing, wishes)
        if not wishes:
            break
        for number, wish in wishes.items():
            limits[number] = wish.joined_with(limits.get(number))
    if any(found.failure and not found.hopeless for found in done):
        with watch.stage("packing"):
            for number, found in enumerate(done):
                if found.failure and not found.hopeless:
                    done[number] = mesh_face(replace(jobs[number], last=True))
        with watch.stage("mapping"):
            mesh = _joined(model, jobs, done, nodes, samples, sizing, watch)
    failed = [_reason(model, k, found) for k, found in enumerate(done) if found.failure]
    if failed and strict:
        finer = any(found.failure and not found.hopeless for found in done)
        raise MeshingError(
            f"{len(failed)} of {len(model.faces)} faces of {model.name or model.source!r} could "
            f"not be meshed: {'; '.join(failed[:5])}"
            + (f"; and {len(failed) - 5} more" if len(failed) > 5 else "")
            + (". Lower the sizes, repair" if finer else ". Repair")
            + " the faces, or use strict=False to get the others"
        )
    mesh = mesh.replaced(promises=wanted.promises(len(model.faces)))
    return mesh.with_warnings(*_left_over(model, {*asking, *wishes}))


def require_all_faces(model: CadModel) -> None:
    """Raises ``MeshingError`` that names what was left out when the model was read."""
    if model.left_out:
        more = len(model.left_out) - 5
        raise MeshingError(
            f"{(model.name or model.source)!r} cannot be meshed in full: "
            + "; ".join(model.left_out[:5]) + (f"; and {more} more" if more > 0 else "")
            + ". Repair it, or use strict=False (--no-strict) to get the other faces"
        )  # fmt: skip


class _Hope:
    """Whether what a face asks for has helped so far, and has not made it far too large."""

    def __init__(self) -> None:
        self._rounds = self._spread = self._since_best = 0  # one after the other; see ``hear``
        self._places, self._triangles, self._best = math.inf, 0, math.inf
        self._nodes, self._first = 0, 0

    def hear(self, found: FaceMesh, nodes: int = 0) -> None:
        """Count what one round has left of a face with so many nodes on its boundary."""
        places = 0 if found.wishes is None else len(found.wishes.sizes)
        same = places > HOPE * self._places and len(found.triangles) < GROWN * self._triangles
        self._rounds = self._rounds + 1 if places and same and not found.failure else 0
        self._spread = self._spread + 1 if found.failure and places > SPREAD * self._places else 0
        better = not places or bool(found.failure) or places <= HOPE * self._best
        self._since_best = 0 if better else self._since_best + 1
        self._best = min(self._best, places) if places and not found.failure else math.inf
        self._places, self._triangles = places, len(found.triangles)
        self._nodes, self._first = nodes, self._first or nodes

    @property
    def is_left(self) -> bool:
        """Is it worth another round?"""
        return (
            max(self._rounds, self._spread) < PATIENCE
            and self._since_best < LONG_PATIENCE
            and self._nodes <= max(MOST_GROWN * self._first, MANY_NODES)
        )


def estimate_model(model: CadModel, sizing: Any) -> Estimate:
    """Triangles and memory of ``mesh_model``. Raises ``SizingError`` for wishes that cannot be."""
    wanted, _, _, jobs = _unmeshed(model, sizing)
    counts = model_counts(jobs)
    if counts.sum() <= (WHOLE_STRETCHED if wanted.is_anisotropic else WHOLE):
        made = tried(lambda stop: mesh_model(
            model, sizing, progress=stop, strict=False, rounds=TRIAL_ROUNDS
        ))  # fmt: skip
        if made is not None:
            return Estimate.of(made, wanted.is_anisotropic, model=True)
    return Estimate.of(counts * ratios(jobs, counts), wanted.is_anisotropic, model=True)


def explain_size(model: CadModel, sizing: Any, point: np.ndarray) -> Explanation:
    """Which of the sizes decides at a point (3,), or at the nearest one of the model."""
    wanted, samples, _, jobs = _unmeshed(model, sizing)
    return explain_model(model, wanted, samples, jobs, point)


def _wanted(
    model: CadModel, asked: ModelSizing, aims: Mapping[int, float] | None = None
) -> ModelSizing:
    """With what follows from volumes and from gaps between faces; aims: see ``VolumeAims``."""
    return with_face_gaps(model, with_volume_rule(model, asked, aims))


def _unmeshed(
    model: CadModel, sizing: Any
) -> tuple[ModelSizing, EdgeSamples, list[Sizing], list[FaceJob]]:
    """Wishes, samples of edges, wishes by face and jobs: all that precedes the first mesh."""
    wanted = _wanted(model, model_sizing(model, sizing))
    samples = sample_edges(model, wanted)
    of_face = face_sizings(model, samples, wanted)
    nodes = cut_edges(model, wanted.base, samples, {})
    jobs = _jobs(model, nodes, samples, of_face, True)
    if wanted.is_anisotropic:  # long edges are cut again, and many of them
        asked = {k: found for k, job in enumerate(jobs) if (found := edge_wishes(job))}
        nodes = cut_edges(model, wanted.base, samples, asked, nodes)
        jobs = _jobs(model, nodes, samples, of_face, True, asked)
    return wanted, samples, of_face, jobs


def _jobs(
    model: CadModel, nodes: list[EdgeNodes | None], samples: EdgeSamples, sizings: list[Sizing],
    optimise: bool, limits: Mapping[int, SizeLimits] | None = None,
) -> list[FaceJob]:  # fmt: skip
    """The jobs of all faces before anything is known of their meshes."""
    return [
        _job(
            model,
            face,
            nodes,
            samples,
            own,
            (limits or {}).get(number),
            optimise,
            samples.narrow.get(number),
        )
        for number, (face, own) in enumerate(zip(model.faces, sizings))
    ]


def _in_order(work: Callable, jobs: list, workers: int) -> Iterator:
    """The results of all jobs, in their order."""
    if workers <= 1 or len(jobs) <= 1:
        yield from map(work, jobs)
        return
    with ThreadPoolExecutor(workers) as threads:
        yield from threads.map(work, jobs)


def _left_over(model: CadModel, faces: set[int]) -> list[str]:
    """What is said of faces that would need another round."""
    if not faces:
        return []
    names = [f"{k} ({model.faces[k].name or model.faces[k].kind})" for k in sorted(faces)]
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return [
        f"smaller sizes, tried in up to {ROUNDS} rounds, have not sufficed on faces "
        f"{', '.join(names[:5])}{more}"
    ]


def _failure(model: CadModel, number: int, found: FaceMesh) -> Finding:
    label = model.face_label(number)
    return Finding(FindingKind.NOT_MESHED, found.failure, number, label)


def _reason(model: CadModel, number: int, found: FaceMesh) -> str:
    return f"{model.face_label(number)}: {found.failure or found.remark}"


def _job(
    model: CadModel, face: CadFace, nodes: list[EdgeNodes | None], samples: EdgeSamples,
    sizing: Sizing, limits: SizeLimits | None, optimise: bool, narrow: NarrowFace | None,
) -> FaceJob:  # fmt: skip
    loops = []
    for loop in face.loops:
        pieces = []
        for coedge in loop:
            cut, edge = nodes[coedge.edge], model.edges[coedge.edge]
            if cut is None:
                vertex = int(samples.vertex[edge.start])
                points = np.tile(model.vertices[vertex].point, (2, 1))
                ends = coedge.walk(np.array([0.0, 1.0]))
                numbers = np.full(2, vertex, np.int64)
                none = np.full(2, np.inf)
                pieces.append(CoedgeNodes(ends, numbers, points, none, True, edge.tolerance))
                continue
            order = slice(None, None, -1) if coedge.reversed else slice(None)
            uv = coedge.uv(cut.share)[order]
            numbers, points, sizes = cut.numbers[order], cut.points[order], cut.sizes[order]
            pieces.append(CoedgeNodes(uv, numbers, points, sizes, False, edge.tolerance))
        loops.append(tuple(pieces))
    return FaceJob(face.surface, tuple(loops), sizing, limits, optimise, narrow=narrow)


def orientation(model: CadModel) -> tuple[np.ndarray, np.ndarray]:
    """Which faces are turned over (f,), and the solids behind and before them (f, 2).

    A triangle's normal points out of the first solid and into the second; -1 is none.
    """
    turned = np.array([face.reversed for face in model.faces], bool)
    solids = np.full((len(model.faces), 2), -1, np.int32)
    for number, solid in enumerate(model.solids):
        for shell in solid.shells:
            for face, against in shell:
                solids[face, int(against)] = number
    against = (solids[:, 0] < 0) & (solids[:, 1] >= 0)
    for shell in model.free_shells:
        for face, flag in shell:
            against[face] |= flag
    solids[against] = solids[against][:, ::-1]
    return turned ^ against, solids


def _inverse_sizes(found: FaceMesh) -> np.ndarray:
    """Of the ``uv_points`` of a face (n, 6), also of one whose sizes are the same all ways."""
    if found.inverse_sizes is not None:
        return found.inverse_sizes
    size = np.ones(len(found.uv_points))
    size[found.uv_triangles] = found.sizes[found.triangles]
    return np.array([1.0, 0.0, 0.0, 1.0, 0.0, 1.0]) / size[:, None]


def _joined(
    model: CadModel, jobs: list[FaceJob], done: list[FaceMesh], nodes: list[EdgeNodes | None],
    samples: EdgeSamples, sizing: Sizing, watch: Stopwatch,
) -> SurfaceMesh:  # fmt: skip
    """Boundary nodes by their numbers, then the inner points of face after face."""
    edges = [(number, cut) for number, cut in enumerate(nodes) if cut is not None]
    shared = max([len(model.vertices), *(int(cut.numbers.max()) + 1 for _, cut in edges)])
    points, sizes = np.zeros((shared, 3)), np.full(shared, np.inf)
    points[: len(model.vertices)] = [vertex.point for vertex in model.vertices]
    for _, cut in edges:
        points[cut.numbers] = cut.points
        np.minimum.at(sizes, cut.numbers, cut.sizes)
    turned, solids = orientation(model)
    inner_points, inner_sizes, triangles, uv, uv_triangles, face_ids = [], [], [], [], [], []
    stretched: list[np.ndarray] = []
    is_stretched = any(found.inverse_sizes is not None for found in done)
    total = shared
    uv_total = 0
    for number, (job, found) in enumerate(zip(jobs, done)):
        if not len(found.triangles):
            continue
        names = np.concatenate([piece.numbers for loop in job.loops for piece in loop])
        inside = found.slots < 0
        own = np.empty(len(found.points), np.int64)
        own[~inside] = names[found.slots[~inside]]
        own[inside] = total + np.arange(int(inside.sum()))
        total += int(inside.sum())
        np.minimum.at(sizes, own[~inside], found.sizes[~inside])  # poles have no edge of a size
        inner_points.append(found.points[inside])
        inner_sizes.append(found.sizes[inside])
        order = [0, 2, 1] if turned[number] else [0, 1, 2]
        triangles.append(own[found.triangles][:, order])
        uv.append(found.uv_points)
        uv_triangles.append(uv_total + found.uv_triangles[:, order].astype(np.int64))
        uv_total += len(found.uv_points)
        if is_stretched:
            stretched.append(_inverse_sizes(found))
        face_ids.append(np.full(len(found.triangles), number, np.int32))
    if not triangles:
        reasons = [
            _reason(model, k, found) for k, found in enumerate(done)
            if found.failure or found.remark
        ]  # fmt: skip
        raise MeshingError(f"no face could be meshed: {'; '.join(reasons[:5])}")
    points = np.concatenate([points, *inner_points])
    sizes = np.concatenate([sizes, *inner_sizes])
    triangles = np.concatenate(triangles)
    face_ids = np.concatenate(face_ids)
    used = np.zeros(len(points), bool)
    used[triangles.ravel()] = True
    rank = np.where(used, np.cumsum(used) - 1, -1)
    segments = [np.stack([cut.numbers[:-1], cut.numbers[1:]], axis=1) for _, cut in edges]
    of = [np.full(len(cut.share) - 1, number) for number, cut in edges]
    shares = [np.stack([cut.share[:-1], cut.share[1:]], axis=1) for _, cut in edges]
    shares = np.concatenate(shares) if shares else np.empty((0, 2))
    segments = rank[np.concatenate(segments)] if segments else np.empty((0, 2), np.int64)
    of = np.concatenate(of) if of else np.empty(0, np.int64)
    there = (segments >= 0).all(axis=1)
    findings = [Finding(FindingKind.NOT_MESHED, said) for said in model.left_out]
    findings += [_failure(model, k, found) for k, found in enumerate(done) if found.failure]
    findings += [
        Finding(FindingKind.OFF_SURFACE, found.remark, k, model.face_label(k))
        for k, found in enumerate(done)
        if found.remark
    ]
    return SurfaceMesh(
        points=points[used],
        triangles=rank[triangles],
        uv_points=np.concatenate(uv),
        uv_triangles=np.concatenate(uv_triangles),
        face_ids=face_ids,
        surfaces=tuple(face.surface for face in model.faces),
        turned_faces=turned,
        narrow_faces=np.array([found.narrow for found in done], bool),
        solid_ids=solids[face_ids],
        edge_segments=segments[there],
        edge_ids=of[there],
        edge_parameters=shares[there],
        edge_curves=model.edges,
        vertex_ids=rank[samples.vertex],
        sizes=np.where(np.isfinite(sizes), sizes, model.diagonal)[used],
        groups=groups_of(model),
        metric_root_3d=np.concatenate(stretched) if stretched else None,
        sizing=sizing,
        seconds=watch.seconds,
        warnings=(*model.healing, *_loose(model, sizing), *(found.text for found in findings)),
        findings=tuple(findings),
        facts=model_facts(model),
    )


def _loose(model: CadModel, sizing: Sizing) -> list[str]:
    """A sentence on edges whose faces are farther apart than the chord error asked for."""
    if sizing.chord is None:
        return []
    real = [k for k, edge in enumerate(model.edges) if edge.curve is not None]
    loose = [k for k in real if model.edges[k].tolerance > sizing.chord]
    if not loose:
        return []
    worst = max(loose, key=lambda k: model.edges[k].tolerance)
    return [
        f"{len(loose)} edge{'s' if len(loose) > 1 else ''} may lie farther off the faces than the "
        f"chord error of {sizing.chord:.3g}, and the mesh with them; the tolerance of edge {worst} "
        f"is {model.edges[worst].tolerance:.3g} {model.unit}"
    ]


def _refine_crowded(
    model: CadModel, mesh: SurfaceMesh, sizing: Sizing, wishes: dict[int, SizeLimits]
) -> None:
    """Ask for smaller sizes where faces made the same chord between their common nodes.

    Along an edge of the model there are as many triangles as it has uses.
    """
    table = mesh.connectivity
    crowded = table.uses > 2
    if not crowded.any() or not len(mesh.edge_segments):
        return
    code = np.array([len(mesh.points), 1], np.int64)
    along, place = np.unique(np.sort(mesh.edge_segments, axis=1) @ code, return_inverse=True)
    users = np.array([len(model.faces_of_edge(edge)) for edge in range(len(model.edges))])
    allowed = np.bincount(place.reshape(-1), users[mesh.edge_ids])
    keys = table.edges @ code
    row = np.minimum(np.searchsorted(along, keys), len(along) - 1)
    most = np.where(along[row] == keys, np.maximum(allowed[row], 2), 2)
    bad = np.flatnonzero(table.uses > most)
    if not len(bad):
        return
    ends = table.edges[bad].ravel()
    sizes = FINER * mesh.sizes[ends]
    limits = SizeLimits(mesh.points[ends], sizes, sizing.gradient)
    at = np.isin(mesh.triangles, ends).any(axis=1)
    for face in np.unique(mesh.face_ids[at]).tolist():
        wishes[face] = limits.joined_with(wishes.get(face))
