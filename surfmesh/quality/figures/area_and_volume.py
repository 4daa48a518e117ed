"""Area and volume beside those of the model."""

from dataclasses import dataclass

from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.by_solid import relative_error
from surfmesh.quality.measures.measurements import Measurements


@dataclass(frozen=True, kw_only=True)
class AreaAndVolume(Part):
    """In model units. None: not known, or nothing is enclosed."""

    area: float
    area_exact: float | None
    area_error: float | None  # area / area_exact - 1
    volume: float | None  # of a mesh whose every edge is run along as often both ways
    volume_exact: float | None
    volume_error: float | None  # volume / volume_exact - 1

    @classmethod
    def of(cls, measured: Measurements) -> "AreaAndVolume":
        """Of the whole mesh."""
        area, volume = float(measured.shapes.area.sum()), measured.volume
        exact = measured.facts
        return cls(
            area=area,
            area_exact=exact.area,
            area_error=relative_error(area, exact.area),
            volume=volume,
            volume_exact=exact.volume,
            volume_error=relative_error(volume, exact.volume),
        )
