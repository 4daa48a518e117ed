#include "intersection/cell_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/inverse_trigonometric.hpp"

namespace surfmesh {
namespace {

constexpr double PI = 3.141592653589793;
constexpr double SAMPLED = 2.0;          // times the largest second derivative of the samples
constexpr double ROUNDING = 1e-13;       // of the coordinates: boxes are so much wider
constexpr double LEAST_LENGTH = 1e-300;  // no length is less
constexpr std::size_t GRID = 4;          // samples each way of a cell
constexpr std::size_t CURVE_GRID = 5;
constexpr std::size_t CORNERS = 4;

Point3 absolute(Point3 p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }
Point3 smaller(Point3 a, Point3 b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Point3 larger(Point3 a, Point3 b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
Point3 unit(Point3 p) { return (1.0 / std::max(norm(p), LEAST_LENGTH)) * p; }

double known(double sag) {
    return std::isfinite(sag) ? sag : std::numeric_limits<double>::infinity();
}

/// |r_uu|, |r_uv|, |r_vv| over one cell, at most.
struct SecondDerivatives {
    Point3 uu, uv, vv;
};

/// From samples of each cell, where the surface has no bounds.
Array<SecondDerivatives> sampled_bends(SurfaceReader& surface,
                                       std::span<const ParameterBox> cells) {
    Array<Point2> uv;
    for (const auto& [low, high] : cells)
        for (std::size_t j = 0; j < GRID; ++j)
            for (std::size_t i = 0; i < GRID; ++i) {
                const double s = static_cast<double>(i) / (GRID - 1);
                const double t = static_cast<double>(j) / (GRID - 1);
                uv.push_back({low.x + s * (high.x - low.x), low.y + t * (high.y - low.y)});
            }
    surface.read(uv, 2);
    Array<SecondDerivatives> found;
    constexpr std::size_t EACH = GRID * GRID;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        SecondDerivatives bends{};
        for (std::size_t k = cell * EACH; k < (cell + 1) * EACH; ++k) {
            bends.uu = larger(bends.uu, absolute(surface[3][k]));
            bends.uv = larger(bends.uv, absolute(surface[4][k]));
            bends.vv = larger(bends.vv, absolute(surface[5][k]));
        }
        found.push_back({SAMPLED * bends.uu, SAMPLED * bends.uv, SAMPLED * bends.vv});
    }
    return found;
}

Array<SecondDerivatives> bends_of(SurfaceReader& surface, std::span<const ParameterBox> cells) {
    constexpr std::size_t EACH = derivative_count(2);
    Array<Point3> magnitudes(EACH * cells.size());
    if (!surface.read_magnitudes(cells, 2, magnitudes)) return sampled_bends(surface, cells);
    Array<SecondDerivatives> found;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const Point3* own = magnitudes.data() + cell * EACH;
        found.push_back({own[3], own[4], own[5]});
    }
    return found;
}

/// The cone of the normals of a cell, r_u and r_v being those in its middle.
struct Cone {
    Point3 axis;
    double angle;
};

Cone cone_of(Point3 r_u, Point3 r_v, Point2 width, const SecondDerivatives& bends) {
    const Point3 normal = cross(r_u, r_v);
    const double size = norm(normal);
    const double change_u = norm(0.5 * (width.x * bends.uu + width.y * bends.uv));
    const double change_v = norm(0.5 * (width.x * bends.uv + width.y * bends.vv));
    const double change = change_u * norm(r_v) + norm(r_u) * change_v + change_u * change_v;
    const Point3 axis = (1.0 / std::max(size, LEAST_LENGTH)) * normal;
    if (std::isnan(change)) return {axis, PI};
    const double part = change / std::max(size, LEAST_LENGTH);
    return {axis, size > 0.0 && part < 1.0 ? elementary::asin(part) : 0.5 * PI};
}

/// Put a cell with these corners into the row.
void add_box(CellBounds& bounds, std::span<const Point3> corners, Point3 sag) {
    Point3 low = corners[0], high = corners[0], size = absolute(corners[0]);
    for (const Point3& corner : corners) {
        low = smaller(low, corner);
        high = larger(high, corner);
        size = larger(size, absolute(corner));
        bounds.corners.push_back(corner);
    }
    // of the largest coordinate: a slab along a slanted axis adds up what all of them lose
    const double lost = ROUNDING * std::max({size.x, size.y, size.z});
    const Point3 wider{known(sag.x) + lost, known(sag.y) + lost, known(sag.z) + lost};
    bounds.sag.push_back(wider);
    bounds.low.push_back(low - wider);
    bounds.high.push_back(high + wider);
}

}  // namespace

CellBounds bound_cells(SurfaceReader& surface, std::span<const ParameterBox> cells) {
    CellBounds found{CORNERS, {}, {}, {}, {}, {}, {}};
    const Array<SecondDerivatives> bends = bends_of(surface, cells);
    Array<Point2> corners, middles;
    for (const auto& [low, high] : cells) {
        for (const Point2 corner : {low, Point2{high.x, low.y}, high, Point2{low.x, high.y}})
            corners.push_back(corner);
        middles.push_back(0.5 * (low + high));
    }
    surface.read(corners, 0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const SecondDerivatives& bent = bends[static_cast<std::ptrdiff_t>(i)];
        const Point2 width = cells[i].high - cells[i].low;
        const Point3 sag =
            (1.0 / 8.0) * (width.x * width.x * bent.uu + width.y * width.y * bent.vv);
        add_box(found, surface[0].subspan(CORNERS * i, CORNERS), sag);
    }
    surface.read(middles, 1);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Cone cone = cone_of(surface[1][i], surface[2][i], cells[i].high - cells[i].low,
                                  bends[static_cast<std::ptrdiff_t>(i)]);
        found.axis.push_back(cone.axis);
        found.angle.push_back(cone.angle);
    }
    return found;
}

namespace {

/// |c''| by the fraction over ranges, by coordinate; from samples where the curve has no bounds.
Array<Point3> curve_bends(const CurvePiece& piece, std::span<const ParameterRange> ranges) {
    const double rate = piece.last - piece.first;
    Array<ParameterRange> own;
    for (const auto& [first, last] : ranges)
        own.push_back({piece.first + first * rate, piece.first + last * rate});
    Array<Point3> magnitudes(3 * ranges.size()), found;
    if (piece.curve.derivative_magnitudes(own, 2, magnitudes)) {
        for (std::size_t i = 0; i < ranges.size(); ++i)
            found.push_back(rate * rate * magnitudes[static_cast<std::ptrdiff_t>(3 * i + 2)]);
        return found;
    }
    Array<double> t;
    for (const auto& [first, last] : own)
        for (std::size_t k = 0; k < CURVE_GRID; ++k)
            t.push_back(first + static_cast<double>(k) / (CURVE_GRID - 1) * (last - first));
    const CurveValues c(piece.curve, t, 2);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        double bound = 0.0;
        for (std::size_t k = i * CURVE_GRID; k < (i + 1) * CURVE_GRID; ++k)
            bound = std::max(bound, norm(c[2][k]));
        bound *= SAMPLED * rate * rate;
        found.push_back({bound, bound, bound});
    }
    return found;
}

}  // namespace

CellBounds bound_pieces(const CurvePiece& piece, std::span<const ParameterRange> ranges) {
    CellBounds found{2, {}, {}, {}, {}, {}, {}};
    const Array<Point3> bends = curve_bends(piece, ranges);
    const double rate = piece.last - piece.first;
    Array<double> ends, middles;
    for (const auto& [first, last] : ranges) {
        ends.push_back(piece.first + first * rate);
        ends.push_back(piece.first + last * rate);
        middles.push_back(piece.first + 0.5 * (first + last) * rate);
    }
    const CurveValues corner(piece.curve, ends, 0);
    const CurveValues middle(piece.curve, middles, 1);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const Point3 bent = bends[static_cast<std::ptrdiff_t>(i)];
        const double width = ranges[i].last - ranges[i].first;
        add_box(found, std::span<const Point3>(corner[0]).subspan(2 * i, 2),
                (width * width / 8.0) * bent);
        const Point3 way = rate * middle[1][i];
        const double part = 0.5 * width * norm(bent) / std::max(norm(way), LEAST_LENGTH);
        found.axis.push_back(unit(way));
        found.angle.push_back(part < 1.0 ? elementary::asin(part) : 0.5 * PI);
    }
    return found;
}

CellView view_of(const CellBounds& b) {
    const auto span = [](const auto& array) { return std::span(array.data(), array.size()); };
    return {span(b.low), span(b.high), span(b.corners),
            span(b.sag), span(b.axis), std::span<const double>(b.angle.data(), b.angle.size())};
}

namespace {

bool boxes_meet(const CellView& one, std::size_t i, const CellView& other, std::size_t j) {
    const Point3 &low = one.low[i], &high = one.high[i];
    const Point3 &low_2 = other.low[j], &high_2 = other.high[j];
    return low.x <= high_2.x && low_2.x <= high.x && low.y <= high_2.y && low_2.y <= high.y &&
           low.z <= high_2.z && low_2.z <= high.z;
}

/// Between which distances along an axis a cell lies.
struct Slab {
    double low, high;
};

Slab slab_of(const CellView& cells, std::size_t i, Point3 axis) {
    const std::size_t each = cells.corners.size() / cells.low.size();
    Slab slab{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t k = i * each; k < (i + 1) * each; ++k) {
        const double along = dot(cells.corners[k], axis);
        slab.low = std::min(slab.low, along);
        slab.high = std::max(slab.high, along);
    }
    const double room = dot(cells.sag[i], absolute(axis));
    return {slab.low - room, slab.high + room};
}

double angle_between_lines(Point3 a, Point3 b) {
    return elementary::acos(std::min(std::abs(dot(a, b)), 1.0));
}

}  // namespace

bool may_meet(const CellView& one, std::size_t i, const CellView& other, std::size_t j) {
    if (!boxes_meet(one, i, other, j)) return false;
    const Slab a = slab_of(one, i, other.axis[j]), b = slab_of(other, j, other.axis[j]);
    return !(a.low > b.high || b.low > a.high);  // not so where a sag is infinite
}

bool cross_surely(const CellView& one, std::size_t i, const CellView& other, std::size_t j) {
    return angle_between_lines(one.axis[i], other.axis[j]) > one.angle[i] + other.angle[j];
}

bool pierces_surely(const CellView& one, std::size_t i, const CellView& other, std::size_t j) {
    return angle_between_lines(one.axis[i], other.axis[j]) + one.angle[i] + other.angle[j] <
           0.5 * PI;
}

}  // namespace surfmesh
