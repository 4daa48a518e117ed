// What the search for a size field starts from: its first cells, and cells at places of known size.
#pragma once

#include <span>

#include "fields/field_cells.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// How many root cells a face of a CAD model has, which is smooth between the knots of its splines.
[[nodiscard]] int root_cells_of_face(int pieces);

/// About so many cells, as near to squares as they can be: a cell keeps its shape when it is split,
/// long ones would have to become far too narrow. A narrow plane has a long row of them.
[[nodiscard]] RootGrid root_grid(Point2 extent, int cells);

/// Where cells are to be small enough for sizes (n,) that are known at places of the scaled plane.
/// Sizes are positive; there are root cells of a size that fill the plane.
[[nodiscard]] Array<SmallSource> small_sources(std::span<const Point2> places,
                                               std::span<const double> sizes, RootGrid grid,
                                               Point2 extent);

}  // namespace surfmesh
