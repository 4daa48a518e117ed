"""The compiled core of surfmesh: arrays in, arrays and a status out."""

from surfmesh._core import (
    edges as edges,
    elementary_functions as elementary_functions,
    faces as faces,
    fields as fields,
    insertion as insertion,
    intersection as intersection,
    optimisation as optimisation,
    packing as packing,
    patch as patch,
    proof as proof,
    quality as quality,
    sizing as sizing,
    space as space,
    surfaces as surfaces,
    triangulation as triangulation
)


NIL: int = -1

def allow_threads(count: int) -> int:
    """
    How many threads calls from this thread of Python may use; returns how many they were allowed.

    Results do not depend on it. 1 in every new thread.
    """

def return_free_memory(triangles: int) -> None:
    """
    After work on a mesh of so many triangles: give memory back to the system that the C library keeps although it is free.

    Does nothing for small meshes.
    """
