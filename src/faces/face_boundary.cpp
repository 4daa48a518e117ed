#include "faces/face_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

/// What is thin by rounding alone is looked at closely too.
constexpr double ROUNDING = 1.0 + 1e-9;

/// Rising ends of parts of a row, each with ``least`` members at least.
bool are_ends(const Array<std::int32_t>& ends, std::size_t count, std::int64_t least) {
    std::int64_t before = 0;
    for (const std::int32_t end : ends) {
        if (end - before < least) return false;
        before = end;
    }
    return before == static_cast<std::int64_t>(count);
}

/// A coedge as rows of its boundary.
struct Piece {
    std::int32_t begin, end;
    [[nodiscard]] std::int32_t size() const { return end - begin; }
};

Piece piece_of(const FaceBoundary& b, std::int32_t k) { return {b.begin_of(k), b.piece_end[k]}; }

/// Are they one edge, run there and back in two places of (u, v)?
bool are_images(const FaceBoundary& b, Piece one, Piece other, Point2 extent) {
    const std::int32_t count = one.size();
    if (count != other.size()) return false;
    for (std::int32_t k = 0; k < count; ++k)
        if (b.numbers[one.end - 1 - k] != b.numbers[other.begin + k]) return false;
    for (std::int32_t k = 1; k < count - 1; ++k) {
        const Point2 way = b.uv[one.end - 1 - k] - b.uv[other.begin + k];
        if (!(std::abs(way.x) > APART * extent.x || std::abs(way.y) > APART * extent.y))
            return false;
    }
    return true;
}

/// Lengths in space of the ways from the nodes of one image to those of the other.
Array<double> ways(const Surface& surface, const FaceBoundary& b, Piece one, Piece other) {
    const std::int32_t count = one.size();
    Array<Point2> uv;
    uv.reserve(static_cast<std::size_t>(count * WAY_SAMPLES));
    for (std::int32_t k = 0; k < count; ++k) {
        const Point2 left = b.uv[one.end - 1 - k], right = b.uv[other.begin + k];
        for (int i = 0; i < WAY_SAMPLES; ++i)
            uv.push_back(left + i / (WAY_SAMPLES - 1.0) * (right - left));
    }
    SurfaceValues values;
    Array<double> lengths(static_cast<std::size_t>(count), 0.0);
    if (values.evaluate(surface, uv, 0) != SurfaceStatus::DONE) return lengths;
    for (std::int32_t k = 0; k < count; ++k)
        for (std::int32_t i = k * WAY_SAMPLES + 1; i < (k + 1) * WAY_SAMPLES; ++i)
            lengths[k] += norm(values[0][i] - values[0][i - 1]);
    return lengths;
}

/// Are two neighbouring levels of a seam thin: is the way round short beside the steps along it?
bool is_thin(const Surface& surface, const FaceBoundary& b, Piece one, Piece other) {
    const Array<double> round = ways(surface, b, one, other);
    const auto step = [&](std::int32_t k) {
        return norm(b.points[other.begin + k + 1] - b.points[other.begin + k]);
    };
    bool was_thin = false;
    for (std::int32_t k = 0; k < other.size(); ++k) {
        const double before = step(std::max(k - 1, 0)), after = step(std::min(k, other.size() - 2));
        const bool thin = round[k] < ROUNDING * FEWEST_STEPS * std::min(before, after);
        if (thin && was_thin) return true;
        was_thin = thin;
    }
    return false;
}

}  // namespace

BoundaryFault FaceBoundary::check() const {
    const std::size_t n = uv.size(), p = piece_end.size();
    if (numbers.size() != n || points.size() != n || sizes.size() != n || degenerate.size() != p ||
        tolerance.size() != p)
        return BoundaryFault::rows;
    if (!are_ends(piece_end, n, 2)) return BoundaryFault::pieces;
    if (!are_ends(loop_end, p, 1)) return BoundaryFault::loops;
    return BoundaryFault::none;
}

bool FaceBoundary::has_degenerate() const {
    return std::find(degenerate.begin(), degenerate.end(), 1) != degenerate.end();
}

PlaneBox FaceBoundary::box() const {
    if (uv.empty()) return {{0.0, 0.0}, {0.0, 0.0}};
    PlaneBox found{uv[0], uv[0]};
    for (const Point2 p : uv) {
        found.low = {std::min(found.low.x, p.x), std::min(found.low.y, p.y)};
        found.high = {std::max(found.high.x, p.x), std::max(found.high.y, p.y)};
    }
    return found;
}

FacePolygons polygons_of(const FaceBoundary& b) {
    FacePolygons found;
    std::int32_t piece = 0;
    for (const std::int32_t end : b.loop_end) {
        std::int32_t length = 0;
        for (; piece < end; ++piece) {
            const auto [first, after] = piece_of(b, piece);
            for (std::int32_t row = first; row < after - 1; ++row) {
                found.uv.push_back(b.uv[row]);
                found.numbers.push_back(b.numbers[row]);
                found.points.push_back(b.points[row]);
                found.slots.push_back(row);
            }
            length += after - 1 - first;
        }
        found.lengths.push_back(length);
    }
    return found;
}

bool may_have_tubes(const Surface& surface, const FaceBoundary& b) {
    if (b.has_degenerate()) return true;
    const ParameterBox domain = surface.domain();
    std::int32_t first = 0;
    for (const std::int32_t end : b.loop_end) {
        for (std::int32_t k = first; k < end; ++k)
            for (std::int32_t other = k + 1; other < end; ++other) {
                const Piece one = piece_of(b, k), two = piece_of(b, other);
                if (are_images(b, one, two, domain.high - domain.low) &&
                    is_thin(surface, b, one, two))
                    return true;
            }
        first = end;
    }
    return false;
}

Point3 extent_over(const Surface& surface, const ParameterBox& box) {
    constexpr double NOT_KNOWN = std::numeric_limits<double>::quiet_NaN();
    constexpr int STEPS = 16;  // along u; along v the ends do
    const double step = (box.high.x - box.low.x) / STEPS;
    Array<Point2> uv;
    for (const double v : {box.low.y, box.high.y})
        for (int k = 0; k <= STEPS; ++k)
            uv.push_back({k == STEPS ? box.high.x : k * step + box.low.x, v});
    SurfaceValues values;
    if (values.evaluate(surface, uv, 0) != SurfaceStatus::DONE)
        return {NOT_KNOWN, NOT_KNOWN, NOT_KNOWN};
    Point3 low = values[0][0], high = low;
    for (const Point3 p : values[0]) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return high - low;
}

}  // namespace surfmesh
