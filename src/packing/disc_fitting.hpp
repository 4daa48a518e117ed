// Fitting a circle of a given radius to its neighbours in closed form (2.3.2, 2.3.3).
//
// Where the radius is drawn and not read from a field, no iteration is needed: in the plane a
// circle that touches two or three others is the root of a quadratic equation. The size tensor of
// a circle of radius r is 2 r Id.
#pragma once

#include "packing/packing_state.hpp"

namespace surfmesh {

struct Disc {
    Point2 centre;
    double r;
};

/// The disc of a vertex.
inline Disc disc_of(const Triangulation& t, Vertex v) { return {t.xy[v], 0.5 * t.size[v].xx}; }

/// Distance between the circles of a and b, negative where they overlap.
double gap_between(const Triangulation& t, Vertex a, Vertex b);

/// The circle of radius r that touches those of a and b, right of a -> b (2.3.2).
///
/// Where the gap between a and b is too wide for it the radius is raised.
Disc touch_two(const Triangulation& t, FrontEdge edge, double r);

/// The circle outside those of a, b and c that touches all three (Apollonius; 2.3.3).
///
/// Its radius is 0 when there is none.
Disc touch_three(const Triangulation& t, FrontEdge edge, Vertex c);

/// The one of three circles that a disc overlaps most, or NIL; w may be NIL.
Vertex overlapped_of(const Triangulation& t, Vertex u, Vertex v, Vertex w, Disc disc,
                     double tolerance);

/// The circle that a disc overlaps most (2.3.3, f_ij < 0), or NIL.
///
/// Looked at: the circles on the rim of the open cavity, and those behind the front as far as the
/// disc reaches through its edges. Overlaps with l = d / (r1 + r2) above 1 - ``tolerance`` do not
/// count, nor do the supports.
Vertex overlapped_around(Packing& p, FrontEdge edge, Disc disc, double tolerance);

}  // namespace surfmesh
