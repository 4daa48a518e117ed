// How far surfaces and curves bend over cells: boxes that hold them, cones that hold normals.
//
// Over a cell of the sides du, dv the surface differs from the bilinear patch through its corners
// by at most (du^2 |r_uu| + dv^2 |r_vv|) / 8, coordinate by coordinate (the error of linear
// interpolation, once a parameter); so the box of the corners, wider by that sag, holds it. A
// normal differs from that in the middle by at most |d_u||r_v| + |r_u||d_v| + |d_u||d_v|, d being
// how much r_u and r_v change. Surfaces without bounds of their second derivatives are sampled.
#pragma once

#include <span>

#include "intersection/common_points.hpp"

namespace surfmesh {

/// Of cells of a surface, or pieces of a curve. Each lies within ``sag`` of the hull of its
/// corners, and within low to high; its unit normals (directions of a curve) lie within ``angle``
/// of ``axis``: pi/2 and more where they may point anywhere.
struct CellBounds {
    std::size_t corners_each;  // 4; 2 of a curve
    Array<Point3> low, high, corners, sag, axis;
    Array<double> angle;
};

CellBounds bound_cells(SurfaceReader& surface, std::span<const ParameterBox> cells);

/// ranges: fractions of the piece.
CellBounds bound_pieces(const CurvePiece& piece, std::span<const ParameterRange> ranges);

/// Some cells, of which pairs name theirs by number.
struct CellView {
    std::span<const Point3> low, high, corners, sag, axis;
    std::span<const double> angle;
};
CellView view_of(const CellBounds& bounds);

/// May a cell i of the one and a cell j of the other meet? Their boxes do, and the slabs that
/// hold them along the normal of j: cells that hardly bend are thin.
[[nodiscard]] bool may_meet(const CellView& one, std::size_t i, const CellView& other,
                            std::size_t j);

/// Is no normal of cell i parallel to one of cell j?
[[nodiscard]] bool cross_surely(const CellView& one, std::size_t i, const CellView& other,
                                std::size_t j);

/// Is no direction of piece i at right angles to a normal of cell j?
[[nodiscard]] bool pierces_surely(const CellView& one, std::size_t i, const CellView& other,
                                  std::size_t j);

}  // namespace surfmesh
