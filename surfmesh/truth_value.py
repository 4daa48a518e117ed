"""What counts as True or False where an option is one: Python's and NumPy's, nothing else.

Anything has a truth in Python: "no", nan and [0] would all be taken as yes.
"""

import sys
from typing import Any, TypeGuard

from surfmesh.errors import SizingError, SurfmeshError, shown


def is_truth_value(value: Any) -> TypeGuard[bool]:
    """NumPy is not imported for that, as this comes before a file is read."""
    numpy = sys.modules.get("numpy")
    return isinstance(value, bool) or (numpy is not None and isinstance(value, numpy.bool_))


def truth_value(name: str, value: Any, error: type[SurfmeshError] = SizingError) -> bool:
    """``value`` as Python's own. Raises ``error`` that names the option."""
    if not is_truth_value(value):
        raise error(f"{name} is True or False, not {shown(value)}")
    return bool(value)
