// The chart of a surface, the scaled plane (x, y): u and v stretched so that speeds are about one.
//
// x is a function of u alone, and y of v: linear, or a monotone cubic on even knots. Where speeds
// have no bound (square roots) it is one of a bent parameter s instead, and u follows from s by an
// incomplete beta function on each piece between such places:
//
//     u  a----------|----------b    on each piece u is the integral of s^(q0 - 1) (1 - s)^(q1 - 1)
//     s  a----------|----------b
//
// Where an axis runs to an elongated pole it depends on the other coordinate too: pole_scaling.hpp.
//
// Charts are made in chart_making.hpp; here they are evaluated.
#pragma once

#include <optional>
#include <span>

#include "surfaces/pole_scaling.hpp"
#include "surfaces/surface.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// A piece of an axis between places of infinite speed, or ends of the axis.
struct BentPiece {
    double first, last;             // the same for u and s
    double q0, q1;                  // powers at its ends, 1 where the speed is finite
    double beta;                    // B(q0, q1)
    double clearance0, clearance1;  // fractions of it within which no rate is taken
};

/// A parameter or a coordinate, and its derivative.
struct ValueAndRate {
    double value, rate;
};

/// u at a bent parameter, from the nearer end of the piece, where digits count.
[[nodiscard]] double unbent(const Array<BentPiece>& pieces, double s);
/// du/ds at a bent parameter that is kept off the places.
[[nodiscard]] double rate_of_bending(const Array<BentPiece>& pieces, double s);

/// A monotone map from one scaled coordinate to its parameter.
struct ChartAxis {
    double extent = 0.0;
    Array<double> knots, slopes;  // parameter and derivative at even coordinates up to ``extent``
    Array<BentPiece> pieces;      // where knots are those of the bent parameter, else none

    /// Linear outside [0, extent], constant where the parameter is bent.
    [[nodiscard]] ValueAndRate parameter(double x) const;
    /// The scaled coordinate of a parameter, or of the bent one where there are ``pieces``; exact
    /// at the ends, and those beyond are moved to them.
    [[nodiscard]] double coordinate(double u) const;
};

/// (u, v), (du/dx, dv/dy), and (du/dy, dv/dx), zero but for scaled poles.
struct ChartPoint {
    Point2 uv, rates, crossed{0.0, 0.0};

    [[nodiscard]] bool is_crossed() const { return crossed.x != 0.0 || crossed.y != 0.0; }
    /// The direction in the plane of one in (u, v).
    [[nodiscard]] Point2 direction(Point2 uv) const {
        if (!is_crossed()) return {uv.x / rates.x, uv.y / rates.y};
        const double det = rates.x * rates.y - crossed.x * crossed.y;
        return {(rates.y * uv.x - crossed.x * uv.y) / det,
                (rates.x * uv.y - crossed.y * uv.x) / det};
    }
    /// r_x and r_y from r_u and r_v.
    [[nodiscard]] Point3 by_x(Point3 ru, Point3 rv) const {
        return is_crossed() ? rates.x * ru + crossed.y * rv : rates.x * ru;
    }
    [[nodiscard]] Point3 by_y(Point3 ru, Point3 rv) const {
        return is_crossed() ? crossed.x * ru + rates.y * rv : rates.y * rv;
    }
};

struct Chart {
    ChartAxis u, v;
    PoleScaling scaling{};

    [[nodiscard]] Point2 extent() const { return {u.extent, v.extent}; }
    [[nodiscard]] ChartPoint at(Point2 xy) const;
    [[nodiscard]] Point2 to_uv(Point2 xy) const { return at(xy).uv; }
    [[nodiscard]] Array<Point2> to_uv(std::span<const Point2> xy) const;
    /// A box that holds the parameters of a box of the plane.
    [[nodiscard]] ParameterBox to_box(Point2 low, Point2 high) const;
    /// The plane's point of (u, v), or of the bent parameters where there are some.
    [[nodiscard]] Point2 to_plane(Point2 uv) const;
    [[nodiscard]] Array<Point2> to_plane(std::span<const Point2> uv) const;
};

}  // namespace surfmesh
