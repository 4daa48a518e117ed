"""Whose a rule is: the keys of a mapping of sizes by selection, found by what each asks for."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property

from surfmesh.cad.selection.selection import EVERYTHING
from surfmesh.meshing.edges.face_proximity import AcrossTo
from surfmesh.meshing.explain.size_row import SizeRow
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.rule import Rule
from surfmesh.sizing.rules.size_rules import Bound, stated_rules
from surfmesh.sizing.rules.source_rule import SourceRule

DEFAULT = "default"
"""The key of what nobody asked for."""


@dataclass(frozen=True)
class Askers:
    """All that ask for something at one place, the whole model first."""

    entries: tuple[tuple[str, Sizing], ...]
    """Keys and what they ask for, as it was written."""

    @classmethod
    def of(cls, wanted: ModelSizing, kind: str, number: int) -> Askers:
        """Of a face, an edge or a vertex; kind: "faces", "edges" or "vertices"."""
        entries = [(EVERYTHING, wanted.stated)]
        entries += [(entry.key, entry.sizing) for entry in wanted.entries_of(kind, number)]
        if kind == "faces":
            near = [s for s in wanted.of_face(number).sources if isinstance(s, AcrossTo)]
            entries += [("gap_faces", Sizing(sources=tuple(near)))] if near else []
        return cls(tuple(entries))

    def key_of(self, rule: Rule | Bound) -> str:
        """Who asks for a rule first."""
        stated = rule.stated_as if isinstance(rule, Rule) else rule
        if not rule.is_default:
            for key, every in self._asked:
                if stated in every:
                    return key
        return DEFAULT

    def not_in(self, applied: Collection[Rule | Bound]) -> Iterator[tuple[str, Rule | Bound]]:
        """What is asked for too, but goes no further than what applies."""
        for key, every in self._asked:
            yield from ((key, rule) for rule in every if rule not in applied)

    @cached_property
    def _asked(self) -> list[tuple[str, list[Rule | Bound]]]:
        return [(key, list(stated_rules(sizing))) for key, sizing in self.entries]


def words(rule: Rule | Bound) -> str:
    """Option and numbers."""
    if isinstance(rule, SourceRule) and isinstance(rule.source, AcrossTo):
        return repr(rule.source)
    return str(rule)


def bound_row(key: str, bound: Bound) -> SizeRow:
    return SizeRow(key, words(bound), bound.size, "min" if bound.is_floor else "max")
