"""The compiled core of surfmesh: arrays in, arrays and a status out."""

from surfmesh._core import (
    elementary_functions as elementary_functions,
    fields as fields,
    insertion as insertion,
    optimisation as optimisation,
    packing as packing,
    patch as patch,
    space as space,
    surfaces as surfaces,
    triangulation as triangulation
)


NIL: int = -1
