"""Quadratic triangles: how many for one distance from the surface, beside straight ones and gmsh.

    python benchmarks/quadratic.py                       sphere and torus with gmsh, gallery without
    python benchmarks/quadratic.py --names torus wavy    some of the gallery
    python benchmarks/quadratic.py --parts a.step        CAD files too

A line each: chord as a fraction of the diagonal; straight triangles, quadratic ones, how many times
fewer; largest distance over chord of the quadratic ones at places that the mesher does not look at
(closed forms of sphere and torus, else the core's closest point); least Jacobian; processor time
over that of the straight mesh; and of gmsh the fewest of second order (``setOrder(2)`` on its own
sphere and torus, its sizes lowered until the same distance holds, by a number or by curvature; its
sphere has 320 elements at the coarsest).
``max_size`` is the diagonal, for all.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import time
from collections.abc import Callable

import gmsh_session
import numpy as np
from numpy.typing import NDArray

import surfmesh as sm
from surfmesh.accuracy.curved_triangles import points_on
from surfmesh.errors import SurfmeshError
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.result.surface_mesh import SurfaceMesh

FRACTIONS = (1_000, 10_000)
_GRID = 13
PLACES = np.array(
    [(i, j, _GRID - i - j) for i in range(_GRID + 1) for j in range(_GRID + 1 - i)]
) / float(_GRID)  # fmt: skip
HALVINGS = 12  # of the interval of gmsh's sizes
STEPS = 12  # of the search for the closest point


def off_sphere(points: NDArray) -> NDArray:
    """Distances of points (..., 3) from the sphere of the gallery."""
    return abs(np.linalg.norm(points, axis=-1) - 1.0)


def off_torus(points: NDArray) -> NDArray:
    """Likewise: of radii 3 and 1."""
    return abs(np.hypot(np.hypot(points[..., 0], points[..., 1]) - 3.0, points[..., 2]) - 1.0)


CLOSED_FORMS = {"sphere": off_sphere, "torus": off_torus}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--names", nargs="*", help="of the gallery; all by default")
    parser.add_argument("--parts", nargs="*", default=[], help="CAD files")
    options = parser.parse_args()
    print(f"{'':20s} {'diag/':>6s} {'straight':>9s} {'quadratic':>9s} {'fewer':>6s} "
          f"{'off/chord':>9s} {'jacobian':>8s} {'cpu':>5s} {'gmsh':>7s}")  # fmt: skip
    for name in sm.gallery() if options.names is None else options.names:
        surface = sm.load(name)
        if not isinstance(surface, sm.PlanarDomain):
            points = sm.mesh(surface).points
            compared(name, surface, float(np.linalg.norm(np.ptp(points, axis=0))))
    for path in options.parts:
        model = sm.load(path)
        compared(path.rsplit("/", 1)[-1][-20:], model, model.diagonal)


def compared(name: str, thing: object, diagonal: float) -> None:
    """A line for each chord."""
    for fraction in FRACTIONS:
        chord = diagonal / fraction
        sizes = sm.Sizing(chord=chord, max_size=diagonal)
        try:
            straight, before = _timed(thing, sizes)
            curved, after = _timed(thing, sizes.replaced(order=2))
        except SurfmeshError as error:
            print(f"{name:20s} {fraction:6d} {error}", flush=True)
            continue
        off = CLOSED_FORMS.get(name)
        reached = (
            off(points_on(curved.nodes[curved.elements], PLACES)).max() if off is not None
            else _off_surfaces(curved)
        )  # fmt: skip
        peer = str(fewest_of_gmsh(name, off, chord, diagonal)) if off is not None else ""
        print(f"{name:20s} {fraction:6d} {len(straight.triangles):9d} {len(curved.triangles):9d} "
              f"{len(straight.triangles) / len(curved.triangles):6.1f} {reached / chord:9.3f} "
              f"{curved.report.jacobian_min:8.3f} {after / before:5.2f} {peer:>7s}",
              flush=True)  # fmt: skip


def _timed(thing: object, sizes: sm.Sizing) -> tuple[SurfaceMesh, float]:
    start = time.process_time()
    mesh = sm.mesh(thing, sizes, jobs=1)
    return mesh, time.process_time() - start


def _off_surfaces(mesh: SurfaceMesh) -> float:
    points = points_on(mesh.nodes[mesh.elements], PLACES)
    guess, largest = np.einsum("qk,mkd->mqd", PLACES, mesh.uv), 0.0
    for face in np.unique(mesh.face_ids).tolist():
        own = mesh.face_ids == face
        found = closest_point(
            mesh.surfaces[face], points[own].reshape(-1, 3), guess[own].reshape(-1, 2), STEPS
        )
        largest = max(largest, float(found[1].max()))
    return largest


def fewest_of_gmsh(name: str, off: Callable, chord: float, diagonal: float) -> int | None:
    """Elements of second order with which gmsh keeps to the chord; None where gmsh is missing."""
    try:
        import gmsh
    except ImportError:
        return None
    counts = []
    by_size = _elements_of_gmsh(gmsh, name, lambda h: {"Mesh.MeshSizeMax": h})
    counts.append(_fewest(by_size, off, chord, 0.01 * diagonal, diagonal))
    by_turn = _elements_of_gmsh(
        gmsh, name, lambda h: {"Mesh.MeshSizeMax": diagonal, "Mesh.MeshSizeFromCurvature": 1.0 / h}
    )
    counts.append(_fewest(by_turn, off, chord, 0.01, 0.3))
    return min(counts)


def _fewest(
    elements: Callable[[float], NDArray], off: Callable, chord: float, low: float, high: float
) -> int:
    """By bisection of the size; low keeps to the chord."""
    best = len(elements(low))
    for _ in range(HALVINGS):
        size = float(np.sqrt(low * high))
        nodes = elements(size)
        if off(points_on(nodes, PLACES)).max() <= chord:
            low, best = size, min(best, len(nodes))
        else:
            high = size
    return best


def _elements_of_gmsh(
    gmsh, name: str, options: Callable[[float], dict[str, float]]
) -> Callable[[float], NDArray]:
    def elements(size: float) -> NDArray:
        """(m, 6, 3) nodes in our order, which is gmsh's."""
        gmsh_session.started(options(size))
        if name == "sphere":
            gmsh.model.occ.addSphere(0, 0, 0, 1)
        else:
            gmsh.model.occ.addTorus(0, 0, 0, 3, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        tags, points, _ = gmsh.model.mesh.getNodes()
        place = np.empty(int(tags.max()) + 1, int)
        place[tags] = np.arange(len(tags))
        _, nodes = gmsh.model.mesh.getElementsByType(9)
        gmsh.finalize()
        return points.reshape(-1, 3)[place[nodes.astype(int)]].reshape(-1, 6, 3)

    return elements


if __name__ == "__main__":
    main()
