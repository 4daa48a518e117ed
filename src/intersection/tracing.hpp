// Curves traced on two surfaces, from a start to the end that they come to.
//
//             T     p + h T        a step along the tangent T = n_A x n_B, pulled back onto both
//     p --->---- - - o             surfaces in the plane at right angles to it; shorter where the
//      \_____________p'            tangent turns by more than TURN, and where normals over its
//                                  cells may be parallel: another branch might pass there
//
// No search: what a curve ends at is known before, and looked for within the next step. Ends come
// in, the points of one branch go out; nothing changes.
#pragma once

#include <optional>

#include "intersection/cell_bounds.hpp"

namespace surfmesh {

/// A place on both surfaces where a branch starts or ends.
struct TraceEnd {
    Point2 uv_a, uv_b;
    Point3 point;
    Point3 way;     // unit direction into both faces
    bool singular;  // a branch point, or a pole of a surface, where no normal tells the way
};

/// Rates of (u, v) along the way of a start, where the surfaces do not say.
struct StartRates {
    std::optional<Point2> a, b;
};

struct TraceSettings {
    double step;  // the first, model units
    double gap;   // points so near to both surfaces are on both
    bool closed;  // the only end is the start, seen from the other side
};

/// The points of a branch, those of its start and end among them, and the number of its end.
struct TracedBranch {
    bool found;  // else the curve is lost after the last point
    std::size_t end;
    Array<Point3> points;
    Array<Point2> uv_a, uv_b;
};

TracedBranch trace_branch(MeetingSurfaces& surfaces, const TraceEnd& start, const StartRates& rates,
                          std::span<const TraceEnd> ends, const TraceSettings& settings);

/// A branch that is traced.
struct BranchView {
    std::span<const Point3> points;
    std::span<const Point2> uv_a, uv_b;
};

/// Which points, on both surfaces, lie on a branch, within ``tolerance``? 0 and 1.
Array<std::uint8_t> lie_on_branch(MeetingSurfaces& surfaces, const BranchView& branch,
                                  std::span<const Point3> points, double tolerance);

/// Unit r_u x r_v, zero where there is none, at (u, v) that were just read.
Point3 unit_normal(const SurfaceReader& surface, std::size_t row);

/// The rates of u and v along a tangent direction, at (u, v) that were just read.
Point2 rates_along(const SurfaceReader& surface, std::size_t row, Point3 way);

}  // namespace surfmesh
