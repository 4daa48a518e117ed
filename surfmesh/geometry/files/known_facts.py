"""What formula files and domains say of themselves, as ``ModelFacts``."""

from __future__ import annotations

import hashlib
import json
import sys

import numpy as np

from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.surface import Surface, stated_facts
from surfmesh.result.model_facts import ModelFacts


def known_facts(surface: Surface) -> ModelFacts:
    """Facts of one surface. A planar domain's area is exact, all else is as its file has it.

    The hash is that of its formulas, parameters and loops, or of its points and segments:
    equal for equal input, however the file is laid out.
    """
    stated = stated_facts(surface)
    digest = None
    area, volume = stated.get("area"), stated.get("volume")
    # a class that nobody has imported has no instances
    planar = sys.modules.get("surfmesh.geometry.planar.planar_domain")
    if planar is not None and isinstance(surface, planar.PlanarDomain):
        area, volume = surface.area, None
        graph = surface.graph
        digest = hashlib.sha256(graph.points.astype("<f8").tobytes())
        digest.update(graph.segments.astype("<i8").tobytes())
        digest.update(graph.lone_points.astype("<i8").tobytes())
    elif isinstance(surface, ParametricSurface):
        content = {
            "formulas": surface.formulas,
            "parameters": {k: float(x) for k, x in sorted(surface.parameters.items())},
            "domain": surface.domain,
            "loops": [np.asarray(loop).tolist() for loop in surface.loops],
        }
        digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode())
    return ModelFacts(
        source=surface.name,
        sha256=None if digest is None else digest.hexdigest(),
        area=None if area is None else float(area),
        volume=None if volume is None else float(volume),
        euler=stated.get("euler"),
        crosses_itself=not stated.get("embedded", True),
    )
