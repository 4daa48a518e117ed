"""Two sizes at each place, along two directions at right angles, and how limits lower them.

     long, along ``along``        a limit holds in its own directions: either size is lowered
<------------------>              until the metric keeps to it, whichever by less
        ^ size
        v
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.sizing.rules.direction_rates import ROUND
from surfmesh.sizing.rules.rim_rule import RimSizes
from surfmesh.sizing.rules.rule import DirectedLimits


@dataclass
class TwoSizes:
    """At n places; ``size`` is the shorter one."""

    point: np.ndarray  # (n, 3)
    normal: np.ndarray  # (n, 3) unit, zero where it is not known
    along: np.ndarray  # (n, 3) unit tangent
    size: np.ndarray  # (n,) at right angles to ``along``
    long: np.ndarray  # (n,)
    anisotropy: float
    """Largest ratio of the two."""

    def copy(self) -> "TwoSizes":
        return TwoSizes(
            self.point, self.normal, self.along.copy(), self.size.copy(), self.long.copy(),
            self.anisotropy,
        )  # fmt: skip

    def chosen(self, rows: np.ndarray) -> "TwoSizes":
        return TwoSizes(
            self.point[rows], self.normal[rows], self.along[rows], self.size[rows],
            self.long[rows], self.anisotropy,
        )  # fmt: skip

    def lower_at(self, rows: np.ndarray, limits: DirectedLimits, least: float) -> None:
        """Lower the sizes at ``rows`` (k,), in place, to what limits there allow."""
        binding = np.flatnonzero(limits(self.point[rows]) < self.long[rows])
        if not len(binding):
            return
        limits, rows = limits.chosen(binding), rows[binding]
        if isinstance(limits, RimSizes):
            rows, limits = self._fit(rows, limits, least)
        lowered = self.chosen(rows).limited(limits, least)
        self.along[rows], self.size[rows], self.long[rows] = (
            lowered.along, lowered.size, lowered.long,
        )  # fmt: skip

    def _fit(self, rows: np.ndarray, rim: RimSizes, least: float) -> tuple[np.ndarray, RimSizes]:
        """Lower ``size`` or ``long``, in place, until the metric keeps to the rim at ``rows``.

        Whichever is lowered by less: a rim that runs slantwise says little of the long direction.
        Returns the rows (k,) where the metric is round and has no direction yet, and their rims.
        """
        size, long = self.size, self.long
        flat = long[rows] <= ROUND * size[rows]
        slant = np.flatnonzero(~flat)
        at = rows[slant]
        onward = np.einsum("ij,ij->i", rim.tangent[slant], self.along[at]) ** 2
        wanted = 1.0 / np.maximum(rim.sizes[slant], least) ** 2
        short_part, long_part = (1.0 - onward) / size[at] ** 2, onward / long[at] ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            factors = [
                np.sqrt(np.maximum(part / (wanted - other), 0.0))
                for part, other in ((short_part, long_part), (long_part, short_part))
            ]
        narrower, shorter = (np.where(np.isfinite(f), f, 0.0) for f in factors)
        narrower[wanted <= long_part] = shorter[wanted <= short_part] = 0.0
        beyond = short_part + long_part < wanted
        by_width = beyond & (narrower >= shorter)
        by_length = beyond & ~by_width
        size[at[by_width]] *= narrower[by_width]
        long[at[by_length]] = np.maximum(
            long[at[by_length]] * shorter[by_length], size[at[by_length]]
        )
        return rows[flat], rim.chosen(np.flatnonzero(flat))

    def limited(self, limits: DirectedLimits, least: float) -> "TwoSizes":
        """The same within limits, none of which goes below ``least``.

        Where the shorter size is lowered the shape of the metric is kept. Where the metric is
        round, or nearly so, the direction is that of the limits.
        """
        point, normal, along, size, long = (
            self.point, self.normal, self.along, self.size, self.long,
        )  # fmt: skip
        directions = np.stack([np.cross(normal, along), along])
        across, onward = np.maximum(limits.along(point, directions), least)
        factor = np.minimum(across, size) / size
        long_found = np.minimum(factor * long, onward)
        size_found = np.minimum(factor * size, long_found)
        flat = np.flatnonzero((long <= ROUND * size) & (normal != 0.0).any(axis=1))
        if len(flat):
            own = limits.chosen(flat)
            tight, direction = own.tightest(point[flat], normal[flat])
            crosswise = np.cross(normal[flat], direction)
            onward = np.maximum(own.along(point[flat], crosswise[None])[0], least)
            tight = np.maximum(tight, least)
            size_found[flat] = np.minimum(size[flat], tight)
            long_found[flat] = np.clip(
                np.minimum(size[flat], onward), size_found[flat], self.anisotropy * size_found[flat]
            )
            along = along.copy()
            along[flat] = crosswise
        return TwoSizes(point, normal, along, size_found, long_found, self.anisotropy)
