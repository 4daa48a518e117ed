#include "proof/curved_pieces.hpp"

#include <cmath>

#include "surfaces/fourth_derivatives.hpp"
#include "values/conventions.hpp"

namespace surfmesh {
namespace {

// of Newton's method, from the middle: to the nearest place, and to that of a node
constexpr int TO_NEAREST = 1, TO_NODE = 2;
constexpr double LEAST_JACOBIAN = 0.05;  // of that of the straight triangle
constexpr double THINNEST = 1e-10;       // whose Jacobian is more than round-off
constexpr int HALVINGS = 3;
constexpr std::size_t MIDDLES_TOGETHER = 1024;

/// The middle of one side, on its way.
struct Middle {
    std::size_t half_edge;
    Point2 start, step;  // of the side
    Point3 target;
    bool slides;
    Point2 place;
};

double turn(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

/// Is the Jacobian of psi positive everywhere? By its Bernstein coefficients.
bool is_regular(const PlanePiece& piece) {
    const Point2 a = piece.uv[1] - piece.uv[0], b = piece.uv[2] - piece.uv[1];
    const double straight = turn(a, b), least = LEAST_JACOBIAN * straight * straight;
    if (!(std::abs(straight) > THINNEST * norm(a) * norm(b))) return false;
    std::array<Point2, 3> first{}, second{};
    for (std::size_t m = 0; m < 3; ++m) {
        first[m] = piece.along(0, AT_CORNERS[m]);
        second[m] = piece.along(1, AT_CORNERS[m]);
    }
    for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t n = m; n < 3; ++n) {
            const double both = 0.5 * (turn(first[m], second[n]) + turn(first[n], second[m]));
            if (!(both * straight > least)) return false;
        }
    return true;
}

/// A step towards the target, within the plane that touches the surface.
void move(Middle& middle, Point3 r, Point3 r_u, Point3 r_v) {
    const Point3 way = middle.target - r;
    Point2 step;
    if (middle.slides) {
        const Point3 along = middle.step.x * r_u + middle.step.y * r_v;
        step = (dot(way, along) / dot(along, along)) * middle.step;
    } else {
        const double E = dot(r_u, r_u), F = dot(r_u, r_v), G = dot(r_v, r_v);
        const double x = dot(way, r_u), y = dot(way, r_v), area = E * G - F * F;
        step = {(G * x - F * y) / area, (E * y - F * x) / area};
    }
    middle.place = middle.place + step;
}

/// Do both triangles have the same parameters along their side?
bool are_joined(const FaceSides& face, std::size_t h, std::size_t twin) {
    const PlaneCorners &a = face.uv[h / 3], &b = face.uv[twin / 3];
    const Point2 start = a[h % 3], end = a[(h % 3 + 1) % 3];
    const Point2 from = b[twin % 3], to = b[(twin % 3 + 1) % 3];
    return start.x == to.x && start.y == to.y && end.x == from.x && end.y == from.y;
}

Middle middle_of(const FaceSides& face, std::span<const SpaceCorners> targets, std::size_t h) {
    const std::int32_t twin = face.twins[h];
    const bool slides = twin == NIL || !are_joined(face, h, static_cast<std::size_t>(twin));
    const PlaneCorners& uv = face.uv[h / 3];
    const Point2 start = uv[h % 3], step = uv[(h % 3 + 1) % 3] - start;
    const SpaceCorners& p = face.corners[h / 3];
    const Point3 target =
        targets.empty() ? 0.5 * (p[h % 3] + p[(h % 3 + 1) % 3]) : targets[h / 3][h % 3];
    return {h, start, step, target, slides, start + 0.5 * step};
}

/// Some middles at a time, that stay in the cache.
class MiddlePlaces {
  public:
    MiddlePlaces(const Surface& surface, int steps) : surface_(surface), steps_(steps) {}

    void add(const Middle& middle) { all_.push_back(middle); }
    void clear() { all_.clear(); }
    [[nodiscard]] std::size_t count() const { return all_.size(); }
    [[nodiscard]] std::span<const Middle> all() const { return {all_.data(), all_.size()}; }

    SurfaceStatus find() {
        uv_.resize(all_.size());
        for (int step = 0; step < steps_; ++step) {
            for (std::size_t i = 0; i < all_.size(); ++i) uv_.begin()[i] = all_.begin()[i].place;
            if (const auto status = values_.evaluate(surface_, {uv_.data(), uv_.size()}, 1);
                status != SurfaceStatus::DONE)
                return status;
            for (std::size_t i = 0; i < all_.size(); ++i)
                move(all_.begin()[i], values_[0][i], values_[1][i], values_[2][i]);
        }
        return SurfaceStatus::DONE;
    }

  private:
    const Surface& surface_;
    int steps_;  // of Newton's method
    Array<Middle> all_;
    Array<Point2> uv_;
    SurfaceValues values_;
};

/// Bends of both triangles at a side.
void place(const Middle& middle, const FaceSides& face, std::span<PlaneBends> bends) {
    const std::size_t h = middle.half_edge;
    const std::int32_t twin = face.twins[h];
    Point2 bend = middle.place - (middle.start + 0.5 * middle.step);
    if (!(std::abs(bend.x) + std::abs(bend.y) <= norm(middle.step))) bend = {0.0, 0.0};
    double part = 0.0;
    if (middle.slides) {
        const double length = dot(middle.step, middle.step);
        part = length > 0.0 ? dot(bend, middle.step) / length : 0.0;
        bend = part * middle.step;
    }
    bends[h / 3][h % 3] = bend;
    if (twin == NIL) return;
    const auto other = static_cast<std::size_t>(twin);
    if (middle.slides) {
        const bool run_alike = face.vertices[h] == face.vertices[other];
        const PlaneCorners& uv = face.uv[other / 3];
        const Point2 step = uv[(other % 3 + 1) % 3] - uv[other % 3];
        bend = (run_alike ? part : -part) * step;
    }
    bends[other / 3][other % 3] = bend;
}

void scale_sides(const FaceSides& face, std::size_t t, double factor, std::span<PlaneBends> bends) {
    for (std::size_t k = 0; k < 3; ++k) {
        bends[t][k] = factor * bends[t][k];
        const std::int32_t twin = face.twins[3 * t + k];
        if (twin == NIL) continue;
        const auto other = static_cast<std::size_t>(twin);
        if (other / 3 != t) bends[other / 3][other % 3] = factor * bends[other / 3][other % 3];
    }
}

/// Less bends where a Jacobian is not positive, and at last none.
void make_regular(const FaceSides& face, std::span<PlaneBends> bends) {
    Array<std::size_t> bad;
    for (int round = 0;; ++round) {
        bad.clear();
        for (std::size_t t = 0; t < bends.size(); ++t) {
            const PlanePiece piece{face.uv[t], bends[t]};
            if (!piece.is_straight() && !is_regular(piece)) bad.push_back(t);
        }
        if (bad.empty()) return;
        for (const std::size_t t : bad) scale_sides(face, t, round < HALVINGS ? 0.5 : 0.0, bends);
    }
}

}  // namespace

SurfaceStatus curved_pieces(const Surface& surface, const FaceSides& face,
                            std::span<const SpaceCorners> middles, Array<PlaneBends>& bends) {
    bends = Array<PlaneBends>(face.uv.size(), PlaneBends{});
    if (dynamic_cast<const FourthDerivatives*>(&surface) == nullptr) return SurfaceStatus::DONE;
    MiddlePlaces places(surface, middles.empty() ? TO_NEAREST : TO_NODE);
    for (std::size_t h = 0; h < face.twins.size(); ++h) {
        const std::int32_t twin = face.twins[h];
        if (twin == NIL || twin > static_cast<std::int32_t>(h))
            places.add(middle_of(face, middles, h));
        if (places.count() < MIDDLES_TOGETHER && h + 1 < face.twins.size()) continue;
        if (const auto status = places.find(); status != SurfaceStatus::DONE) return status;
        for (const Middle& middle : places.all()) place(middle, face, {bends.data(), bends.size()});
        places.clear();
    }
    make_regular(face, {bends.data(), bends.size()});
    return SurfaceStatus::DONE;
}

void straighten(const FaceSides& face, std::span<const std::uint8_t> is_bad,
                std::span<PlaneBends> bends) {
    for (std::size_t t = 0; t < bends.size(); ++t)
        if (is_bad[t] != 0) scale_sides(face, t, 0.0, bends);
    make_regular(face, bends);
}

}  // namespace surfmesh
