// Symmetric 2 x 2 tensors of the plane: sizes H and metric roots A = H^-1.
#pragma once

#include "values/point.hpp"

namespace surfmesh {

struct SizeTensor {
    double xx, xy, yy;
};

constexpr SizeTensor operator+(SizeTensor p, SizeTensor q) {
    return {p.xx + q.xx, p.xy + q.xy, p.yy + q.yy};
}
constexpr SizeTensor operator*(double s, SizeTensor h) { return {s * h.xx, s * h.xy, s * h.yy}; }
constexpr double determinant(SizeTensor h) { return h.xx * h.yy - h.xy * h.xy; }

/// H d
constexpr Point2 apply(SizeTensor h, Point2 d) {
    return {h.xx * d.x + h.xy * d.y, h.xy * d.x + h.yy * d.y};
}

/// H^-1 d
constexpr Point2 solve(SizeTensor h, Point2 d) {
    const double det = determinant(h);
    return {(h.yy * d.x - h.xy * d.y) / det, (h.xx * d.y - h.xy * d.x) / det};
}

/// The symmetric tensor in space W for which |W d| is the length of a step in wanted lengths.
struct MetricRoot3 {
    double xx, xy, xz, yy, yz, zz;
};

constexpr Point3 apply(const MetricRoot3& w, Point3 d) {
    return {w.xx * d.x + w.xy * d.y + w.xz * d.z, w.xy * d.x + w.yy * d.y + w.yz * d.z,
            w.xz * d.x + w.yz * d.y + w.zz * d.z};
}

}  // namespace surfmesh
