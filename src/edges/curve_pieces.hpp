// The curves of all edges, or of all coedges, of a model: pieces between two parameters each.
//
// A place on a piece is a fraction of its parameter range, 0 at its start and 1 at its end. Places
// come as one row: those of piece which[i] from first[i] to first[i + 1]. Nothing changes once it
// is made, so that threads share it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "surfaces/curve.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct CurvePieces {
    std::vector<std::shared_ptr<const Curve>> curves;  // empty for a piece that is a point
    Array<double> t0, t1;                              // parameters at the ends

    [[nodiscard]] std::size_t size() const { return curves.size(); }
};

/// Places on some pieces.
struct PiecePlaces {
    std::span<const std::int64_t> which;  // the pieces; each has a curve
    std::span<const std::int64_t> first;  // where the places of each begin, and how many there are
    std::span<const double> fraction;     // of the parameter range

    [[nodiscard]] std::size_t start(std::size_t i) const {
        return static_cast<std::size_t>(first[i]);
    }
    [[nodiscard]] std::size_t count(std::size_t i) const { return start(i + 1) - start(i); }
};

/// Pieces that one thread takes at a time.
inline constexpr std::size_t PIECES_AT_ONCE = 32;

/// Parameters of the places of one piece.
void parameters_of(const CurvePieces& pieces, const PiecePlaces& places, std::size_t i,
                   Array<double>& t);

/// Points on all pieces.
Array<Point3> points_on(const CurvePieces& pieces, const PiecePlaces& places);

}  // namespace surfmesh
