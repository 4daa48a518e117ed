"""What is asked of bodies and faces that touch: sewing, imprinting, with their tolerances."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from surfmesh.errors import CadError
from surfmesh.truth_value import is_truth_value

if TYPE_CHECKING:
    from surfmesh.cad.parts import Part


@dataclass(frozen=True)
class Joining:
    """How parts become one model.

    imprint: bodies that touch share their faces; a number is how near touches, in units of the
    model. sew: loose faces whose edges are as near as this are joined; None joins none.
    """

    imprint: bool | float = False
    sew: float | None = None

    @classmethod
    def of(cls, imprint: Any, sew: Any) -> Self:
        """What a caller gave. Raises CadError for what is no tolerance."""
        if imprint is None or is_truth_value(imprint):
            imprint = bool(imprint)
        else:
            imprint = _tolerance("imprint", imprint, "True, False or a tolerance")
        return cls(imprint, None if sew is None else _tolerance("sew", sew, "a tolerance"))

    def __bool__(self) -> bool:
        return self.imprint is not False or self.sew is not None

    def applied(self, root: Part, millimetres: float) -> Part:
        """The tree sewn and imprinted; root: in place, in millimetres, of which a unit has so
        many. Raises CadError for what OCP cannot join."""
        if self.sew is not None:
            from surfmesh.cad.healing.sewing import sewn

            root = sewn(root, self.sew * millimetres)
        if self.imprint is not False:
            from surfmesh.cad.healing.imprinting import imprinted

            near = None if self.imprint is True else self.imprint * millimetres
            root = imprinted(root, near)
        return root


def _tolerance(name: str, value: Any, wanted: str) -> float:
    try:
        number = math.nan if is_truth_value(value) or isinstance(value, str) else float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not 0.0 < number < math.inf:
        raise CadError(f"{name} is {value!r:.40}: give {wanted} above 0, in units of the model")
    return number
