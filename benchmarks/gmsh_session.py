"""gmsh as the benchmarks have it: silent, with one thread, by its frontal-Delaunay algorithm.

``started`` begins a session; whoever began it calls ``gmsh.finalize``.
"""

from collections.abc import Mapping

FRONTAL_DELAUNAY = 6
ALWAYS = {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.Algorithm": FRONTAL_DELAUNAY}
NO_SIZES_OF_ITS_OWN = {
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.MeshSizeExtendFromBoundary": 0,
}
"""Where sizes come from a callback alone."""


def started(options: Mapping[str, float] = NO_SIZES_OF_ITS_OWN) -> None:
    """A session of gmsh with these options, by gmsh's names, beside those that always hold."""
    import gmsh

    gmsh.initialize(interruptible=False)
    for option, value in {**ALWAYS, **options}.items():
        gmsh.option.setNumber(option, value)
