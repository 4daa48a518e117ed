"""Sizes that follow from a model as a whole: from its volumes, and from gaps between its faces."""

from collections.abc import Mapping

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.meshing.edges.face_proximity import with_face_gaps
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.rules.volume_rule import with_volume_rule


def with_model_rules(
    model: CadModel, asked: ModelSizing, aims: Mapping[int, float] | None = None
) -> ModelSizing:
    """What is asked for, and the sizes that follow from it.

    aims: changes of volume by solid, see ``VolumeAims``.
    """
    return with_face_gaps(model, with_volume_rule(model, asked, aims))
