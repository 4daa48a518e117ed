// A background from points of known size, over a plane whose metric is constant.
//
// The size at x is the smallest of h_k + slope |x - x_k| over the sources k, and the largest size
// allowed. Where a source can decide within a cell is told by one distance: with u_k = h_k +
// slope |c - x_k| for the centre c of the cell, r the radius of its circumcircle and m the least
// u_k, source k is below all others nowhere in the cell when
//
//     u_k - slope r  >  m + slope r
//
// So a cell hands on to its children the few sources that are left, and the sizes at the nodes
// of the leaves are exact: no more is looked at than can matter.
//
// Three passes: cells are split where the size changes, then where a neighbour is more than one
// level coarser, then the nodes are numbered and their sizes found.
//
//         2 --- 3         corners and children of a cell, as in fields/background.hpp;
//         |     |         places are in units of the smallest cell, 2^-DEEPEST of a root cell
//         0 --- 1
#pragma once

#include <span>

#include "fields/background.hpp"

namespace surfmesh {

inline constexpr int DEEPEST = 24;        // splits of a root cell at most: a place fits into
inline constexpr int MOST_IN_A_ROW = 64;  // 31 bits with so many root cells in a row

struct Sources {
    std::span<const Point2> place;
    std::span<const double> size;
    double e, f, g;  // the metric of the plane
    double slope;    // growth of the size per length
    double largest;  // size where no source decides
};

/// The root cells: lower left corner, width and height of one, and the box that is asked for.
struct RootCells {
    double x0, y0, wide, high;
    double x1, y1;  // upper right corner of the box
    std::int32_t nx, ny;
};

/// An estimate does with cells twice as rough, and with neighbours of any size.
enum class Fineness { for_mesh, for_estimate };

enum class TreeStatus {
    grown,
    too_many_cells  // more than were allowed: the background is empty
};

struct GrownTree {
    TreeStatus status;
    Background background;
};

/// `largest`: size in the plane above which none counts, of the background.
[[nodiscard]] GrownTree grow_tree(const Sources& sources, const RootCells& roots, double largest,
                                  std::int64_t most_cells, Fineness fineness);

}  // namespace surfmesh
