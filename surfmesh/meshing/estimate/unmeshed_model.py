"""A CAD model before its first mesh: samples of its edges, its faces, what they are meshed from."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from surfmesh._core.edges import rows_of
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.meshing.edges.edge_nodes import cut_edges
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.meshing.edges.model_rules import with_model_rules
from surfmesh.meshing.estimate.face_counts import Alike
from surfmesh.meshing.estimate.model_estimate import Bends, FaceFields, model_counts, quick_bounds
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import edge_refinement
from surfmesh.meshing.faces.face_state import face_jobs, face_states
from surfmesh.meshing.finishing.balanced_rounds import widened_model
from surfmesh.sizing.options.model_sizing import model_sizing
from surfmesh.sizing.rules.size_limits import SizeLimits


class UnmeshedModel:
    """All that precedes the first mesh of a model, with its sizes."""

    def __init__(self, model: CadModel, sizing: Any, few: bool = False) -> None:
        """few: samples of edges, see ``sample_edges``, where sizes are the same all ways."""
        asked = model_sizing(model, sizing)
        asked = widened_model(asked) if asked.base.is_balanced else asked
        self.model = model
        self.wanted = with_model_rules(model, asked)
        few = few and not self.wanted.is_anisotropic
        self.samples = sample_edges(model, self.wanted, few)
        self.faces = face_states(model, self.samples, self.wanted)
        nodes = cut_edges(model, self.wanted.base, self.samples, {})
        sizings = [state.sizing for state in self.faces]
        self.bends = Bends.of(model, sizings)
        self.most = quick_bounds(model, nodes, sizings, self.bends)
        """Triangles (f,) of the faces at most, roughly."""
        self.nodes = nodes
        """Of the edges, as they are cut in the first round."""
        self._asked: dict[int, SizeLimits | None] = {}
        self._refined: dict[int, FaceJob] = {}

    @cached_property
    def jobs(self) -> list[FaceJob]:
        """What the faces are meshed from in the first round."""
        return face_jobs(self.model, self.faces, self.nodes)

    def refined(self, numbers: Sequence[int]) -> list[FaceJob]:
        """What some faces are meshed from in the second round, where sizes depend on the direction:
        long edges are cut again then, and many of them. Else in the first."""
        if not self.wanted.is_anisotropic:
            return [self.jobs[number] for number in numbers]
        new = sorted(set(numbers) - self._refined.keys())
        if new:
            limits = self._asked_around(new)
            nodes = cut_edges(self.model, self.wanted.base, self.samples, limits, self.nodes)
            made = face_jobs(self.model, [self.faces[k] for k in new], nodes, limits)
            self._refined.update(zip(new, made))
        return [self._refined[number] for number in numbers]

    @cached_property
    def alike(self) -> Alike:
        """Which faces are alike."""
        return Alike.among(self.jobs, model_arrays(self.model).area)

    def counts(self, fields: FaceFields) -> np.ndarray:
        """Triangles (f,) of the faces, by a closer look at some of them."""
        return model_counts(self.model, self.jobs, self.most, self.alike, self.refined, fields)

    def _asked_around(self, numbers: list[int]) -> dict[int, SizeLimits]:
        """What some faces and their neighbours ask of their edges, see ``edge_refinement``; where
        the first of alike ones asks for nothing none does."""
        arrays = model_arrays(self.model)
        edges = arrays.coedge_edge[rows_of(arrays.first_of_face, np.array(numbers))]
        near = np.unique(arrays.coedge_face[np.isin(arrays.coedge_edge, edges)]).tolist()
        leader = self.alike.leader.tolist()
        asking = [k for k in near if self._asked_by(leader[k]) is not None]
        asked = {number: self._asked_by(number) for number in asking}
        return {number: more for number, more in asked.items() if more is not None}

    def _asked_by(self, number: int) -> SizeLimits | None:
        if number not in self._asked:
            self._asked[number] = edge_refinement(self.jobs[number])
        return self._asked[number]
