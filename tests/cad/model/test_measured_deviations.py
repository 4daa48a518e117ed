"""Deviations of edges from their faces: measured again only where something has changed."""

from dataclasses import replace

import cadquery as cq
import numpy as np

import surfmesh as sm
from surfmesh.cad.model import tolerances


def test_they_are_measured_anew_once_an_entry_is_another(monkeypatch):
    model = sm.from_cadquery(cq.Workplane().cylinder(3, 1))
    edges, vertices, faces = list(model.edges), list(model.vertices), list(model.faces)
    calls = []

    def counted(*lists):
        calls.append(len(lists))
        return deviations(*lists)

    deviations = tolerances.deviations
    monkeypatch.setattr(tolerances, "deviations", counted)
    measured = tolerances.Measured(edges, vertices, faces)
    first = measured.deviations()
    assert measured.deviations() is first and len(calls) == 1
    edges[0] = replace(edges[0], curve=edges[0].curve)
    for one, other in zip(measured.deviations(), first, strict=True):
        np.testing.assert_array_equal(one, other)
    assert len(calls) == 2
