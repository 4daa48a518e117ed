// Where the vertices of a planar triangulation lie in space, and how to measure there.
//
// Sizes and shapes are judged on the true surface: a step between two vertices is their chord in
// 3D, seen in the tangent plane of one of them in units of the wanted edge length,
//
//     y = B d,   B = I^(-1/2) J^T / h,   J = (r_x, r_y),   I = J^T J,
//
// so that a unit step is a unit edge. The way back is a step H y = h I^(-1/2) y in the plane, and
// h^2 B^T y in space.
//
// Where sizes are anisotropic the background gives W, and |W d| is the length of d. In the tangent
// plane, with the orthonormal frame Q = J I^(-1/2), it is the 2 x 2 tensor V = Q^T W Q, and
//
//     M = J^T W^2 J = G^T G,   G = V I^(1/2),   H = M^(-1/2),   B = H G^T V Q^T,
//
// so that B J = M^(1/2) is symmetric; the way back in space is J H y = B^T (B B^T)^-1 y.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "fields/background.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// B: the two rows that a chord is multiplied with.
struct TangentMap {
    Point3 x, y;
};

/// How fine the optimiser may make what the size field has left too coarse.
struct RefinementLimits {
    double least_size = 0.0;  // no h is scaled below it, no edge split into shorter halves
    std::size_t most_vertices = std::numeric_limits<std::size_t>::max();  // no edge is split beyond
};

/// Of each vertex; the arrays grow with the vertices.
struct SurfaceFrames {
    Array<Point3> point;             // r
    Array<TangentMap> tangent_map;   // B
    Array<Point3> normal;            // unit normal, zero at a degenerate point
    Array<double> size;              // wanted edge length h
    Array<double> scale;             // h over that of the size field, at most 1
    Array<double> drift;             // how far it has moved since its frame was set, unit lengths
    Array<MetricRoot3> metric_root;  // W; empty where sizes are isotropic
    bool is_anisotropic = false;     // do the sizes depend on the direction?
    RefinementLimits limits;

    SurfaceFrames() = default;
    /// room: for so many vertices, if that is more.
    SurfaceFrames(std::size_t vertices, bool anisotropic, std::size_t room = 0);

    /// Room for vertices up to number ``vertices``; a new one has scale 1 and no frame yet.
    void resize(std::size_t vertices);
};

/// r, r_x and r_y: a point of the surface, and its derivatives by the coordinates of the plane.
struct SurfacePoint {
    Point3 r, rx, ry;
};

/// Set the wanted length at v, and W where it depends on the direction, from the size field.
inline void set_size(const Triangulation& t, SurfaceFrames& s, const Background& background,
                     Vertex v) {
    const LeafWeights at = background.leaf(t.xy[v].x, t.xy[v].y);
    s.size[v] = s.scale[v] * background.scalar_size(at);
    if (!s.is_anisotropic) return;
    const MetricRoot3 w = background.metric_root_3d_of(at);
    const double by = s.scale[v];
    s.metric_root[v] = {w.xx / by, w.xy / by, w.xz / by, w.yy / by, w.yz / by, w.zz / by};
}

/// Set the frame of vertex v, whose size and W are set, and its size tensor to the exact H = h I^(-1/2).
///
/// Near a degenerate point the eigenvalues of I^(-1/2) are capped at ``largest``.
void set_frame(Triangulation& t, SurfaceFrames& s, Vertex v, const SurfacePoint& at,
               double largest);

/// The step in space, along the tangent plane of v, that looks like ``step`` there.
Point3 lift(const SurfaceFrames& s, Vertex v, Point2 step);

/// Scale the wanted lengths at v, not below the least size.
void shorten(SurfaceFrames& s, Vertex v, double factor);

/// alpha of abc in space, negative when it is turned over against the surface's normals.
///
/// Where sizes are anisotropic it is measured in the mean metric of the corners, and of the area
/// only what faces as the surface does counts: a triangle on its edge can have a fine shape.
double triangle_shape(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c);

/// Is alpha of abc, as ``triangle_shape`` gives it, less than ``least``, which is not negative?
bool is_shape_below(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c, double least);

/// About how far the triangle abc lies from a surface with these tangent planes.
///
/// For a quadric with rises w along the three edges the error of linear interpolation is
/// w / 4 in the middle of an edge and (w1 + w2 + w3) / 9 at the centroid. Where the rises seen
/// from the two ends differ, the curvature changes along the edge: the difference is added.
double triangle_deviation(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c);

/// A step d in space, seen in a unit tangent plane.
constexpr Point2 apply(const TangentMap& b, Point3 d) { return {dot(b.x, d), dot(b.y, d)}; }

/// The chord from v to p in the unit tangent plane of v.
inline Point2 chord(const SurfaceFrames& s, Vertex v, Vertex p) {
    return apply(s.tangent_map[v], s.point[p] - s.point[v]);
}

/// Length of the chord in units of the mean wanted size, in its direction, of its ends.
inline double edge_length(const SurfaceFrames& s, Vertex v, Vertex p) {
    const Point3 d = s.point[p] - s.point[v];
    if (!s.is_anisotropic) return 2.0 * norm(d) / (s.size[v] + s.size[p]);
    const double first = norm(apply(s.metric_root[v], d));
    const double second = norm(apply(s.metric_root[p], d));
    return 2.0 * first * second / std::max(first + second, 1e-300);
}

/// Is the edge longer than ``length``, as ``edge_length`` gives it? Squares tell, as a rule.
inline bool is_longer(const SurfaceFrames& s, Vertex v, Vertex p, double length) {
    constexpr double LESS = 1.0 - 1e-12, MORE = 1.0 + 1e-12;  // rounding does not count beyond
    const Point3 d = s.point[p] - s.point[v];
    if (s.is_anisotropic) {  // between the lengths that the two ends see
        const Point3 at_v = apply(s.metric_root[v], d), at_p = apply(s.metric_root[p], d);
        const double first = dot(at_v, at_v), second = dot(at_p, at_p), square = length * length;
        if (std::min(first, second) > MORE * square) return true;
        if (std::max(first, second) < LESS * square) return false;
    } else {
        const double half = 0.5 * length * (s.size[v] + s.size[p]), square = dot(d, d);
        if (square > MORE * (half * half)) return true;
        if (square < LESS * (half * half)) return false;
    }
    return edge_length(s, v, p) > length;
}

/// Height of p over the tangent plane of v: half the normal curvature times length^2.
inline double rise(const SurfaceFrames& s, Vertex v, Vertex p) {
    return dot(s.normal[v], s.point[p] - s.point[v]);
}

constexpr bool is_zero(Point3 a) { return a.x == 0.0 && a.y == 0.0 && a.z == 0.0; }

/// Are p and q one point in space, like the nodes of a side that is a pole?
inline bool coincide(const SurfaceFrames& s, Vertex p, Vertex q) {
    const Point3 a = s.point[p], b = s.point[q];
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Does the chord from v to p run as the edge in the plane does?
///
/// It does not when the edge goes round a closed surface and the chord takes the short cut.
/// Nothing can be said at a degenerate point.
bool follows(const Triangulation& t, const SurfaceFrames& s, Vertex v, Vertex p);

/// Do any two corners of triangle abc coincide? Then it is an edge in space.
inline bool is_collapsed(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c) {
    return coincide(s, a, b) || coincide(s, b, c) || coincide(s, c, a);
}

}  // namespace surfmesh
