"""What a judge says."""

from typing import Any, NamedTuple


class Verdict(NamedTuple):
    faults: tuple[str, ...]
    """In words; none for a good mesh."""
    figures: dict[str, Any]
