// The sizes of circles as the front asks for them: by the place, and where it helps by the direction.
//
// A triangle of the front has an edge, and with it, being equilateral in its metric, the directions
// of all three. In the metric the surface rises over its tangent plane by the quadric 4 y . B y, so
//
//     edges    |m + c|, |m - c / 2 + s|, |m - c / 2 - s|     B = (m + d  e; e  m - d)
//     centre   4/3 |m|                                       c = d cos 2a + e sin 2a
//                                                            s = sqrt 3 / 2 (e cos 2a - d sin 2a)
//
// are what it deviates by, with a the angle of the edge. B is the second form over eight chords, so
// that these are fractions of the chord (curvature_sizes.hpp has them for the worst angle). Sizes of
// a field hold for the worst direction, and with a reserve; in others they may grow until the
// deviation is what triangles shall use.
//
// In: a field, and at its nodes the quadric and how far it is the chord that decides. Out: sizes.
#pragma once

#include <algorithm>
#include <cmath>

#include "fields/background.hpp"

namespace surfmesh {

/// At a node of a field: the second form in the scaled plane over eight chords, and by how much the chord
/// decides its size: 0 where it does not, 1 where it does.
struct NodeBend {
    SizeTensor quadric;
    double decided;
};

/// What a unit triangle deviates by, one of its edges along ``way``, for B in the metric.
///
/// is_width: the width of the band that it needs, on one side of it or on both.
inline double deviation_along(SizeTensor b, Point2 way, bool is_width) {
    const double square = way.x * way.x + way.y * way.y;
    const double cosine = (way.x - way.y) * (way.x + way.y) / square;
    const double sine = 2.0 * way.x * way.y / square;
    const double m = 0.5 * (b.xx + b.yy), d = 0.5 * (b.xx - b.yy);
    const double c = d * cosine + b.xy * sine, centre = 4.0 / 3.0 * m;
    const double s = 0.86602540378443865 * (b.xy * cosine - d * sine);
    const double third = m - 0.5 * c, along = m + c;
    const double most = std::max({along, third + std::abs(s), centre, 0.0});
    const double least = std::min({along, third - std::abs(s), centre, 0.0});
    return is_width ? most - least : std::max(most, -least);
}

struct CircleSizes {
    const Background& background;
    std::span<const NodeBend> bend = {};  // of the background's nodes; none: no direction counts
    double used = 0.0;                    // fraction of the chord that triangles shall use
    double largest = 0.0;                 // size that none grows beyond
    bool is_width = false;                // see ``deviation_along``

    [[nodiscard]] SizeTensor at(Point2 p) const { return background.size_at(p.x, p.y); }
    /// The same for a triangle that has an edge along ``way``.
    [[nodiscard]] SizeTensor along(Point2 p, Point2 way) const {
        if (bend.empty()) return at(p);
        return grown(p, at(p), way);
    }

  private:
    [[nodiscard]] SizeTensor grown(Point2 p, SizeTensor h, Point2 way) const {
        const LeafWeights leaf = background.leaf(p.x, p.y);
        const double decided = leaf.mean([&](Node n) { return bend[n].decided; });
        if (!(decided > 0.0)) return h;
        const SizeTensor q{leaf.mean([&](Node n) { return bend[n].quadric.xx; }),
                           leaf.mean([&](Node n) { return bend[n].quadric.xy; }),
                           leaf.mean([&](Node n) { return bend[n].quadric.yy; })};
        const Point2 x = surfmesh::apply(h, {q.xx * h.xx + q.xy * h.xy, q.xy * h.xx + q.yy * h.xy});
        const Point2 y = surfmesh::apply(h, {q.xx * h.xy + q.xy * h.yy, q.xy * h.xy + q.yy * h.yy});
        const double deviation = deviation_along({x.x, x.y, y.y}, solve(h, way), is_width);
        if (!(deviation < used)) return h;
        const double gain = std::sqrt(1.0 + decided * (used / deviation - 1.0));
        return std::min(gain, most_gain(leaf)) * h;
    }
    [[nodiscard]] double most_gain(const LeafWeights& leaf) const {
        return std::max(1.0, largest / background.scalar_size(leaf));
    }
};

}  // namespace surfmesh
