#include "proof/vertex_star.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/sine_cosine.hpp"
#include "surfaces/interval.hpp"

namespace surfmesh {
namespace {

constexpr double ANGLE_OFF = 1e-6;  // more than angles and cosines of triangles of any use are off
constexpr double SLIVER = 1e-9;     // a triangle whose area is less, of its longest side's square
constexpr double HALF_TURN = 3.14159265358979;

double turn_of(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace

VertexStars::VertexStars(const MovedMesh& mesh) : mesh_(mesh), first_(mesh.points.size() + 1, 0) {
    for (const std::int32_t v : mesh.vertices) ++first_[v + 1];
    for (std::int32_t v = 0; v < count(); ++v) first_[v + 1] += first_[v];
    at_vertex_.resize(mesh.vertices.size());
    Array<std::int32_t> next(first_);
    for (std::size_t h = 0; h < mesh.vertices.size(); ++h)
        at_vertex_[next[mesh.vertices[h]]++] = static_cast<std::int32_t>(h / 3);
}

VertexStars::Member VertexStars::member_of(std::int32_t v, std::int32_t triangle) const {
    const auto corner = mesh_.vertices.subspan(3 * static_cast<std::size_t>(triangle), 3);
    const std::size_t k = corner[0] == v ? 0 : corner[1] == v ? 1 : 2;
    const std::int32_t a = corner[(k + 1) % 3], b = corner[(k + 2) % 3];
    const Point3 p = mesh_.points[static_cast<std::size_t>(v)],
                 to_a = mesh_.points[static_cast<std::size_t>(a)] - p,
                 to_b = mesh_.points[static_cast<std::size_t>(b)] - p;
    const Point3 n = cross(to_a, to_b);
    const double area = norm(n), longest = std::max({norm(to_a), norm(to_b), norm(to_b - to_a)});
    if (!(area > SLIVER * longest * longest)) return {a, b, triangle, {0.0, 0.0, 0.0}};
    return {a, b, triangle, (1.0 / area) * n};
}

/// One after the other round the vertex, each from a to b; false where they do not lie so.
bool VertexStars::put_in_order(std::int32_t v) {
    members_.clear();
    for (std::int32_t i = first_[v]; i < first_[v + 1]; ++i)
        members_.push_back(member_of(v, at_vertex_[i]));
    const auto count = static_cast<std::ptrdiff_t>(members_.size());
    const auto reversed = [](const Member& m) {
        return Member{m.b, m.a, m.triangle, -1.0 * m.normal};
    };
    // begin at a rim, if there is one: a corner of one triangle alone
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        int uses_of_a = 0, uses_of_b = 0;
        for (const Member& other : members_) {
            uses_of_a += members_[i].a == other.a || members_[i].a == other.b;
            uses_of_b += members_[i].b == other.a || members_[i].b == other.b;
        }
        if (uses_of_a > 2 || uses_of_b > 2) return false;
        if (uses_of_a > 1 && uses_of_b > 1) continue;
        std::swap(members_[0], members_[i]);
        if (uses_of_a > 1) members_[0] = reversed(members_[0]);
        break;
    }
    for (std::ptrdiff_t k = 0; k + 1 < count; ++k) {
        std::ptrdiff_t next = k + 1;
        while (next < count && members_[next].a != members_[k].b &&
               members_[next].b != members_[k].b)
            ++next;
        if (next == count) return false;
        std::swap(members_[k + 1], members_[next]);
        if (members_[k + 1].b == members_[k].b) members_[k + 1] = reversed(members_[k + 1]);
        if (members_[k + 1].a != members_[k].b) return false;
    }
    is_closed_ = count > 2 && members_[count - 1].b == members_[0].a;
    return true;
}

/// The sum of angles by which the star, seen along n, is not convex; infinite where its triangles
/// overlap as seen.
double VertexStars::turned_inwards(std::int32_t v, Point3 n) const {
    const Point3 p = mesh_.points[static_cast<std::size_t>(v)];
    const Point3 some = mesh_.points[static_cast<std::size_t>(members_[0].a)] - p;
    const Point3 across = cross(n, some), first = (1.0 / norm(across)) * across,
                 second = cross(n, first);
    const auto seen = [&](std::int32_t w) {
        const Point3 x = mesh_.points[static_cast<std::size_t>(w)] - p;
        return Point2{dot(first, x), dot(second, x)};
    };
    double around = 0.0, inwards = 0.0;
    const auto count = static_cast<std::ptrdiff_t>(members_.size());
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        const Point2 a = seen(members_[k].a), b = seen(members_[k].b);
        const double turn = turn_of(a, b);
        if (!(turn > ANGLE_OFF * SLIVER * norm(a) * norm(b))) return intervals::INFINITE;
        around += elementary::atan2(turn, dot(a, b));
        if (k + 1 == count && !is_closed_) break;
        const Point2 c = seen(members_[(k + 1) % count].b), in = b - a, out = c - b;
        const double bent = turn_of(in, out);
        if (bent < 0.0) inwards += elementary::atan2(-bent, dot(in, out));
    }
    if (is_closed_ && !(std::abs(around - 2.0 * HALF_TURN) < HALF_TURN)) return intervals::INFINITE;
    if (!is_closed_) {
        if (!(around < 2.0 * HALF_TURN - ANGLE_OFF)) return intervals::INFINITE;
        inwards += std::max(0.0, around - HALF_TURN);
    }
    return inwards + ANGLE_OFF;
}

/// Seen along n.
double VertexStars::change_along(std::int32_t v, Point3 n) const {
    const double inwards = turned_inwards(v, n);
    if (!(inwards < HALF_TURN)) return intervals::INFINITE;
    double most = 0.0;
    for (const Member& member : members_) {
        const double cosine = dot(n, member.normal) - ANGLE_OFF;
        if (!(cosine > 0.0)) return intervals::INFINITE;
        most = std::max(most, mesh_.slope[static_cast<std::size_t>(member.triangle)] / cosine);
    }
    const double straight = elementary::cos(0.5 * inwards) - ANGLE_OFF;
    return straight > 0.0 ? most / straight : intervals::INFINITE;
}

/// Nearer to the normal of the triangle that counts most as seen along n.
Point3 VertexStars::turned_to_worst(Point3 n) const {
    constexpr double PART = 0.25;
    double most = -1.0;
    Point3 worst = n;
    for (const Member& member : members_) {
        const double cosine = std::max(dot(n, member.normal), ANGLE_OFF);
        const double slope = mesh_.slope[static_cast<std::size_t>(member.triangle)] + ANGLE_OFF;
        if (slope / cosine > most) {
            most = slope / cosine;
            worst = member.normal;
        }
    }
    const Point3 turned = n + PART * worst;
    const double size = norm(turned);
    return size > 0.0 ? (1.0 / size) * turned : n;
}

double VertexStars::change(std::int32_t v) {
    constexpr double ENOUGH = 0.9;
    constexpr int TURNS = 16;
    if (first_[v] == first_[v + 1]) return 0.0;  // no triangle has it
    if (!put_in_order(v)) return intervals::INFINITE;
    Point3 sum{0.0, 0.0, 0.0};
    for (const Member& member : members_) sum = sum + member.normal;
    const double size = norm(sum);
    if (!(size > 0.0)) return intervals::INFINITE;
    Point3 n = (1.0 / size) * sum;
    double least = change_along(v, n);
    for (int turn = 0; turn < TURNS && !(least < ENOUGH); ++turn) {
        n = turned_to_worst(n);
        least = std::min(least, change_along(v, n));
    }
    return least;
}

}  // namespace surfmesh
