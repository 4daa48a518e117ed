"""gmsh on a CAD file, with about as many triangles as are wanted."""

from collections.abc import Callable
from time import perf_counter

import gmsh
import gmsh_session
import numpy as np
from cad_measures import (
    clocks,
    own_vertices,
    shape_figures,
    solid_figures,
    spent,
    without_collapsed,
)

from surfmesh.quality.measures.shape import shapes

ATTEMPTS = 3
NEAR = 1.15  # ratio of the numbers of triangles that is good enough
FIRST_RADIUS = 0.05  # of the diagonal: the elements a circle of the first attempt fit this one
FEWEST, MOST = 4.0, 200.0  # elements a circle
SAMPLED = 1000  # triangles whose distance from the surface is looked at
SAMPLE_SECONDS = 15.0
OPTIONS = {"Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeExtendFromBoundary": 1}


def measured(file: str, request: dict, say: Callable[[dict], None]) -> dict:
    """Of the attempt whose number of triangles is nearest to request["wanted"]; tells ``say``
    of each, lest a later one hangs. Without a wanted number there is one attempt."""
    began = start = perf_counter()
    read(file, request["max_size"])
    known = {"seconds_read": perf_counter() - start, "faces": len(gmsh.model.getEntities(2))}
    wanted = request.get("wanted")
    circle = 1.0 / np.arccos(1.0 - request["chord"] / (FIRST_RADIUS * request["diagonal"]))
    masses = [gmsh.model.occ.getMass(3, tag) for _, tag in gmsh.model.getEntities(3)]
    tried, best, circle = [], {}, float(np.pi * circle)
    for _ in range(ATTEMPTS if wanted else 1):
        start = perf_counter()
        figures, mesh = attempt(circle, masses)
        found = {**known, **figures}
        tried.append((circle, found["triangles"]))
        found["attempts"] = tried
        if not best or _miss(found, wanted) < _miss(best, wanted):
            best, chosen = found, mesh
        say({**best, "attempts": tried})
        spent = perf_counter() - start
        left = request["time_limit"] - (perf_counter() - began)
        if not wanted or _miss(best, wanted) <= np.log(NEAR) or left < 4.0 * spent:
            break
        circle = _next(tried, wanted)
        if any(abs(circle / old - 1.0) < 0.02 for old, _ in tried):
            break
    best["attempts"] = tried
    best |= _deviation(*chosen, request["chord"])
    gmsh.finalize()
    return best


def read(file: str, max_size: float) -> None:
    """Have ``file`` in gmsh, with our options."""
    gmsh_session.started(OPTIONS)
    gmsh.logger.start()
    try:
        gmsh.model.occ.importShapes(file)
        gmsh.model.occ.synchronize()
    except Exception as error:  # its own text may be empty
        said = [str(error), *reversed(gmsh.logger.get()), "no reason given"]
        raise RuntimeError(f"not read by gmsh: {next(filter(None, said))}") from None
    gmsh.option.setNumber("Mesh.MeshSizeMax", max_size)


def _miss(found: dict, wanted: int | None) -> float:
    return abs(np.log(max(found["triangles"], 1) / wanted)) if wanted else 0.0


def _next(tried: list, wanted: int) -> float:
    """Elements a circle: triangles ~ circle^2 to begin with, then as the last two attempts say."""
    circle, count = np.log([tried[-1][0], max(tried[-1][1], 1)])
    power = 2.0
    if len(tried) > 1:
        before, then = np.log([tried[-2][0], max(tried[-2][1], 1)])
        power = float(np.clip((count - then) / (circle - before), 1.0, 2.0))
    step = np.clip((np.log(wanted) - count) / power, -1.5, 1.5)
    return float(np.clip(np.exp(circle + step), FEWEST, MOST))


def attempt(circle: float, masses: list[float]) -> tuple[dict, tuple]:
    """Figures of one mesh, and the mesh: points, and the triangles of each face."""
    gmsh.model.mesh.clear()
    gmsh.logger.stop()
    gmsh.logger.start()
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", circle)
    start = clocks()
    error = ""
    try:
        gmsh.model.mesh.generate(2)
    except Exception as raised:  # what is meshed is there all the same
        error = str(raised)
    seconds = clocks() - start
    errors = [line for line in gmsh.logger.get() if line.startswith("Error")]
    tags, points, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    tags, points = tags[order], points.reshape(-1, 3)[order]
    of_face, failed = {}, []
    for _, face in gmsh.model.getEntities(2):
        kinds, _, corners = gmsh.model.mesh.getElements(2, face)
        if 2 not in kinds:
            failed.append(face)
            continue
        found = np.searchsorted(tags, corners[list(kinds).index(2)]).reshape(-1, 3)
        of_face[face] = without_collapsed(found)
    everything = np.concatenate([*of_face.values(), np.empty((0, 3), np.int64)]).astype(np.int64)
    figures = {
        **shape_figures(shapes(own_vertices(points, everything))),
        "solids": _solids(points, of_face, masses),
        **spent(seconds),
        "circle": circle,
        "failed": len(failed),
        "failed_faces": failed,
        "reasons": ([error] if error else []) + errors[:3],
    }
    return figures, (points, of_face)


def _solids(points: np.ndarray, of_face: dict[int, np.ndarray], masses: list[float]) -> list[dict]:
    """Triangles look out of the first solid that has the face, into the second."""
    solids, met = [], set()
    for (dimension, tag), exact in zip(gmsh.model.getEntities(3), masses):
        _, faces = gmsh.model.getAdjacencies(dimension, tag)
        around = [of_face[f][:, :: -1 if f in met else 1] for f in faces if f in of_face]
        met.update(faces)
        triangles = np.concatenate([*around, np.empty((0, 3), np.int64)]).astype(np.int64)
        figures = solid_figures(own_vertices(points, triangles)) if len(triangles) else {}
        solids.append({**figures, "volume_exact": exact})
    return solids


def _deviation(points: np.ndarray, of_face: dict[int, np.ndarray], chord: float) -> dict:
    """Distance of centroids and middles of sides from the surface, of a random sample: each
    closest point is sought by OpenCASCADE, which takes its time."""
    faces = [face for face, corners in of_face.items() if len(corners)]
    if not faces:
        return {}
    corners = np.concatenate([of_face[face] for face in faces])
    face_of = np.repeat(faces, [len(of_face[face]) for face in faces])
    chosen = np.random.default_rng(0).permutation(len(corners))[:SAMPLED]
    p = points[corners[chosen]]
    places = np.stack([p.mean(axis=1), *(0.5 * (p[:, k] + p[:, k - 1]) for k in range(3))], axis=1)
    start, far = perf_counter(), []
    for face, samples in zip(face_of[chosen], places):
        nearest, _ = gmsh.model.getClosestPoint(2, int(face), samples.ravel())
        far.append(np.linalg.norm(samples - nearest.reshape(-1, 3), axis=1).max())
        if perf_counter() - start > SAMPLE_SECONDS:
            break
    return {
        "sampled": len(far),
        "sampled_above": int(np.count_nonzero(np.array(far) > chord * (1 + 1e-9))),
        "sampled_max": float(max(far)),
    }
