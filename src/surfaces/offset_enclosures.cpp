// Offset surfaces r + D n: points and second derivatives with all round-off, by boxes of the derivatives
// of the basis to the third order (unit_vector_bounds.hpp).
//
// Across a knot where r_uu jumps by J, n_u jumps by the part of (J x r_v) / |N| across n.
#include <algorithm>
#include <cmath>

#include "surfaces/offset_surface.hpp"
#include "surfaces/third_derivatives.hpp"
#include "surfaces/unit_vector_bounds.hpp"

namespace surfmesh {
namespace {

using outward::add, outward::subtract, outward::multiply, outward::exactly;
using outward::dot, outward::cross;

Interval twice(Interval x) { return {2.0 * x.lo, 2.0 * x.hi}; }
BoxedVector twice(const BoxedVector& a) { return {twice(a.x), twice(a.y), twice(a.z)}; }

/// The derivatives of n over a part of a cell.
struct NormalDerivatives {
    BoxedVector u, v, uu, uv, vv;
};

/// r: of the basis; N = r_u x r_v.
NormalDerivatives normal_derivatives(const DerivativeBoxes& r, const UnitVector& unit) {
    const BoxedVector N_u = add(cross(r[3], r[2]), cross(r[1], r[4]));
    const BoxedVector N_v = add(cross(r[4], r[2]), cross(r[1], r[5]));
    const BoxedVector N_uu =
        add(add(cross(r[6], r[2]), twice(cross(r[3], r[4]))), cross(r[1], r[7]));
    const BoxedVector N_uv = add(add(cross(r[7], r[2]), cross(r[3], r[5])), cross(r[1], r[8]));
    const BoxedVector N_vv =
        add(add(cross(r[8], r[2]), twice(cross(r[4], r[5]))), cross(r[1], r[9]));
    const FirstOfVector u{N_u, unit.first(N_u)}, v{N_v, unit.first(N_v)};
    return {u.n, v.n, unit.second(N_uu, u, u), unit.second(N_uv, u, v), unit.second(N_vv, v, v)};
}

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
                UnitVector unit{};
                const DerivativeBoxes& r = part(i, j);
                if (!bound_unit_vector(cross(r[1], r[2]), unit)) return false;
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
    void take_bends(const DerivativeBoxes& r, const UnitVector& unit, bool is_first) {
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
                    outward::norm_1(r_ij) +
                    std::abs(distance_) * (outward::norm_1(n_ij) + outward::magnitude(squares));
                return add(found, {-FRAME_ROUNDING * sizes, FRAME_ROUNDING * sizes});
            };
            found_.uu[k] = joined(found_.uu[k], bent(r[3], n.uu, uu), is_first);
            found_.uv[k] = joined(found_.uv[k], bent(r[4], n.uv, uv), is_first);
            found_.vv[k] = joined(found_.vv[k], bent(r[5], n.vv, vv), is_first);
        }
    }
    /// Of N_u or N_v; the largest of all places along all creases.
    void take_jump(const BoxedVector& jump, const UnitVector& unit, std::array<double, 3>& most) {
        const BoxedVector of_normal = across(jump, unit.n, unit.per_length);
        for (std::size_t k = 0; k < 3; ++k) {
            const Interval x = multiply(exactly(distance_), along(directions_[k], of_normal));
            const double off = FRAME_ROUNDING * std::abs(distance_) * outward::norm_1(of_normal);
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
        UnitVector unit{};
        const bool is_known = third->enclose_tangents(uv[i], tangents) &&
                              bound_unit_vector(cross(tangents.u, tangents.v), unit);
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
    if (const auto status = middle.evaluate(*basis_, middles, 1); status != SurfaceStatus::DONE)
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
