"""Public names that have changed: the old ones hold for one release more, with a warning.

A class says so once for each name; ``Class(old=...)`` is accepted where its ``__init__`` passes
its keywords through ``new_names``::

    inverse_sizes = Renamed("metric_root_3d")
"""

import inspect
import warnings
from collections.abc import Mapping
from typing import Any


class Renamed:
    """The old name of an attribute: reading it warns and gives the new one."""

    def __init__(self, new: str) -> None:
        self.new, self.old = new, ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.old = name

    def __get__(self, instance: object, owner: type) -> Any:
        if instance is None:
            return self
        self.warn(owner, depth=3)
        return getattr(instance, self.new)

    def warn(self, owner: type, depth: int) -> None:
        """Say so to whoever called, ``depth`` calls up."""
        said = f"{owner.__name__}.{self.old} is called {self.new} now"
        warnings.warn(f"{said}; the old name goes with the next release", DeprecationWarning, depth)


def new_names(owner: type, given: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords that were given to ``owner``'s ``__init__``, by their names of today.

    Raises ``TypeError`` for one that is given by both its names.
    """
    found: dict[str, Any] = {}
    for name, value in given.items():
        known = inspect.getattr_static(owner, name, None)
        if isinstance(known, Renamed):
            known.warn(owner, depth=4)
            name = known.new
            if name in given:
                raise TypeError(f"{known.old} and {name} are the same: give {name} alone")
        found[name] = value
    return found
