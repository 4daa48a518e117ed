"""Sizes in the forms in which the verbs take them, and the options that are made of them.

A CAD model may have sizes by selection, which are resolved where its faces are known
(``model_sizing``); of everything else one ``Sizing`` is made here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from surfmesh.cad.model.is_cad_model import is_cad_model
from surfmesh.errors import SizingError
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.options.distance_size import default_options
from surfmesh.sizing.options.sizing import SizeLaw, Sizing, checked_order, require_known

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadModel

Sizes: TypeAlias = Sizing | float | SizeLaw | Mapping[str, Any] | None
"""What sizes may be given as: options, an edge length, options by name or by selection."""

_OF_LOAD = ("units", "imprint", "sew", "time_limit", "memory_limit", "isolate")


def sizes_by_name(sizing: Sizes, options: Mapping[str, Any], beside: Sequence[str] = ()) -> Sizes:
    """Sizes as they are given, or options of ``Sizing`` by name; ``SizingError`` for both.

    beside: what else the caller takes by name, which may have been meant.
    """
    if not options:
        return sizing
    for name in options:
        if name in _OF_LOAD:
            raise SizingError(f"{name} is an option of load: mesh(load(path, {name}=...))")
    if sizing is not None:
        raise SizingError(f"sizes are given twice: as sizing, and as {', '.join(options)}")
    require_known(options, beside)
    return Sizing.of(options)


def sizes_of_order(sizing: Sizes, order: int | None) -> tuple[Sizes, int]:
    """The sizes with the order that is asked for beside them, or with their own; and the order.

    Where no chord is asked for, sizes are those of straight triangles, whatever the order.
    """
    if isinstance(sizing, Mapping) and not _by_selection(sizing):
        sizing = Sizing.of(sizing)
    of_all = sizing.get("*") if isinstance(sizing, Mapping) else sizing
    own = _stated(of_all, "order")
    if order is None:
        order = 1 if own is None else own
    order = checked_order(order)
    every = sizing.values() if isinstance(sizing, Mapping) else [sizing]
    of_sizes = order if any(_stated(one, "chord") is not None for one in every) else 1
    if of_sizes == (own or 1):
        return sizing, order
    wanted = Sizing.of(of_all).replaced(order=of_sizes)
    return {**sizing, "*": wanted} if isinstance(sizing, Mapping) else wanted, order


def idle_options(sizing: Sizes, optimise: bool) -> list[str]:
    """A sentence for each option that has no effect on any part beside what else is asked for."""
    if isinstance(sizing, Mapping) and _by_selection(sizing):
        parts = [Sizing.of(one) for one in sizing.values()]
    else:
        parts = [Sizing.of(sizing)]
    found = []
    if not optimise and any(part.fewest for part in parts):
        found.append("fewest has no effect with optimise=False, as it moves vertices")
    stretched = [part for part in parts if part.anisotropy > 1.0]
    if stretched and all(part.is_of_size_alone for part in parts):
        found.append(
            f"anisotropy {stretched[0].anisotropy:g} has no effect with size alone, which holds in "
            "every direction: give a chord or an angle, with max_size"
        )
    return found


def _stated(sizing: Any, name: str) -> Any:
    """An option of sizes that may be given by name; None where it is not there."""
    if isinstance(sizing, Mapping):
        return sizing.get(name)
    return getattr(sizing, name) if isinstance(sizing, Sizing) else None


def sizes_for(model: Surface | CadModel, sizing: Sizes) -> Sizes:
    """One ``Sizing``, unless sizes of a CAD model are given by selection, by a law or not at all.

    Raises ``SizingError`` for an unknown option and for numbers that contradict.
    """
    if not is_cad_model(model):
        return _one_sizing(model, sizing)
    if isinstance(sizing, Mapping) and not _by_selection(sizing):
        return Sizing.of(sizing)
    return sizing


def _one_sizing(surface: Surface, sizing: Sizes) -> Sizing:
    """One set of options for the surface: those that it brings where none are given."""
    if sizing is None:
        sizing = default_options(surface) or None
    if isinstance(sizing, Mapping) and _by_selection(sizing):
        from surfmesh.sizing.options.model_sizing import sizes_of_one_face

        sizing = sizes_of_one_face(surface.name, sizing)
    made = Sizing.of(sizing)
    if made.volume is not None:
        raise SizingError(
            f"volume {made.volume:g}: volumes are kept of the closed solids of CAD models; of a "
            f"{type(surface).__name__} ask for a chord"
        )
    if made.gap is not None or made.gap_faces:
        _require_gaps(surface, made)
    return made


def _require_gaps(surface: Surface, sizing: Sizing) -> None:
    """Raise ``SizingError`` for triangles across gaps of a surface that is not searched for any."""
    from surfmesh.geometry.planar.planar_domain import PlanarDomain

    asked = "gap_faces" if sizing.gap_faces else f"gap {sizing.gap:g}"
    if sizing.gap_faces or not isinstance(surface, PlanarDomain):
        raise SizingError(
            f"{asked}: thin faces and gaps between faces are those of CAD models, gaps between "
            f"lines of planar domains too; of a {type(surface).__name__} ask for a size"
        )


def _by_selection(sizing: Mapping[str, Any]) -> bool:
    from surfmesh.sizing.options.model_sizing import is_by_selection

    return is_by_selection(sizing)
