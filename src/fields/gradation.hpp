// Gradation and accuracy of a size field on patches of nine nodes.
//
// In: cells of the background under construction, each a patch of nine nodes, and the sizes of
// the nodes. `grade` lowers the sizes until no two neighbours differ by more than the slope
// allows; `patch_errors` tells how far the sizes in a patch are from bilinear. Nodes are numbered
// row by row:
//
//         6 - 7 - 8
//         |   |   |       corners 0 2 6 8 are the cell's own;
//         3 - 4 - 5       the other five test it, and serve its children when it is split
//         |   |   |
//         0 - 1 - 2
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "fields/background.hpp"
#include "values/point.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

inline constexpr double ROUNDING = 1e-9;   // relative: a size is not lowered for less
inline constexpr double TURN_SLOPE = 3.0;  // how much faster than sizes a metric may change
                                           // because its direction turns

struct Patch {
    Node node[9];
};

/// The places of the corners of a patch, and in it those of its four children.
inline constexpr int CORNERS[4] = {0, 2, 6, 8};
inline constexpr int CORNERS_OF_CHILDREN[4][4] = {
    {0, 1, 3, 4}, {1, 2, 4, 5}, {3, 4, 6, 7}, {4, 5, 7, 8}};

/// Two nodes that are neighbours across a joint of two sides.
struct JoinedNodes {
    Node a, b;
};

/// Sizes of nodes under gradation. The middle four are empty where sizes are isotropic.
struct GradedSizes {
    std::span<double> size;          // lowered in place; at right angles to `along`
    std::span<double> longer;        // size along `along`; gradation may make it the shorter one
    std::span<const Point3> along;   // unit vector in the tangent plane
    std::span<const Point3> normal;  // unit, or zero where there is none: isotropic there
    std::span<const std::uint8_t> round;  // `longer` stays the longer one here; or empty
    std::span<const Point3> point;
    std::span<std::int32_t> changed;  // number of the last gradation that lowered the node
    double slope;                     // growth of the size per length
};

struct GradationDone {
    std::int64_t visits;  // nodes whose sizes have been spread, each time it was done
    Node last;            // the last of them, or NIL
    bool finished;        // or did the visits not suffice?
};

/// Lower the sizes until no two neighbours differ by more than the slope allows.
///
/// In the patches of nodes whose number is `number`, and from there as far as something changes:
/// the rest is graded already. Lowered nodes get the number. Sizes are spread from the smallest
/// on, as in Dijkstra's and the fast marching methods (Sethian 1999, chapter 8), so that most
/// nodes are visited once; what is lowered later is visited anew.
[[nodiscard]] GradationDone grade(std::span<const Patch> patches,
                                  std::span<const JoinedNodes> joined, const GradedSizes& sizes,
                                  std::int32_t number, std::int64_t most_visits);

struct PatchError {
    double error;   // largest relative error at the five test nodes
    double extent;  // width or height in metric length, whichever is larger
};

/// A = H^-1 at the nodes of a patch.
using PatchRoots = std::array<SizeTensor, 9>;

/// How far the field in a patch is from bilinear, and how many edges wide the patch is.
///
/// step: the patch's width and height; largest: size above which none counts.
[[nodiscard]] PatchError patch_error(const PatchRoots& metric_root, Point2 step, double largest);

}  // namespace surfmesh
