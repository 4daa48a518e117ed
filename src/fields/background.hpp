// Look-up in the background: size tensors on a forest of quadtrees over a box of the plane.
//
// In: a point of the scaled plane. Out: the size tensor there, or the other fields of the nodes,
// bilinear in the leaf that contains the point; beyond the box those of its nearest point. The
// box is cut into nx by ny root cells, each the root of a quadtree. A leaf knows its four corner
// nodes:
//
//         2 --- 3         children in the same order:  2 3
//         |     |                                      0 1
//         0 --- 1
//
// A node stores A = H^-1 = M^(1/2), not H: at a pole the wanted length in (u, v) is infinite,
// while A goes to zero linearly and is interpolated without error. Where sizes are anisotropic it
// also stores W, the symmetric tensor in space for which |W d| is the length of a step d in wanted
// lengths: W = Id / h - (1 / h - 1 / long) t t^T, with `long` wanted along the tangent t.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

using Cell = std::int32_t;
using Node = std::int32_t;

struct BackgroundBox {
    double x0, y0;      // lower left corner
    double across, up;  // root cells per unit of x and of y
    double largest;     // size that no eigenvalue of H exceeds
};

struct RootGrid {
    std::int32_t nx, ny;
};

struct CellCorners {
    Node node[4];
};

/// What a node stores: A = H^-1, and 1 / h for the wanted length h in space (the shorter of two).
struct NodeSize {
    SizeTensor metric_root;
    double inverse_size;
};

/// Nodes of a leaf and their bilinear weights at a point.
struct LeafWeights {
    CellCorners corner;
    double w0, w1, w2, w3;

    template <class Value>
    [[nodiscard]] double mean(Value value) const {
        return w0 * value(corner.node[0]) + w1 * value(corner.node[1]) +
               w2 * value(corner.node[2]) + w3 * value(corner.node[3]);
    }
};

enum class BackgroundFault {
    none,
    box,      // not finite, or a scale that is not positive
    grid,     // not positive, or more root cells than cells
    child,    // children that do not exist or do not come after their parent
    corner,   // a node that does not exist
    root_3d,  // neither empty nor one for each node
};

struct Background {
    BackgroundBox box;
    RootGrid grid;
    Array<Cell> child;  // of the cells: first of four children, or -1 for a leaf
    Array<CellCorners> corner;
    Array<NodeSize> metric_root;        // of the nodes
    Array<MetricRoot3> metric_root_3d;  // of the nodes: W; empty where sizes are isotropic

    /// What would let a look-up leave the arrays or never end, if anything. ``at``: its place.
    struct Check {
        BackgroundFault fault;
        std::ptrdiff_t at;
    };
    [[nodiscard]] Check check() const;
    [[nodiscard]] bool is_anisotropic() const { return !metric_root_3d.empty(); }

    [[nodiscard]] LeafWeights leaf(double x, double y) const;
    [[nodiscard]] SizeTensor metric_root_at(double x, double y) const;
    [[nodiscard]] SizeTensor size_at(double x, double y) const;
    /// W; Id / h where sizes are isotropic.
    [[nodiscard]] MetricRoot3 metric_root_3d_at(double x, double y) const;
    /// The wanted edge length h in space, the shorter of two, from the interpolated 1 / h.
    [[nodiscard]] double scalar_size_at(double x, double y) const;
    /// The same where the leaf is known; W only where sizes are anisotropic.
    [[nodiscard]] double scalar_size(const LeafWeights& at) const;
    [[nodiscard]] MetricRoot3 metric_root_3d_of(const LeafWeights& at) const;
};

/// H = A^-1 with its eigenvalues capped at `largest` (those of A floored at 1 / largest).
[[nodiscard]] SizeTensor invert(SizeTensor a, double largest);

/// H, A, W or h at many points.
[[nodiscard]] Array<SizeTensor> sizes(const Background& b, std::span<const Point2> xy);
[[nodiscard]] Array<SizeTensor> metric_roots(const Background& b, std::span<const Point2> xy);
[[nodiscard]] Array<MetricRoot3> metric_roots_3d(const Background& b, std::span<const Point2> xy);
[[nodiscard]] Array<double> scalar_sizes(const Background& b, std::span<const Point2> xy);

/// Corner nodes and bilinear weights of the leaf at (x, y), or at the box's nearest point.
inline LeafWeights Background::leaf(double x, double y) const {
    // a coordinate that is not a number counts as 0
    double fx = std::min(std::max(0.0, (x - box.x0) * box.across), double(grid.nx));
    double fy = std::min(std::max(0.0, (y - box.y0) * box.up), double(grid.ny));
    const std::int32_t i = std::min(static_cast<std::int32_t>(fx), grid.nx - 1);
    const std::int32_t j = std::min(static_cast<std::int32_t>(fy), grid.ny - 1);
    fx -= i;
    fy -= j;
    Cell cell = j * grid.nx + i;
    for (Cell first = child[cell]; first >= 0; first = child[cell]) {
        fx *= 2.0;
        fy *= 2.0;
        if (fx >= 1.0) {
            fx -= 1.0;
            first += 1;
        }
        if (fy >= 1.0) {
            fy -= 1.0;
            first += 2;
        }
        cell = first;
    }
    const double w3 = fx * fy;
    const double w1 = fx - w3;
    const double w2 = fy - w3;
    return {corner[cell], 1.0 - fx - w2, w1, w2, w3};
}

inline SizeTensor Background::metric_root_at(double x, double y) const {
    const LeafWeights at = leaf(x, y);
    return {at.mean([&](Node n) { return metric_root[n].metric_root.xx; }),
            at.mean([&](Node n) { return metric_root[n].metric_root.xy; }),
            at.mean([&](Node n) { return metric_root[n].metric_root.yy; })};
}

inline SizeTensor Background::size_at(double x, double y) const {
    return invert(metric_root_at(x, y), box.largest);
}

inline MetricRoot3 Background::metric_root_3d_at(double x, double y) const {
    if (is_anisotropic()) return metric_root_3d_of(leaf(x, y));
    const double inverse = 1.0 / scalar_size_at(x, y);
    return {inverse, 0.0, 0.0, inverse, 0.0, inverse};
}

inline MetricRoot3 Background::metric_root_3d_of(const LeafWeights& at) const {
    const Array<MetricRoot3>& w = metric_root_3d;
    return {at.mean([&](Node n) { return w[n].xx; }), at.mean([&](Node n) { return w[n].xy; }),
            at.mean([&](Node n) { return w[n].xz; }), at.mean([&](Node n) { return w[n].yy; }),
            at.mean([&](Node n) { return w[n].yz; }), at.mean([&](Node n) { return w[n].zz; })};
}

inline double Background::scalar_size_at(double x, double y) const {
    return scalar_size(leaf(x, y));
}

inline double Background::scalar_size(const LeafWeights& at) const {
    return 1.0 / at.mean([&](Node n) { return metric_root[n].inverse_size; });
}

inline SizeTensor invert(SizeTensor a, double largest) {
    double det = determinant(a);
    const double trace = a.xx + a.yy;
    const double floor = 1.0 / largest;
    if (det <= floor * trace) {  // the smaller eigenvalue may lie below the floor
        const double mean = 0.5 * trace;
        const double difference = a.xx - a.yy;
        const double spread =
            std::sqrt(std::max(0.25 * (difference * difference) + a.xy * a.xy, 0.0));
        const double low = mean - spread;
        if (low < floor) {
            const double high = std::max(mean + spread, floor);
            SizeTensor p{1.0, 0.0, 0.0};
            if (spread > 0.0) {  // A = low Id + (high - low) P, P the projector on the larger
                const double s = 1.0 / (2.0 * spread);
                p = {(a.xx - low) * s, a.xy * s, (a.yy - low) * s};
            }
            a = {floor + (high - floor) * p.xx, (high - floor) * p.xy,
                 floor + (high - floor) * p.yy};
            det = determinant(a);
        }
    }
    return {a.yy / det, -a.xy / det, a.xx / det};
}

}  // namespace surfmesh
