#include "optimisation/surface_frames.hpp"

#include "values/first_touch.hpp"

namespace surfmesh {
namespace {

constexpr double CLEARLY = 1.0 + 1e-9;  // factor on a bound, beyond which rounding does not count
constexpr double STANDSTILL = 1e-300;   // a squared speed of 0, as at a pole that v^2 leads to
constexpr double DEGENERATE = 1e-10;    // |r_x x r_y| over |r_x|^2 + |r_y|^2: below, no normal

/// A 2 x 2 matrix by rows.
struct Matrix2 {
    double xx, xy, yx, yy;
};

/// V = Q^T W Q, with Q^T = h B.
SizeTensor tangential(const MetricRoot3& w, const TangentMap& b, double h) {
    const Point3 wx = apply(w, b.x), wy = apply(w, b.y);
    const double square = h * h;
    return {square * dot(b.x, wx), square * dot(b.y, wx), square * dot(b.y, wy)};
}

/// Make H and B of v anisotropic; they are isotropic, and ``j`` is I^(1/2).
void stretch(Triangulation& t, SurfaceFrames& s, Vertex v, SizeTensor j) {
    const double h = s.size[v];
    TangentMap& b = s.tangent_map[v];
    const SizeTensor q = tangential(s.metric_root[v], b, h);
    const Matrix2 g = {q.xx * j.xx + q.xy * j.xy, q.xx * j.xy + q.xy * j.yy,
                       q.xy * j.xx + q.yy * j.xy, q.xy * j.xy + q.yy * j.yy};
    // M^(1/2) = (M + d Id) / c, d = det M^(1/2); its inverse by Cramer's rule
    const double d = std::abs(g.xx * g.yy - g.xy * g.yx);
    const SizeTensor m = {g.xx * g.xx + g.yx * g.yx, g.xx * g.xy + g.yx * g.yy,
                          g.xy * g.xy + g.yy * g.yy};
    double c = std::sqrt(m.xx + m.yy + 2.0 * d);
    if (!(d > 0.0 && c > 0.0)) return;
    c = 1.0 / (c * d);
    const SizeTensor H = {c * (m.yy + d), -c * m.xy, c * (m.xx + d)};
    t.size[v] = H;
    // H G^T V, to be applied to Q^T
    const Matrix2 a = {H.xx * g.xx + H.xy * g.xy, H.xx * g.yx + H.xy * g.yy,
                       H.xy * g.xx + H.yy * g.xy, H.xy * g.yx + H.yy * g.yy};
    const Matrix2 to = {a.xx * q.xx + a.xy * q.xy, a.xx * q.xy + a.xy * q.yy,
                        a.yx * q.xx + a.yy * q.xy, a.yx * q.xy + a.yy * q.yy};
    const Point3 x = h * b.x, y = h * b.y;
    b.x = to.xx * x + to.xy * y;
    b.y = to.yx * x + to.yy * y;
}

/// The sum of the metrics of a, b and c.
MetricRoot3 sum_of_metrics(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c) {
    const MetricRoot3 &p = s.metric_root[a], &q = s.metric_root[b], &r = s.metric_root[c];
    return {p.xx + q.xx + r.xx, p.xy + q.xy + r.xy, p.xz + q.xz + r.xz,
            p.yy + q.yy + r.yy, p.yz + q.yz + r.yz, p.zz + q.zz + r.zz};
}

/// What alpha = sqrt(12 area_squared) / total of a triangle is made from.
struct ShapeParts {
    double area_squared;  // of twice the area
    double total;         // the sum of the squared edges
    double outward;       // along the normals at the corners
};

ShapeParts shape_parts(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c) {
    Point3 u = s.point[b] - s.point[a], v = s.point[c] - s.point[a];
    Point3 n = cross(u, v);
    const Point3 m = s.normal[a] + s.normal[b] + s.normal[c];
    const double outward = dot(n, m);
    if (s.is_anisotropic) {
        const MetricRoot3 sum = sum_of_metrics(s, a, b, c);
        u = apply(sum, u);
        v = apply(sum, v);
        n = cross(u, v);
        const double length = dot(m, m);
        if (length > 0.0) n = dot(n, m) / length * m;
    }
    return {dot(n, n), 2.0 * (dot(u, u) + dot(v, v) - dot(u, v)), outward};
}

}  // namespace

SurfaceFrames::SurfaceFrames(std::size_t vertices, bool anisotropic, std::size_t room)
    : is_anisotropic(anisotropic) {
    point = filled_by_threads(vertices, Point3{}, room);
    tangent_map = filled_by_threads(vertices, TangentMap{}, room);
    normal = filled_by_threads(vertices, Point3{}, room);
    size = filled_by_threads(vertices, 0.0, room);
    scale = filled_by_threads(vertices, 1.0, room);
    drift = filled_by_threads(vertices, 0.0, room);
    if (is_anisotropic) metric_root = filled_by_threads(vertices, MetricRoot3{}, room);
}

void SurfaceFrames::resize(std::size_t vertices) {
    point.resize(vertices);
    tangent_map.resize(vertices);
    normal.resize(vertices);
    size.resize(vertices);
    scale.resize(vertices, 1.0);
    drift.resize(vertices);
    if (is_anisotropic) metric_root.resize(vertices);
}

void set_frame(Triangulation& t, SurfaceFrames& s, Vertex v, const SurfacePoint& at,
               double largest) {
    const double h = s.size[v];
    double e = dot(at.rx, at.rx), g = dot(at.ry, at.ry);
    const double f = dot(at.rx, at.ry);
    const Point3 n = cross(at.rx, at.ry);
    const double area = norm(n);
    s.point[v] = at.r;
    s.drift[v] = 0.0;
    s.normal[v] = (area > DEGENERATE * (e + g) ? 1.0 / area : 0.0) * n;
    const double floor = (e + g) / (largest * largest) + STANDSTILL;
    e += floor;
    g += floor;
    // I^(-1/2) = (tr + 2 s)^(-1/2) (Id + s I^-1), s = sqrt(det I)
    const double det = std::max(e * g - f * f, floor * floor);
    const double root = std::max(std::sqrt(det), STANDSTILL);
    const double scale = 1.0 / std::sqrt(e + g + 2.0 * root);
    const SizeTensor m = {scale * (1.0 + g / root), -scale * f / root, scale * (1.0 + e / root)};
    t.size[v] = h * m;
    const auto over_h = [h](Point3 a) { return Point3{a.x / h, a.y / h, a.z / h}; };
    s.tangent_map[v] = {over_h(m.xx * at.rx + m.xy * at.ry), over_h(m.xy * at.rx + m.yy * at.ry)};
    if (!s.is_anisotropic) return;
    stretch(t, s, v, {scale * (e + root), scale * f, scale * (g + root)});
}

Point3 lift(const SurfaceFrames& s, Vertex v, Point2 step) {
    const TangentMap& b = s.tangent_map[v];
    if (!s.is_anisotropic) {
        step = s.size[v] * s.size[v] * step;
    } else {
        const double p = dot(b.x, b.x), q = dot(b.x, b.y), r = dot(b.y, b.y);
        const double d = p * r - q * q;
        if (!(d > 0.0)) return {0.0, 0.0, 0.0};
        step = {(r * step.x - q * step.y) / d, (p * step.y - q * step.x) / d};
    }
    return step.x * b.x + step.y * b.y;
}

void shorten(SurfaceFrames& s, Vertex v, double factor) {
    if (s.size[v] * factor < s.limits.least_size)
        factor = std::min(s.limits.least_size / s.size[v], 1.0);
    s.size[v] *= factor;
    s.scale[v] *= factor;
    if (!s.is_anisotropic) return;
    MetricRoot3& w = s.metric_root[v];
    w = {w.xx / factor, w.xy / factor, w.xz / factor, w.yy / factor, w.yz / factor, w.zz / factor};
}

double triangle_deviation(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c) {
    const Point3 p = s.point[a], q = s.point[b], r = s.point[c];
    const double ab = dot(s.normal[a], q - p), ba = dot(s.normal[b], p - q);  // as ``rise`` has it
    const double bc = dot(s.normal[b], r - q), cb = dot(s.normal[c], q - r);
    const double ca = dot(s.normal[c], p - r), ac = dot(s.normal[a], r - p);
    const double edges = std::max({std::abs(ab + ba) + 2.0 * std::abs(ab - ba),
                                   std::abs(bc + cb) + 2.0 * std::abs(bc - cb),
                                   std::abs(ca + ac) + 2.0 * std::abs(ca - ac)});
    const double unsure = std::abs(ab - ba) + std::abs(bc - cb) + std::abs(ca - ac);
    return std::max(edges / 8.0, (0.5 * std::abs(ab + ba + bc + cb + ca + ac) + unsure) / 9.0);
}

double triangle_shape(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c) {
    const ShapeParts parts = shape_parts(s, a, b, c);
    if (parts.total == 0.0) return 0.0;
    const double alpha = 3.4641016151377544 * std::sqrt(parts.area_squared) / parts.total;
    return parts.outward > 0.0 ? alpha : -alpha;
}

bool is_shape_below(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c, double least) {
    const ShapeParts parts = shape_parts(s, a, b, c);
    const double bound = CLEARLY * least * parts.total;
    if (parts.outward > 0.0 && 12.0 * parts.area_squared > bound * bound) return false;
    return triangle_shape(s, a, b, c) < least;  // near the bound, to the last bit
}

bool follows(const Triangulation& t, const SurfaceFrames& s, Vertex v, Vertex p) {
    if (is_zero(s.normal[p])) return true;
    const Point2 in_space = chord(s, v, p);
    const Point2 in_plane = solve(t.size[v], t.xy[p] - t.xy[v]);
    return dot(in_space, in_plane) > 0.0 &&
           dot(in_plane, in_plane) < 16.0 * dot(in_space, in_space);
}

}  // namespace surfmesh
