#include "fields/area_within_loops.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

namespace surfmesh {
namespace {

constexpr double NO_AREA = 1e-13;  // of a box: what is left of loops along its sides

// Where sizes change by a slope, meshes have so many times its cube more triangles than fit by
// area, up to a slope of STEEP, and none from TOO_STEEP on; as measured on planes.
constexpr double EXCESS = 1.5, STEEP = 0.45, TOO_STEEP = 0.5;

/// Loops with a direction: counter-clockwise around what is enclosed.
struct CutLoops {
    Array<Point2> corners;
    Array<std::int32_t> end;  // of the loops: after their last corner

    [[nodiscard]] std::span<const Point2> loop(std::size_t k) const {
        const auto at = static_cast<std::ptrdiff_t>(k);
        const std::int32_t begin = k == 0 ? 0 : end[at - 1];
        return {corners.data() + begin, static_cast<std::size_t>(end[at] - begin)};
    }
    void clear() {
        corners.clear();
        end.clear();
    }
    /// The loop of the corners behind the last end; without area there is none.
    void close(double least) {
        const auto begin = static_cast<std::size_t>(end.empty() ? 0 : end.back());
        const std::span<const Point2> last{corners.data() + begin, corners.size() - begin};
        if (std::abs(signed_area(last)) > least)
            end.push_back(static_cast<std::int32_t>(corners.size()));
        else
            corners.resize(begin);
    }
    static double signed_area(std::span<const Point2> corners) {
        double twice = 0.0;
        for (std::size_t i = 2; i < corners.size(); ++i) {
            const Point2 a = corners[i - 1] - corners[0], b = corners[i] - corners[0];
            twice += a.x * b.y - a.y * b.x;
        }
        return 0.5 * twice;
    }
    [[nodiscard]] double area() const {
        double total = 0.0;
        for (std::size_t k = 0; k < end.size(); ++k) total += signed_area(loop(k));
        return total;
    }
};

struct LoopBox {
    Point2 low, high;

    [[nodiscard]] double area() const { return (high.x - low.x) * (high.y - low.y); }
};

LoopBox box_of(std::span<const Point2> corners) {
    LoopBox box{corners[0], corners[0]};
    for (const Point2 p : corners) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
    return box;
}

/// Does a ray from p to the right cross the loop an odd number of times?
bool holds(std::span<const Point2> corners, Point2 p) {
    bool odd = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point2 a = corners[i], b = corners[i + 1 == corners.size() ? 0 : i + 1];
        if ((a.y > p.y) != (b.y > p.y)) odd ^= p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    }
    return odd;
}

/// In an even number of others counter-clockwise, else clockwise.
CutLoops directed(const PlaneLoops& loops) {
    CutLoops given;
    for (std::size_t k = 0; k + 1 < loops.first.size(); ++k) {
        for (std::int64_t i = loops.first[k]; i < loops.first[k + 1]; ++i)
            given.corners.push_back(loops.corners[static_cast<std::size_t>(i)]);
        given.close(0.0);
    }
    Array<LoopBox> boxes;
    for (std::size_t k = 0; k < given.end.size(); ++k) boxes.push_back(box_of(given.loop(k)));
    CutLoops made;
    for (std::size_t k = 0; k < given.end.size(); ++k) {
        const auto own = given.loop(k);
        const Point2 p = 0.5 * (own[0] + own[1]);  // loops may share corners
        bool around = CutLoops::signed_area(own) > 0.0;
        for (std::size_t other = 0; other < given.end.size(); ++other) {
            const auto& [low, high] = boxes[static_cast<std::ptrdiff_t>(other)];
            if (other == k || p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) continue;
            around ^= holds(given.loop(other), p);
        }
        for (std::size_t i = 0; i < own.size(); ++i)
            made.corners.push_back(around ? own[i] : own[own.size() - 1 - i]);
        made.close(0.0);
    }
    return made;
}

/// What lies below and above a height of one coordinate, after Sutherland and Hodgman.
struct Halves {
    CutLoops below, above;

    void cut(const CutLoops& loops, double Point2::* axis, double at, double least) {
        below.clear();
        above.clear();
        for (std::size_t k = 0; k < loops.end.size(); ++k) {
            const auto corners = loops.loop(k);
            Point2 p = corners.back();
            for (const Point2 q : corners) {
                if ((p.*axis < at && q.*axis > at) || (p.*axis > at && q.*axis < at)) {
                    Point2 cut = p + (at - p.*axis) / (q.*axis - p.*axis) * (q - p);
                    cut.*axis = at;
                    below.corners.push_back(cut);
                    above.corners.push_back(cut);
                }
                if (q.*axis <= at) below.corners.push_back(q);
                if (q.*axis >= at) above.corners.push_back(q);
                p = q;
            }
            below.close(least);
            above.close(least);
        }
    }
};

/// A cell with its box, or several root cells.
struct CellBlock {
    Cell first;           // lower left one
    std::int32_t nx, ny;  // root cells; 1 x 1 of a cell below
    LoopBox box;
};

class AreaSum {
  public:
    AreaSum(const Background& background, Between between) : b_(background), between_(between) {}

    /// Over what lies in the block and within the loops, which do not leave it.
    double within(const CellBlock& block, const CutLoops& loops, std::size_t depth = 0) {
        if (loops.end.empty()) return 0.0;
        if (std::abs(loops.area() - block.box.area()) <= NO_AREA * block.box.area())
            return whole(block);
        if (block.nx == 1 && block.ny == 1 && b_.child[block.first] < 0) return leaf(block, loops);
        double total = 0.0;
        const double least = NO_AREA * block.box.area();
        const CellParts parts = parts_of(block);
        if (depth == room_.size()) room_.emplace_back();
        auto& [sides, columns] = room_[depth];
        sides.cut(loops, &Point2::x, parts.middle.x, least);
        for (int side = 0; side < 2; ++side) {
            columns.cut(side == 0 ? sides.below : sides.above, &Point2::y, parts.middle.y, least);
            for (int up = 0; up < 2; ++up) {
                const CellBlock& part = parts.part[static_cast<std::size_t>(2 * up + side)];
                if (part.nx > 0 && part.ny > 0)
                    total += within(part, up == 0 ? columns.below : columns.above, depth + 1);
            }
        }
        return total;
    }

  private:
    /// Lower left, lower right, upper left, upper right; some are empty.
    struct CellParts {
        Point2 middle;
        std::array<CellBlock, 4> part;
    };

    [[nodiscard]] CellParts parts_of(const CellBlock& block) const {
        const auto& [low, high] = block.box;
        const bool is_cell = block.nx == 1 && block.ny == 1;
        const std::int32_t nx = is_cell ? 1 : (block.nx + 1) / 2;
        const std::int32_t ny = is_cell ? 1 : (block.ny + 1) / 2;
        const Point2 middle = is_cell ? 0.5 * (low + high)
                                      : Point2{nx == block.nx ? high.x : low.x + nx / b_.box.across,
                                               ny == block.ny ? high.y : low.y + ny / b_.box.up};
        CellParts parts{middle, {}};
        for (int k = 0; k < 4; ++k) {
            const bool right = k % 2 != 0, up = k / 2 != 0;
            CellBlock& part = parts.part[static_cast<std::size_t>(k)];
            part.box = {{right ? middle.x : low.x, up ? middle.y : low.y},
                        {right ? high.x : middle.x, up ? high.y : middle.y}};
            part.nx = right && !is_cell ? block.nx - nx : nx;
            part.ny = up && !is_cell ? block.ny - ny : ny;
            part.first = is_cell ? b_.child[block.first] + k
                                 : block.first + (right ? nx : 0) + (up ? ny * b_.grid.nx : 0);
        }
        return parts;
    }

    [[nodiscard]] double whole(const CellBlock& block) const {
        if (block.nx == 1 && block.ny == 1 && b_.child[block.first] < 0) {
            const double gauss = 0.5 - 0.5 / std::sqrt(3.0);
            double total = 0.0;
            for (int k = 0; k < 4; ++k)
                total +=
                    density(block, {k % 2 == 0 ? gauss : 1.0 - gauss, k < 2 ? gauss : 1.0 - gauss});
            return 0.25 * total * block.box.area();
        }
        double total = 0.0;
        for (const CellBlock& part : parts_of(block).part)
            if (part.nx > 0 && part.ny > 0) total += whole(part);
        return total;
    }

    /// Fans of triangles with a sign.
    [[nodiscard]] double leaf(const CellBlock& block, const CutLoops& loops) const {
        double total = 0.0;
        for (std::size_t k = 0; k < loops.end.size(); ++k) {
            const auto corners = loops.loop(k);
            for (std::size_t i = 2; i < corners.size(); ++i) {
                const Point2 a = corners[i - 1] - corners[0], b = corners[i] - corners[0];
                const double area = 0.5 * (a.x * b.y - a.y * b.x);
                if (area != 0.0)
                    total += area * mean_of(block, {corners[0], corners[i - 1], corners[i]});
            }
        }
        return total;
    }

    /// Of det A over a triangle in a leaf: Dunavant's six points, exact to degree four.
    [[nodiscard]] double mean_of(const CellBlock& block, const std::array<Point2, 3>& p) const {
        struct Orbit {
            double weight, at;
        };
        constexpr Orbit ORBITS[] = {{0.223381589678011, 0.445948490915965},
                                    {0.109951743655322, 0.091576213509771}};
        const auto& [low, high] = block.box;
        double total = 0.0;
        for (const auto& [weight, at] : ORBITS)
            for (std::size_t k = 0; k < 3; ++k) {
                const Point2 q = at * (p[(k + 1) % 3] + p[(k + 2) % 3]) + (1.0 - 2.0 * at) * p[k];
                const Point2 m = q - low;
                total += weight * density(block, {m.x / (high.x - low.x), m.y / (high.y - low.y)});
            }
        return total;
    }

    /// det A at a place of a leaf, both coordinates from 0 to 1.
    [[nodiscard]] double density(const CellBlock& block, Point2 at) const {
        const CellCorners& corner = b_.corner[block.first];
        const std::array<double, 4> weight{(1.0 - at.x) * (1.0 - at.y), at.x * (1.0 - at.y),
                                           (1.0 - at.x) * at.y, at.x * at.y};
        if (between_ == Between::sizes) return density_of_sizes(block, at, weight);
        SizeTensor a{0.0, 0.0, 0.0};
        for (std::size_t k = 0; k < 4; ++k)
            a = a + weight[k] * b_.metric_root[corner.node[k]].metric_root;
        return determinant(a);
    }

    /// 1 / h^2, and what meshes have more of where h changes with the place.
    [[nodiscard]] double density_of_sizes(const CellBlock& block, Point2 at,
                                          const std::array<double, 4>& weight) const {
        std::array<double, 4> h{};
        double size = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            h[k] = 1.0 / b_.metric_root[b_.corner[block.first].node[k]].inverse_size;
            size += weight[k] * h[k];
        }
        const auto& [low, high] = block.box;
        const double along = (1.0 - at.y) * (h[1] - h[0]) + at.y * (h[3] - h[2]);
        const double up = (1.0 - at.x) * (h[2] - h[0]) + at.x * (h[3] - h[1]);
        const Point2 rise{along / (high.x - low.x), up / (high.y - low.y)};
        const double slope = std::sqrt(rise.x * rise.x + rise.y * rise.y);
        const double gentle = std::clamp((TOO_STEEP - slope) / (TOO_STEEP - STEEP), 0.0, 1.0);
        return (1.0 + EXCESS * gentle * slope * slope * slope) / (size * size);
    }

    const Background& b_;
    Between between_;
    std::deque<std::array<Halves, 2>> room_;  // on the way down: to the sides, then up and down
};

}  // namespace

double metric_area_within(const Background& b, const PlaneLoops& loops, Between between) {
    const Point2 low{b.box.x0, b.box.y0};
    const Point2 high{low.x + b.grid.nx / b.box.across, low.y + b.grid.ny / b.box.up};
    CutLoops inside = directed(loops);
    Halves halves;
    for (double Point2::* axis : {&Point2::x, &Point2::y}) {
        halves.cut(inside, axis, low.*axis, 0.0);
        std::swap(inside, halves.above);
        halves.cut(inside, axis, high.*axis, 0.0);
        std::swap(inside, halves.below);
    }
    return AreaSum(b, between).within({0, b.grid.nx, b.grid.ny, {low, high}}, inside);
}

}  // namespace surfmesh
