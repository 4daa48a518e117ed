"""Is it a CAD model? Asked without importing what only CAD models need."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing_extensions import TypeIs

    from surfmesh.cad.model.cad_model import CadModel


def is_cad_model(thing: Any) -> TypeIs[CadModel]:
    """A class that nobody has imported has no instances."""
    home = sys.modules.get("surfmesh.cad.model.cad_model")
    return home is not None and isinstance(thing, home.CadModel)
