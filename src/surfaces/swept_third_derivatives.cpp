// Extrusions and surfaces of revolution: boxes of their derivatives to the third order, by those of
// their curves; with the two vectors of swept_enclosures.cpp for each direction:
//
//     d . r = d . (a . q) a + A cos u + B sin u      A = (d - (d . a) a) . q     B = (d x a) . q
#include <algorithm>

#include "surfaces/boxed_vectors.hpp"
#include "surfaces/swept_surfaces.hpp"
#include "surfaces/swept_waves.hpp"

namespace surfmesh {
namespace {

constexpr BoxedVector NOTHING{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};

/// The vectors that go with three directions.
struct AxisVectors {
    Directions a, b, along;

    AxisVectors(const Directions& directions, Point3 axis) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3& d = directions[k];
            along[k] = dot(d, axis) * axis;
            a[k] = d - along[k];
            b[k] = cross(d, axis);
        }
    }
};

/// Parts of one curve along the vectors, and by coordinates.
struct TurnedParts {
    CurveParts a, b, along, coordinates;

    bool enclose(const Curve& curve, Interval t, const AxisVectors& vectors, Point3 origin) {
        return curve.enclose_third(t, vectors.a, origin, a) &&
               curve.enclose_third(t, vectors.b, origin, b) &&
               curve.enclose_third(t, vectors.along, origin, along) &&
               curve.enclose_third(t, AXES, origin, coordinates);
    }
};

/// Of one part, turned by u.
DerivativeBoxes turned_boxes(const TurnedParts& parts, std::size_t part, Interval u) {
    const CurveBoxes &a = parts.a.boxes.data()[part], &b = parts.b.boxes.data()[part],
                     &along = parts.along.boxes.data()[part],
                     &size = parts.coordinates.boxes.data()[part];
    DerivativeBoxes boxes{};
    for (std::size_t l = 0; l < 4; ++l) {
        const double rounding = SWEPT_ROUNDING * outward::norm_1(size[l]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Interval A = outward::coordinate(a[l], axis), B = outward::coordinate(b[l], axis);
            const Interval turned = widened_by(wave_of(A, B, u), rounding);
            const Interval ahead =
                widened_by(wave_of(B, intervals::negative(A), u), rounding);  // its derivative
            for (std::size_t k = 0; k + l < 4; ++k) {
                Interval value = k % 2 == 0 ? turned : ahead;
                if (k >= 2) value = intervals::negative(value);
                if (k == 0) value = outward::add(value, outward::coordinate(along[l], axis));
                outward::coordinate(boxes[derivative_number(k, l)], axis) = value;
            }
        }
    }
    return boxes;
}

}  // namespace

bool ExtrusionSurface::enclose_third(const ParameterBox& cell, const Directions& directions,
                                     PartBoxes& out) const {
    CurveParts parts;
    if (!curve_->enclose_third({cell.low.x, cell.high.x}, directions, {0.0, 0.0, 0.0}, parts))
        return false;
    BoxedVector along{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        outward::coordinate(along, axis) =
            widened_by(outward::exactly(dot(directions[axis], direction_)),
                       SWEPT_ROUNDING * norm_1(directions[axis]));
    out.parts_u = parts.boxes.size();
    out.parts_v = 1;
    out.boxes.clear();
    for (const CurveBoxes& c : parts.boxes)
        out.boxes.push_back(
            {c[0], c[1], along, c[2], NOTHING, NOTHING, c[3], NOTHING, NOTHING, NOTHING});
    out.jumps_u = parts.jumps;
    out.jumps_v.clear();
    out.jumps_v.push_back(0);
    return true;
}

bool ExtrusionSurface::enclose_tangents(Point2 uv, TangentBoxes& out) const {
    out.v = outward::exactly(direction_);
    return curve_->enclose_tangent(uv.x, out.u);
}

bool RevolutionSurface::enclose_third(const ParameterBox& cell, const Directions& directions,
                                      PartBoxes& out) const {
    TurnedParts parts;
    const Interval v{cell.low.y, cell.high.y};
    if (!parts.enclose(*curve_, v, AxisVectors(directions, axis_), origin_)) return false;
    out.parts_u = 1;
    out.parts_v = parts.a.boxes.size();
    out.boxes.clear();
    for (std::size_t part = 0; part < out.parts_v; ++part)
        out.boxes.push_back(turned_boxes(parts, part, {cell.low.x, cell.high.x}));
    out.jumps_u.clear();
    out.jumps_u.push_back(0);
    out.jumps_v = parts.a.jumps;
    return true;
}

bool RevolutionSurface::enclose_tangents(Point2 uv, TangentBoxes& out) const {
    BoxedVector q{}, tangent{};
    if (!curve_->enclose_tangent(uv.y, tangent)) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CurveAlong c;
        if (!curve_->enclose_along({uv.y, uv.y}, AXES[axis], origin_, c)) return false;
        outward::coordinate(q, axis) = c[0];
    }
    const AxisVectors vectors(AXES, axis_);
    const Interval u{uv.x, uv.x};
    const double off_u = SWEPT_ROUNDING * outward::norm_1(q),
                 off_v = SWEPT_ROUNDING * outward::norm_1(tangent);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Point3 &a = vectors.a[axis], &b = vectors.b[axis];
        outward::coordinate(out.u, axis) =
            widened_by(wave_of(along(b, q), intervals::negative(along(a, q)), u), off_u);
        outward::coordinate(out.v, axis) =
            outward::add(along(vectors.along[axis], tangent),
                         widened_by(wave_of(along(a, tangent), along(b, tangent), u), off_v));
    }
    return true;
}

}  // namespace surfmesh
