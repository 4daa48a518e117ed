"""Circles moved to where they best touch all neighbours before they are placed: a slow twin.

It is not in the paper. Between two circles of the front there is seldom room for exactly one more:
one Gauss-Newton step on the sum of (l - 1)^2 over the neighbours shares the misfit.
"""

from surfmesh.reference.field_packing import OVERLAP, FieldPacking
from surfmesh.reference.plane_triangulation import NIL
from surfmesh.reference.size_tensors import common_step

NEIGHBOURS_WITHIN, TOUCHED_WITHIN = 1.4, 0.08  # l of neighbours; |l - 1| that is touch enough


class RelaxedPacking(FieldPacking):
    def try_at(self, a, b, p, h, reach):
        self.relaxes = reach == OVERLAP  # not the circles that touch three
        return super().try_at(a, b, p, h, reach)

    def place(self, a, b, cavity, p, h):
        better = self.relax_against_neighbours(cavity.rim, (a, b), p, h) if self.relaxes else None
        if better is not None and self.is_rim_visible(cavity.rim, better):
            p, h = better, self.size(better)
        return super().place(a, b, cavity, p, h)

    def relax_against_neighbours(self, rim, support, p, h):
        """A place that suits all neighbours; None where p does."""
        crowded = False
        row_x = row_y = right = 0j  # of the normal equations
        for v in (a for a, _ in rim if a != NIL):
            l, g = self.measure(p, h, v)
            if l < NEIGHBOURS_WITHIN:
                crowded = crowded or (v not in support and abs(l - 1.0) > TOUCHED_WITHIN)
                row_x, row_y, right = row_x + g.real * g, row_y + g.imag * g, right + (1.0 - l) * g
        move = common_step(row_x, right.real, row_y, right.imag, 1e-12) if crowded else None
        return None if move is None else p + move

    def is_rim_visible(self, rim, p):
        """May the cavity be filled from p? It sees the rim, and the hull stays convex."""
        hull = {}
        for a, b in rim:
            if NIL in (a, b):
                hull[b] = a  # it would run hull[NIL] -> p -> the other
                ghost = self.triangles[self.left[b, a]]  # the next one along the hull
                if self.in_circle(ghost, p, self.sizes[0]):
                    return False
            elif self.side(a, b, p) <= 0:
                return False
        last = next((b for b in hull if b != NIL), NIL)
        return not hull or self.side(last, hull[NIL], p) > 0
