// How spline surfaces bend over cells, by the Bezier coefficients of each span that a cell meets.
//
// Polynomials are bounded by their coefficients (bezier_ranges.hpp). A rational surface is S = A / w:
//
//     S_uu = (A_uu - 2 w_u S_u - w_uu S) / w        S_u = (A_u - w_u S) / w
//     S_uv = (A_uv - w_u S_v - w_v S_u - w_uv S) / w
//
// with A about a point of the part, so that S is small. All along one direction at a time.
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997, 4.4 and 5.3.
#include <algorithm>

#include "surfaces/bezier_piece.hpp"
#include "surfaces/bezier_ranges.hpp"
#include "surfaces/outward.hpp"
#include "surfaces/spline_creases.hpp"
#include "surfaces/spline_surface.hpp"

namespace surfmesh {
namespace {

struct BendsAlong {
    Interval uu, uv, vv;
};

BendsAlong polynomial_bends(const BezierNumbers& a) {
    return {derivative_range(a, 2, 0), derivative_range(a, 1, 1), derivative_range(a, 0, 2)};
}

BendsAlong rational_bends(const BezierNumbers& a, const BezierNumbers& w, Interval s) {
    using namespace outward;
    const Interval weight = value_range(w), w_u = derivative_range(w, 1, 0),
                   w_v = derivative_range(w, 0, 1);
    if (!(weight.lo > 0.0)) return {UNBOUNDED, UNBOUNDED, UNBOUNDED};
    const Interval s_u = quotient_slope(derivative_range(a, 1, 0), w_u, s, weight);
    const Interval s_v = quotient_slope(derivative_range(a, 0, 1), w_v, s, weight);
    const auto twice = [](Interval x) { return Interval{2.0 * x.lo, 2.0 * x.hi}; };
    const auto less = [](Interval x, Interval y, Interval z) {
        return subtract(x, multiply(y, z));
    };
    const Interval uu =
        less(less(derivative_range(a, 2, 0), twice(w_u), s_u), derivative_range(w, 2, 0), s);
    const Interval vv =
        less(less(derivative_range(a, 0, 2), twice(w_v), s_v), derivative_range(w, 0, 2), s);
    const Interval uv = less(less(less(derivative_range(a, 1, 1), w_u, s_v), w_v, s_u),
                             derivative_range(w, 1, 1), s);
    return {divide(uu, weight), divide(uv, weight), divide(vv, weight)};
}

/// Parts so narrow for their cell are counted by how much the first derivative changes over them.
constexpr double THIN = 0x1p-10;

bool is_thin(const SpanPart& part, std::span<const SpanPart> all) {
    double whole = 0.0;
    for (const SpanPart& each : all) whole += each.width;
    return part.width < THIN * whole;
}

/// Joins the bends of one cell's parts.
class JoinedBends {
  public:
    JoinedBends(std::size_t parts_u, std::size_t parts_v) : jumps_u_(parts_u), jumps_v_(parts_v) {}

    /// thin: the widths of a thin part, else 0.
    void take(const Bends& part, std::size_t u, double thin_u, std::size_t v, double thin_v) {
        for (std::size_t d = 0; d < 3; ++d) {
            const double mixed = 2.0 * outward::magnitude(part.uv[d]);  // it is gone through once
            if (thin_u > 0.0) grow(jumps_u_[u].beside[d], thin_u * mixed);
            if (thin_v > 0.0 && thin_u == 0.0) grow(jumps_v_[v].beside[d], thin_v * mixed);
            if (thin_u == 0.0 && thin_v == 0.0) all_.uv[d] = outward::hull(all_.uv[d], part.uv[d]);
            if (thin_u > 0.0)
                grow(jumps_u_[u].within[d], thin_u * outward::magnitude(part.uu[d]));
            else
                all_.uu[d] = outward::hull(all_.uu[d], part.uu[d]);
            if (thin_v > 0.0)
                grow(jumps_v_[v].within[d], thin_v * outward::magnitude(part.vv[d]));
            else
                all_.vv[d] = outward::hull(all_.vv[d], part.vv[d]);
        }
    }
    void take_crease(const std::array<double, 3>& jumps, bool along_u, std::size_t part) {
        Jump& all = along_u ? jumps_u_[part] : jumps_v_[part];
        for (std::size_t d = 0; d < 3; ++d) grow(all.before[d], jumps[d]);
    }
    [[nodiscard]] Bends found() const {
        Bends found = all_;
        for (std::size_t d = 0; d < 3; ++d) {
            for (Interval* range : {&found.uu[d], &found.uv[d], &found.vv[d]})
                if (!(range->lo <= range->hi)) *range = {0.0, 0.0};
            found.jump_u[d] = sum(jumps_u_, jumps_v_, d);
            found.jump_v[d] = sum(jumps_v_, jumps_u_, d);
        }
        return found;
    }

  private:
    /// At the crease before a part; over the part where it is thin, of the derivative across it and
    /// of the other one.
    struct Jump {
        std::array<double, 3> before{}, within{}, beside{};
    };
    static void grow(double& most, double x) { most = std::max(most, x); }
    static double sum(const Array<Jump>& across, const Array<Jump>& along, std::size_t d) {
        double all = 0.0;
        for (const Jump& jump : across) all += jump.before[d] + jump.within[d];
        for (const Jump& jump : along) all += jump.beside[d];
        const auto terms = static_cast<double>(across.size() + along.size());
        return all * (1.0 + 8.0 * terms * outward::ULP);
    }
    static constexpr Interval NONE{intervals::INFINITE, -intervals::INFINITE};

    Bends all_{{NONE, NONE, NONE}, {NONE, NONE, NONE}, {NONE, NONE, NONE}, {}, {}};
    Array<Jump> jumps_u_, jumps_v_;
};

}  // namespace

SurfaceStatus SplineSurface::enclose(std::span<const Point2> uv,
                                     std::span<EnclosedPoint> out) const {
    if (u_.degree() > HIGHEST_DEGREE || v_.degree() > HIGHEST_DEGREE) return SurfaceStatus::UNKNOWN;
    Array<Point3> r(uv.size());
    const auto status = evaluate(uv, 0, r);
    double least = 1.0, most = 1.0;
    for (const double w : weights_) {
        least = std::min(least, w);
        most = std::max(most, w);
    }
    if (!(least > 0.0)) return SurfaceStatus::UNKNOWN;
    double size = 0.0;
    for (const Point3& p : control_)
        size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // the functions are positive and add up to 1: sums of relative errors, twice where divided
    const double error = 8.0 * restriction_error(u_.degree() + v_.degree(), size) * (most / least);
    for (std::size_t i = 0; i < uv.size(); ++i) out[i] = {r[i], error};
    return status;
}

/// What is worked in, for one cell after the other.
struct SplineSurface::Work {
    Array<SpanPart> u, v;
    Array<Homogeneous> control, beside;
    Array<double> along, weights;
};

SurfaceStatus SplineSurface::enclose_bends(std::span<const ParameterBox> cells,
                                           std::span<const Directions> directions,
                                           std::span<Bends> out) const {
    if (u_.degree() > HIGHEST_DEGREE || v_.degree() > HIGHEST_DEGREE) return SurfaceStatus::UNKNOWN;
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1, count = rows * columns;
    Work work;
    work.control.resize(count);
    work.beside.resize(count);
    work.along.resize(count);
    work.weights.resize(count);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const auto& [low, high] = cells[cell];
        const bool is_known =
            split_at_knots(u_, low.x, high.x, work.u) && split_at_knots(v_, low.y, high.y, work.v);
        out[cell] = is_known ? bends_of_parts(directions[cell], work) : UNBOUNDED_BENDS;
    }
    return SurfaceStatus::DONE;
}

/// Over all parts of a cell.
Bends SplineSurface::bends_of_parts(const Directions& directions, Work& work) const {
    const std::span all_u(work.u.data(), work.u.size()), all_v(work.v.data(), work.v.size());
    if (all_u.size() == 1 && all_v.size() == 1)
        return bends_of_part(all_u[0], all_v[0], directions, work);
    JoinedBends joined(all_u.size(), all_v.size());
    for (std::size_t i = 0; i < all_u.size(); ++i)
        for (std::size_t j = 0; j < all_v.size(); ++j) {
            const SpanPart &u = all_u[i], &v = all_v[j];
            joined.take(bends_of_part(u, v, directions, work), i, is_thin(u, all_u) ? u.width : 0.0,
                        j, is_thin(v, all_v) ? v.width : 0.0);
            if (u.after_crease)
                joined.take_crease(jumps_between({all_u[i - 1], v}, {u, v}, true, directions, work),
                                   true, i);
            if (v.after_crease)
                joined.take_crease(
                    jumps_between({u, all_v[j - 1]}, {u, v}, false, directions, work), false, j);
        }
    return joined.found();
}

/// Between two parts of one span each way, the one after the other along u or v.
std::array<double, 3> SplineSurface::jumps_between(const PartOfCell& before,
                                                   const PartOfCell& after, bool along_u,
                                                   const Directions& directions, Work& work) const {
    const Point3 middle = middle_of(after);
    const double largest = std::max(coefficients(before, middle, work.beside),
                                    coefficients(after, middle, work.control));
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    const CreaseShape shape{along_u ? rows - 1 : columns - 1,
                            along_u ? columns : 1,
                            along_u ? columns : rows,
                            along_u ? 1 : columns,
                            !weights_.empty(),
                            2.0 * restriction_error(u_.degree() + v_.degree(), largest)};
    const auto side = [along_u](const PartOfCell& part, const Array<Homogeneous>& control) {
        const SpanPart& across = along_u ? part.u : part.v;
        return CreaseSide{control, across.last - across.first};
    };
    return crease_jumps(side(before, work.beside), side(after, work.control), shape, directions);
}

/// A control point in the middle of those of a span.
Point3 SplineSurface::middle_of(const PartOfCell& part) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    return control_[corner_of(part) + static_cast<std::int64_t>(rows / 2) * columns_ +
                    static_cast<std::int64_t>(columns / 2)];
}

/// The first control point of a span each way.
std::int64_t SplineSurface::corner_of(const PartOfCell& part) const {
    return (part.u.span - static_cast<std::int64_t>(u_.degree())) * columns_ + part.v.span -
           static_cast<std::int64_t>(v_.degree());
}

/// Control points of a part's spans, about a point; the largest of their numbers.
double SplineSurface::controls_of(const PartOfCell& part, Point3 about,
                                  Array<Homogeneous>& control) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    const bool rational = !weights_.empty();
    const std::int64_t corner = corner_of(part);
    double largest = 0.0;
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < columns; ++j) {
            const std::int64_t from =
                corner + static_cast<std::int64_t>(i) * columns_ + static_cast<std::int64_t>(j);
            const double w = rational ? weights_[from] : 1.0;
            const Point3 x = w * (control_[from] - about);
            control[i * columns + j] = {x.x, x.y, x.z, w};
            largest = std::max(
                {largest, std::abs(x.x), std::abs(x.y), std::abs(x.z), rational ? w : 0.0});
        }
    return largest;
}

/// Bezier coefficients over a part, about a point; the largest of what they are made of.
double SplineSurface::coefficients(const PartOfCell& part, Point3 about,
                                   Array<Homogeneous>& control) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    const double largest = controls_of(part, about, control);
    const Restriction along_u(u_, part.u), along_v(v_, part.v);
    for (std::size_t j = 0; j < columns; ++j) along_u.apply(control.data() + j, columns);
    for (std::size_t i = 0; i < rows; ++i) along_v.apply(control.data() + i * columns, 1);
    return largest;
}

/// Over a part of one span each way.
Bends SplineSurface::bends_of_part(const SpanPart& u, const SpanPart& v,
                                   const Directions& directions, Work& work) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    const bool rational = !weights_.empty();
    auto& [parts_u, parts_v, control, beside, along, weights] = work;
    const PartOfCell part{u, v};
    const double largest = coefficients(part, middle_of(part), control);
    const double error = 2.0 * restriction_error(u_.degree() + v_.degree(), largest);
    const Homogeneous& c = control[(rows / 2) * columns + columns / 2];
    const Point3 about = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
    const double moved = rational ? error * (1.0 + norm(about)) + 4.0 * error : error;
    Bends found{};
    for (std::size_t d = 0; d < 3; ++d) {
        const Point3& direction = directions[d];
        NumberRange s;
        for (std::size_t k = 0; k < rows * columns; ++k) {
            const Homogeneous& x = control[k];
            Point3 at = {x[0], x[1], x[2]};
            if (rational) at = at - x[3] * about;
            along[k] = dot(direction, at);
            weights[k] = x[3];
            if (rational) s.take(along[k] / x[3]);
        }
        const BezierNumbers a{rows,         columns,    u.last - u.first, v.last - v.first,
                              along.data(), 4.0 * moved};
        BendsAlong bends = rational ? BendsAlong{} : polynomial_bends(a);
        if (rational) {
            const BezierNumbers w{rows, columns, a.width_u, a.width_v, weights.data(), error};
            const double least = *std::min_element(weights.begin(), weights.end());
            const double off = quotient_error(a.error, error, largest, least);
            bends = rational_bends(a, w, s.scaled(1.0, off));
        }
        found.uu[d] = bends.uu;
        found.uv[d] = bends.uv;
        found.vv[d] = bends.vv;
    }
    return found;
}

}  // namespace surfmesh
