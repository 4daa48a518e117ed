"""Units of length by name."""

from surfmesh.errors import CadError

MILLIMETRES = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1e3, "in": 25.4, "ft": 304.8}


def checked_unit(units: str | None) -> str:
    """The name of a unit that is known, "mm" for None; raises CadError for any other."""
    unit = "mm" if units is None else units
    if unit not in MILLIMETRES:
        raise CadError(f"the unit {units!r} is not known: use one of {', '.join(MILLIMETRES)}")
    return unit
