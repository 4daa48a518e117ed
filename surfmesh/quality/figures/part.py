"""A part of the report: a few figures on one subject."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Part:
    """In JSON its figures stand in the report itself, each by its own name."""
