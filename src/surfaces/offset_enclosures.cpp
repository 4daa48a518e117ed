// Offset surfaces r + D n: points and second derivatives with all round-off, by boxes of the derivatives
// of the basis to the third order.
//
// Along a direction d = c n + t, with any number c, the second derivatives of n are
//
//     d . n_uu = t . n_uu - c n_u . n_u         as n . n_u = 0
//
// so that what is known of n_uu by coordinates counts by t, which is small along the normal. Across a
// knot where r_uu jumps by J, n_u jumps by the part of (J x r_v) / |N| across n.
#include <algorithm>
#include <cmath>

#include "surfaces/boxed_vectors.hpp"
#include "surfaces/offset_surface.hpp"
#include "surfaces/third_derivatives.hpp"

namespace surfmesh {
namespace {

using outward::add, outward::subtract, outward::multiply, outward::exactly;
using outward::dot, outward::cross;

constexpr double FRAME_ROUNDING = 0x1p-40;  // more than the frame is off a rotation, several times

double size_of(const BoxedVector& a) {
    return outward::magnitude(a.x) + outward::magnitude(a.y) + outward::magnitude(a.z);
}

/// Unit vectors at right angles, the last of them the normal, to rounding; the axes at a pole.
Directions frame_at(Point3 r_u, Point3 r_v) {
    constexpr Directions AXES = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    const Point3 N = surfmesh::cross(r_u, r_v);
    const double wide = norm(r_u), high = norm(N);
    if (!(wide > 0.0) || !(high > 0.0)) return AXES;
    const Point3 x = (1.0 / wide) * r_u, n = (1.0 / high) * N;
    const Point3 y = surfmesh::cross(n, x);
    // N of tangents that hardly differ may be anything
    const bool is_right_angled = std::abs(surfmesh::dot(n, x)) < 0x1p-46;
    return is_right_angled ? Directions{x, y, n} : AXES;
}

/// Directions by their coordinates in a frame.
Directions in_frame(const Directions& frame, const Directions& directions) {
    Directions found{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Point3& d = directions[k];
        found[k] = {surfmesh::dot(frame[0], d), surfmesh::dot(frame[1], d),
                    surfmesh::dot(frame[2], d)};
    }
    return found;
}

Interval twice(Interval x) { return {2.0 * x.lo, 2.0 * x.hi}; }
BoxedVector twice(const BoxedVector& a) { return {twice(a.x), twice(a.y), twice(a.z)}; }

constexpr Interval SHARE{0.0, 1.0};

Interval square_of(Interval x) { return outward::rounded(intervals::integer_power(x, 2)); }

/// What is left of a vector across the unit vector n, over a length: its x is
/// a_x (n_y^2 + n_z^2) - n_x (a_y n_y + a_z n_z), and so on.
BoxedVector across(const BoxedVector& a, const BoxedVector& n, Interval per_length) {
    const Interval x = square_of(n.x), y = square_of(n.y), z = square_of(n.z);
    const Interval along_x = multiply(a.x, n.x), along_y = multiply(a.y, n.y),
                   along_z = multiply(a.z, n.z);
    const auto left = [](Interval own, Interval share, Interval n_own, Interval others) {
        return subtract(multiply(own, outward::common(share, SHARE)), multiply(n_own, others));
    };
    return multiply(per_length, {left(a.x, add(y, z), n.x, add(along_y, along_z)),
                                 left(a.y, add(z, x), n.y, add(along_z, along_x)),
                                 left(a.z, add(x, y), n.z, add(along_x, along_y))});
}

/// N / |N| by its slopes p = N_x / N_z and q = N_y / N_z, where N_z is positive: (p, q, 1) over the
/// root of 1 + p^2 + q^2.
BoxedVector normal_by_slopes(const BoxedVector& N) {
    const Interval per_z = outward::reciprocal(N.z);
    const Interval p = multiply(N.x, per_z), q = multiply(N.y, per_z);
    const Interval whole = add(exactly(1.0), add(square_of(p), square_of(q)));
    const Interval root = outward::rounded(intervals::sqrt(whole));
    const Interval z = outward::common(outward::reciprocal(root), SHARE);
    return {multiply(p, z), multiply(q, z), z};
}

/// n = N / |N| with N = r_u x r_v.
struct UnitNormal {
    BoxedVector n;
    Interval per_length;  // 1 / |N|
};

/// False where N may vanish.
bool unit_normal(const BoxedVector& r_u, const BoxedVector& r_v, UnitNormal& out) {
    const BoxedVector N = cross(r_u, r_v);
    const Interval length = outward::length(N);
    if (!(length.lo > 0.0) || !(length.hi < intervals::INFINITE)) return false;
    out.per_length = outward::reciprocal(length);
    constexpr Interval UNIT{-1.0, 1.0};
    const BoxedVector n = N.z.lo > 0.0 ? normal_by_slopes(N) : multiply(out.per_length, N);
    out.n = {outward::common(n.x, UNIT), outward::common(n.y, UNIT), outward::common(n.z, UNIT)};
    return true;
}

/// The derivatives of n over a part of a cell.
struct NormalDerivatives {
    BoxedVector u, v, uu, uv, vv;
};

/// r: of the basis; the formulas of offset_surface.hpp.
NormalDerivatives normal_derivatives(const DerivativeBoxes& r, const UnitNormal& unit) {
    const auto& [n, per_length] = unit;
    const BoxedVector N_u = add(cross(r[3], r[2]), cross(r[1], r[4]));
    const BoxedVector N_v = add(cross(r[4], r[2]), cross(r[1], r[5]));
    const BoxedVector N_uu =
        add(add(cross(r[6], r[2]), twice(cross(r[3], r[4]))), cross(r[1], r[7]));
    const BoxedVector N_uv = add(add(cross(r[7], r[2]), cross(r[3], r[5])), cross(r[1], r[8]));
    const BoxedVector N_vv =
        add(add(cross(r[8], r[2]), twice(cross(r[4], r[5]))), cross(r[1], r[9]));
    const Interval s_u = dot(n, N_u), s_v = dot(n, N_v);
    NormalDerivatives found{};
    found.u = across(N_u, n, per_length);
    found.v = across(N_v, n, per_length);
    // s_uv n = (n_v . N_u + n . N_uv) n
    const auto second = [&](const BoxedVector& N_ij, const BoxedVector& n_i, const BoxedVector& n_j,
                            const BoxedVector& N_i, Interval s_i, Interval s_j) {
        const BoxedVector rest =
            add(add(multiply(s_i, n_j), multiply(s_j, n_i)), multiply(dot(n_j, N_i), n));
        return subtract(across(N_ij, n, per_length), multiply(per_length, rest));
    };
    found.uu = second(N_uu, found.u, found.u, N_u, s_u, s_u);
    found.uv = second(N_uv, found.u, found.v, N_u, s_u, s_v);
    found.vv = second(N_vv, found.v, found.v, N_v, s_v, s_v);
    return found;
}

/// A direction split by the normal in the middle.
struct SplitDirection {
    Point3 d;
    double c;
    BoxedVector t;

    SplitDirection(const Point3& direction, const BoxedVector& n) : d(direction) {
        const Point3 middle = {0.5 * (n.x.lo + n.x.hi), 0.5 * (n.y.lo + n.y.hi),
                               0.5 * (n.z.lo + n.z.hi)};
        c = surfmesh::dot(direction, middle);
        t = subtract(exactly(direction), multiply(exactly(c), n));
    }
    /// d . n_ij of a second derivative, with n_i . n_j.
    [[nodiscard]] Interval along_second(const BoxedVector& n_ij, Interval product) const {
        const Interval split = subtract(dot(t, n_ij), multiply(exactly(c), product));
        return outward::common(along(d, n_ij), split);
    }
};

Interval joined(Interval all, Interval more, bool is_first) {
    return is_first ? more : outward::hull(all, more);
}

/// One cell of an offset surface, of which the parts are taken one after the other.
class OffsetCell {
  public:
    /// directions: in the frame of the boxes.
    OffsetCell(const PartBoxes& parts, const Directions& directions, double distance)
        : parts_(parts), directions_(directions), distance_(distance) {}

    /// False where nothing is known.
    bool look_at_parts() {
        for (std::size_t i = 0; i < parts_.parts_u; ++i)
            for (std::size_t j = 0; j < parts_.parts_v; ++j) {
                UnitNormal unit{};
                const DerivativeBoxes& r = part(i, j);
                if (!unit_normal(r[1], r[2], unit)) return false;
                take_bends(r, unit, i + j == 0);
                if (parts_.jumps_u.data()[i] != 0)
                    take_jump(cross(subtract(r[3], part(i - 1, j)[3]), r[2]), unit, most_u_);
                if (parts_.jumps_v.data()[j] != 0)
                    take_jump(cross(r[1], subtract(r[5], part(i, j - 1)[5])), unit, most_v_);
            }
        add_up(parts_.jumps_u, most_u_, found_.jump_u);
        add_up(parts_.jumps_v, most_v_, found_.jump_v);
        return true;
    }
    [[nodiscard]] const Bends& found() const { return found_; }

  private:
    [[nodiscard]] const DerivativeBoxes& part(std::size_t i, std::size_t j) const {
        return parts_.boxes.data()[i * parts_.parts_v + j];
    }
    void take_bends(const DerivativeBoxes& r, const UnitNormal& unit, bool is_first) {
        const NormalDerivatives n = normal_derivatives(r, unit);
        const Interval uu = outward::square(n.u), uv = dot(n.u, n.v), vv = outward::square(n.v);
        const Interval squares = add(uu, vv);
        for (std::size_t k = 0; k < 3; ++k) {
            const SplitDirection split(directions_[k], unit.n);
            const auto bent = [&](const BoxedVector& r_ij, const BoxedVector& n_ij,
                                  Interval product) {
                const Interval found =
                    add(along(split.d, r_ij),
                        multiply(exactly(distance_), split.along_second(n_ij, product)));
                const double sizes =
                    size_of(r_ij) +
                    std::abs(distance_) * (size_of(n_ij) + outward::magnitude(squares));
                return add(found, {-FRAME_ROUNDING * sizes, FRAME_ROUNDING * sizes});
            };
            found_.uu[k] = joined(found_.uu[k], bent(r[3], n.uu, uu), is_first);
            found_.uv[k] = joined(found_.uv[k], bent(r[4], n.uv, uv), is_first);
            found_.vv[k] = joined(found_.vv[k], bent(r[5], n.vv, vv), is_first);
        }
    }
    /// Of N_u or N_v; the largest of all places along all creases.
    void take_jump(const BoxedVector& jump, const UnitNormal& unit, std::array<double, 3>& most) {
        const BoxedVector of_normal = across(jump, unit.n, unit.per_length);
        for (std::size_t k = 0; k < 3; ++k) {
            const Interval x = multiply(exactly(distance_), along(directions_[k], of_normal));
            const double off = FRAME_ROUNDING * std::abs(distance_) * size_of(of_normal);
            most[k] = std::max(most[k], outward::magnitude(x) + off);
        }
    }
    static void add_up(const Array<std::uint8_t>& creases, const std::array<double, 3>& most,
                       std::array<double, 3>& jump) {
        const auto count = static_cast<double>(std::count(creases.begin(), creases.end(), 1));
        for (std::size_t k = 0; k < 3; ++k) jump[k] = outward::above(count * most[k]);
    }

    const PartBoxes& parts_;
    const Directions& directions_;
    double distance_;
    Bends found_{};
    std::array<double, 3> most_u_{}, most_v_{};
};

/// r + D n, whose middle is the point.
EnclosedPoint point_of(const EnclosedPoint& r, const BoxedVector& n, double distance) {
    const auto of = [&](double x, Interval along_normal) {
        return add({outward::below(x - r.error), outward::above(x + r.error)},
                   multiply(exactly(distance), along_normal));
    };
    const std::array<Interval, 3> box = {of(r.value.x, n.x), of(r.value.y, n.y),
                                         of(r.value.z, n.z)};
    std::array<double, 3> middle{};
    double error = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (box[k].lo + box[k].hi);
        const double off = std::max(box[k].hi - middle[k], middle[k] - box[k].lo);
        error = std::max(error, outward::above(off));
    }
    if (!(error < intervals::INFINITE)) return {r.value, intervals::INFINITE};
    return {{middle[0], middle[1], middle[2]}, error};
}

}  // namespace

SurfaceStatus OffsetSurface::enclose(std::span<const Point2> uv,
                                     std::span<EnclosedPoint> out) const {
    const auto* third = dynamic_cast<const ThirdDerivatives*>(basis_.get());
    if (third == nullptr) return SurfaceStatus::UNKNOWN;
    if (const auto status = basis_->enclose(uv, out); status != SurfaceStatus::DONE) return status;
    for (std::size_t i = 0; i < uv.size(); ++i) {
        TangentBoxes tangents{};
        UnitNormal unit{};
        const bool is_known =
            third->enclose_tangents(uv[i], tangents) && unit_normal(tangents.u, tangents.v, unit);
        if (is_known)
            out[i] = point_of(out[i], unit.n, distance_);
        else
            out[i].error = intervals::INFINITE;
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus OffsetSurface::enclose_bends(std::span<const ParameterBox> cells,
                                           std::span<const Directions> directions,
                                           std::span<Bends> out) const {
    const auto* third = dynamic_cast<const ThirdDerivatives*>(basis_.get());
    if (third == nullptr) return SurfaceStatus::UNKNOWN;
    Array<Point2> middles;
    for (const auto& [low, high] : cells) middles.push_back(0.5 * (low + high));
    SurfaceValues middle;
    if (const auto status = middle.evaluate(*basis_, {middles.data(), middles.size()}, 1);
        status != SurfaceStatus::DONE)
        return status;
    PartBoxes parts;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        out[i] = UNBOUNDED_BENDS;
        const Directions frame = frame_at(middle[1][i], middle[2][i]);
        if (!third->enclose_third(cells[i], frame, parts)) continue;
        const Directions own = in_frame(frame, directions[i]);
        OffsetCell cell(parts, own, distance_);
        if (cell.look_at_parts()) out[i] = cell.found();
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
