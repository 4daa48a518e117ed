// What the corners of a triangle, or of the n^2 cells that it is cut into, say of R within.
//
//        o         g_k = R''(e_k, e_k) is linear between the corners of a cell but for rho / n^2,
//      o   o       R - L is that of the corners and the integrals of g_k over n^2 (smooth_bounds.hpp),
//    o   o   o     R' - L' is that of the corners and what third derivatives add.
//
// In: R with two derivatives at the corners of cells, rho. Out: how far R is from the triangle
// through r(u_i) at most, how fast that changes, and suprema of g_k. Nothing is changed.
#pragma once

#include <array>
#include <span>

#include "proof/place_jets.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Side k of a cell, from corner k on, runs along side k of the triangle, or against all three.
using CellCorners = std::array<const PlaceJet*, 3>;

/// Suprema over a cell; more: what g_k may be from linear.
SideBends bends_of_cell(const CellCorners& corner, const std::array<BySide, 3>& more,
                        bool with_slope);

/// Averaged as the integrals of smooth_bounds.hpp are, of one cell alone.
SideBends averaged_bends(const CellCorners& corner, const FourthParts& parts);

/// |n . (R - L)| over a triangle that is one cell, at a grid of places; rises: by
/// its suprema over the triangle (size_from); whole: no less than |R - L|.
double height_at_places(const CellCorners& corner, const FourthParts& parts,
                        const TriangleFrame& frame, double rises, double whole);

/// That and |R - L|.
PieceSize size_at_places(const CellCorners& corner, const FourthParts& parts,
                         const TriangleFrame& frame, const PieceSize& rises);

struct BoundsOfCells {
    SideBends bends;  // suprema
    PieceSize away;   // |n . (R - L)| and |R - L|
    double slope;     // the largest |(R' - L')(w)| for unit w
};

/// Where R - L is looked at within a cell: nowhere, which leaves it infinite, or at a grid of places.
enum class CellPlaces { NONE, FEW };

/// places: of the grid with n cells along a side. with_slope: else it is left infinite.
BoundsOfCells bounds_of_cells(std::span<const PlaceJet> places, std::size_t n,
                              const FourthParts& parts, const TriangleFrame& frame,
                              CellPlaces within, bool with_slope);

}  // namespace surfmesh
