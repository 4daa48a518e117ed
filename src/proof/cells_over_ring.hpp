// The cells of a piece of the surface, over a triangle and those around it: how high, both ways.
//
//      K   .---.               H(K, T') = max over corners |n' . (r - p')| + sag of K along n'
//        .'     `.
//     __o____o____o__          bound = max over K and T' of H(K, T') / cos d
//        T    T'
//
// In: a ring, and the points of a piece at the corners of its cells. Out: how far these lie from the
// ring, as closer_look.hpp has it; nothing where a cell may lie beyond the ring.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "proof/triangle_ring.hpp"
#include "surfaces/enclosure.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// A piece that is cut into side^2 cells.
struct PieceInCells {
    const TriangleBounds& bounds;
    std::span<const EnclosedPoint> points;  // in the order of for_grid
    std::size_t side;
    double rounded_uv;  // what the rounding of their places may move them by, relative
};

class CellsOverRing {
  public:
    explicit CellsOverRing(TriangleRing& ring) : ring_(ring) {}

    /// How far the cells of a piece are from the ring at most; infinite where that is not known.
    /// is_last: else it is left so where more cells are needed to come within the limit.
    double bound(const PieceInCells& piece, double limit, bool is_last);
    /// How far the curves over the rims of the triangle itself, with these corners, are from them:
    /// of the piece that a bound was found of last.
    [[nodiscard]] double farthest_at_rims(const SpaceCorners& p) const;

  private:
    static constexpr double ROUNDING = TriangleRing::ROUNDING;
    /// The corners of a cell, as rows of points.
    using GridCell = std::array<std::size_t, 3>;

    [[nodiscard]] double rounded() const { return (ROUNDING + rounded_uv_) * ring_.longest(); }
    /// How far a cell may reach beyond its corners, within a plane.
    [[nodiscard]] double grown() const { return scale_ * bounds_->cell_whole + rounded(); }
    /// How far it may rise over its corners, from a member's plane.
    [[nodiscard]] double sag(const Neighbour& member) const {
        return scale_ * (bounds_->cell_height + 2.0 * member.sine * bounds_->cell_whole);
    }
    /// Where the row of the grid begins.
    [[nodiscard]] std::size_t row(std::size_t i) const { return i * (side_ + 1) - i * (i - 1) / 2; }
    void take(const PieceInCells& piece);
    void measure(std::size_t m);
    [[nodiscard]] double highest_within() const;
    [[nodiscard]] double farthest_foot() const;
    [[nodiscard]] double highest() const;
    [[nodiscard]] double height_of(const GridCell& cell) const;
    [[nodiscard]] double beyond_rim(const Neighbour& member, std::size_t m, std::size_t s,
                                    const GridCell& cell, double grown, double beside) const;
    [[nodiscard]] double over_side(std::size_t m, double own, const GridCell& cell,
                                   double grown) const;

    TriangleRing& ring_;
    const TriangleBounds* bounds_ = nullptr;
    std::span<const EnclosedPoint> points_;
    std::size_t side_ = 0;
    double scale_ = 0.0;  // of a cell's area
    double rounded_uv_ = 0.0;
    double farthest_ = 0.0;  // how far a foot leaves the triangle
    Array<Point2> feet_;
    // of each member and point: height over its plane, distances inside its sides
    Array<double> height_;
    Array<std::array<double, 3>> inside_;
    Array<std::uint8_t> is_beyond_;  // bit s: so far beyond side s that no cell there lies over it
};

}  // namespace surfmesh
