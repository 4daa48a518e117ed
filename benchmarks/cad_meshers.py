"""One CAD model by one mesher, in a process of its own. All work with a single thread.

ours    surfmesh with its default sizes: chord error diagonal / 1000, at most diagonal / 10
facts   no mesh: what the B-rep says alone
gmsh    Frontal-Delaunay on the same file read by OpenCASCADE: the same largest size, and as many
        elements a circle as give about our number of triangles (three attempts at most)
ocp     OpenCASCADE's own tessellation (BRepMesh): the same chord error, angle 0.5 rad
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import tempfile
from pathlib import Path
from time import perf_counter

import child_process
import numpy as np

AGAIN = 8.0  # processor seconds up to which our mesh is made twice: all is imported then


def run(mesher: str, place: str, timeout: float, **asked: object) -> dict:
    """place: a file, or "part:NAME". Figures of the mesh, or "error" and how it "ended"."""
    request = {"mesher": mesher, "place": place, "time_limit": timeout, **asked}
    found = child_process.run("cad_meshers.py", request, timeout)
    if "error" in found and "triangles" in found:  # a first attempt is there
        found["cut_short"] = found.pop("error")
    return found


def is_part(place: str) -> bool:
    return place.startswith("part:")


def part_of(place: str):
    from cad_parts import part

    return part(place.removeprefix("part:"))


def _ours(request: dict) -> dict:
    from brep_facts import solid_facts
    from cad_measures import clocks, spent

    import surfmesh as sm
    from surfmesh.sizing.options.defaults import with_defaults

    place = request["place"]
    shape = part_of(place) if is_part(place) else None
    start = perf_counter()
    model = sm.load(place) if shape is None else sm.from_cadquery(shape)
    read = perf_counter() - start
    sizing = with_defaults(sm.Sizing(), model.diagonal)
    known = {
        "faces": len(model.faces),
        "edges": len(model.edges),
        "seconds_read": read,
        "diagonal": model.diagonal,
        "chord": sizing.chord,
        "max_size": sizing.max_size,
        "area_exact": model.area,
        "tolerance": max(edge.tolerance for edge in model.edges),
        "facts": [solid_facts(model, solid) for solid in model.solids],
    }
    if len(model.faces) > (request.get("most_faces") or np.inf):
        return {**known, "left_out": True}
    child_process.say(known)
    if request["mesher"] == "facts":
        return known
    seconds = np.full(2, np.inf)
    for _ in range(2):
        begin = clocks()
        mesh = sm.mesh(model, strict=False)
        seconds = np.minimum(seconds, clocks() - begin)
        if seconds[1] > AGAIN:
            break
    return {**known, **spent(seconds), **_figures_of_ours(mesh, model, sizing.chord)}


def _figures_of_ours(mesh, model, chord: float) -> dict:
    """Of our own mesh, with the seconds that its check takes."""
    from cad_measures import shape_figures, solid_figures, stray_edges

    import surfmesh as sm
    from surfmesh.quality.measures.deviation import deviation
    from surfmesh.quality.measures.shape import shapes
    from surfmesh.quality.measures.solids import solid_mesh
    from surfmesh.result.findings import FindingKind

    start = perf_counter()
    shape = shapes(mesh)
    fit = deviation(mesh, shape.area)
    missing = [one for one in mesh.findings if one.kind is FindingKind.NOT_MESHED]
    failed = [one.text for one in missing]
    failed_faces = {one.face for one in missing if one.face is not None}
    bare = set(range(len(model.faces))) - set(np.unique(mesh.face_ids).tolist())
    return {
        **shape_figures(shape),
        "solids": [solid_figures(solid_mesh(mesh, k)) for k in range(len(model.solids))],
        "seconds_by_stage": dict(mesh.seconds),
        "deviation_max": fit.largest,
        "deviation_of_face": int(mesh.face_ids[fit.triangle]),
        "above_chord": int(np.count_nonzero(fit.by_triangle > chord * (1 + 1e-9))),
        "inverted": int(np.count_nonzero(fit.cosine < 0.0)),
        "failed": len(failed),
        "failed_faces": sorted(failed_faces),
        "bare_faces": sorted(bare - failed_faces),
        "stray": stray_edges(mesh, model, failed_faces),
        "reasons": failed[:3],
        "problem": mesh.broken_invariant(),
        "clean": (report := sm.check(mesh)).clean,
        "problems": [text[:160] for text in report.problems[:2]],
        "seconds_check": perf_counter() - start,
    }


def _gmsh(request: dict) -> dict:
    import cad_gmsh

    with tempfile.TemporaryDirectory(prefix="surfmesh-") as folder:
        file = request["place"]
        if is_part(file):
            shape, file = part_of(file), str(Path(folder, "part.brep"))
            shape.exportBrep(file)
        return cad_gmsh.measured(file, request, child_process.say)


def _ocp(request: dict) -> dict:
    import cad_ocp

    place = request["place"]
    made = part_of(place).wrapped if is_part(place) else None
    start = perf_counter()
    shape = made or cad_ocp.shape_of(Path(place))
    read = perf_counter() - start
    return {"seconds_read": read, **cad_ocp.measured(shape, request["chord"])}


WORK = {"ours": _ours, "facts": _ours, "gmsh": _gmsh, "ocp": _ocp}


if __name__ == "__main__":
    child_process.answer_by(WORK)
