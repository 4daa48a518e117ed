"""The figures that are wanted, and whether a measured one meets its own."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Wanted:
    """A bound for one figure. ``digits``: decimals shown; ``percent``: shown times 100."""

    title: str
    least: float | None = None
    most: float | None = None
    digits: int = 3
    percent: bool = False
    from_triangles: int = 0  # smaller meshes are not judged: a fixed share rules there

    def met(self, value: float | None) -> bool | None:
        """None when there is nothing to compare."""
        if value is None or (self.least is None and self.most is None):
            return None
        return (self.least is None or value >= self.least) and (
            self.most is None or value <= self.most
        )

    def shown(self, value: float | None) -> str:
        if value is None:
            return "-"
        scaled = 100.0 * value if self.percent else value
        return f"{scaled:,.{self.digits}f}" + (" %" if self.percent else "")

    @property
    def bound(self) -> str:
        if self.least is not None:
            return f">= {self.shown(self.least)}"
        return f"<= {self.shown(self.most)}" if self.most is not None else ""


MESH = {
    "triangles": Wanted("triangles", digits=0),
    "alpha_mean": Wanted("alpha in space, mean", least=0.98, digits=4),
    "alpha_p01": Wanted("alpha, 1 % are below", least=0.88),
    "alpha_min": Wanted("alpha, smallest", least=0.65),
    "quasi_unit_share": Wanted("quasi-unit edges", least=0.998, percent=True, digits=2),
    "inverted": Wanted("inverted triangles", most=0, digits=0),
    "folded": Wanted("folded triangles", most=0, digits=0),
    "deviation_over_chord": Wanted("largest deviation / chord", most=1.0),
    "above_chord": Wanted("triangles above chord", most=0, digits=0),
    "problems": Wanted("problems in the report", most=0, digits=0),
    "seconds_total": Wanted("seconds, formulas to checked mesh"),
    "triangles_a_second": Wanted("triangles a second", digits=0),
    "packing_triangles_a_second": Wanted(
        "packing alone, triangles a second", least=1e6, digits=0, from_triangles=50_000
    ),
    "bytes_a_triangle": Wanted(
        "peak memory, bytes a triangle", most=400, digits=0, from_triangles=50_000
    ),
}
"""What is wanted of every mesh."""

SPEED_AT = 100_000  # triangles at which the whole must be fast
SPEED = Wanted("triangles a second", least=150_000, digits=0)

EXPONENT = Wanted("time ~ triangles ^", most=1.05)

FIELD = {
    "largest": Wanted("size tensor, largest relative error", most=0.02, percent=True, digits=2),
    "p999": Wanted("size tensor, 99.9 % are below", most=0.02, percent=True, digits=2),
}
