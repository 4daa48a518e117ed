// How spline surfaces bend over cells, by the Bezier coefficients of each span that a cell meets.
//
// Over a part a x b of a span second derivatives lie between second differences of the coefficients
// c_ij, p (p - 1) (c_i+2 - 2 c_i+1 + c_i) / a^2 and so on. A rational surface is S = A / w:
//
//     S_uu = (A_uu - 2 w_u S_u - w_uu S) / w        S_u = (A_u - w_u S) / w
//     S_uv = (A_uv - w_u S_v - w_v S_u - w_uv S) / w
//
// with A about a point of the part, so that S is small. All along one direction at a time.
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997, 4.4 and 5.3.
#include <algorithm>
#include <limits>

#include "surfaces/bezier_piece.hpp"
#include "surfaces/outward.hpp"
#include "surfaces/spline_surface.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t HIGHEST = 25;  // degree: what CAD kernels allow

/// The coefficients of one part of a surface along one direction, or its weights.
struct Coefficients {
    std::size_t rows, columns;
    double width_u, width_v;
    const double* values;
    double error;  // of each of them

    [[nodiscard]] double at(std::size_t i, std::size_t j) const { return values[i * columns + j]; }
};

/// Between the smallest and the largest of differences; terms: how many ends each has.
class Range {
  public:
    void take(double x) {
        lo_ = std::min(lo_, x);
        hi_ = std::max(hi_, x);
        size_ = std::max(size_, std::abs(x));
    }
    /// Times a factor, with the error of the coefficients and of the few operations.
    [[nodiscard]] Interval scaled(double factor, double error) const {
        if (!(lo_ <= hi_)) return {0.0, 0.0};  // none: the degree is too low for the derivative
        const double margin = error + 4.0 * outward::ULP * size_;
        return outward::widened({factor * (lo_ - margin), factor * (hi_ + margin)}, 6.0);
    }

  private:
    double lo_ = std::numeric_limits<double>::infinity(), hi_ = -lo_, size_ = 0.0;
};

/// A derivative along u or v that no width goes with is multiplied by a width of 0 in the end.
double per(double width) { return width > 0.0 ? 1.0 / width : 0.0; }

Interval value(const Coefficients& c) {
    Range found;
    for (std::size_t i = 0; i < c.rows * c.columns; ++i) found.take(c.values[i]);
    return found.scaled(1.0, c.error);
}

/// k times along u, l times along v.
Interval derivative(const Coefficients& c, std::size_t k, std::size_t l) {
    Range found;
    const auto along_u = [&](std::size_t i, std::size_t j) {
        if (k == 0) return c.at(i, j);
        if (k == 1) return c.at(i + 1, j) - c.at(i, j);
        return (c.at(i + 2, j) - c.at(i + 1, j)) - (c.at(i + 1, j) - c.at(i, j));
    };
    for (std::size_t i = 0; i + k < c.rows; ++i)
        for (std::size_t j = 0; j + l < c.columns; ++j)
            found.take(l == 0   ? along_u(i, j)
                       : l == 1 ? along_u(i, j + 1) - along_u(i, j)
                                : (along_u(i, j + 2) - along_u(i, j + 1)) -
                                      (along_u(i, j + 1) - along_u(i, j)));
    const auto p = static_cast<double>(c.rows - 1), q = static_cast<double>(c.columns - 1);
    double factor = 1.0;
    if (k > 0) factor *= p * per(c.width_u);
    if (k > 1) factor *= (p - 1.0) * per(c.width_u);
    if (l > 0) factor *= q * per(c.width_v);
    if (l > 1) factor *= (q - 1.0) * per(c.width_v);
    return found.scaled(factor, 4.0 * c.error);  // at most four ends, of a second difference
}

struct BendsAlong {
    Interval uu, uv, vv;
};

BendsAlong polynomial_bends(const Coefficients& a) {
    return {derivative(a, 2, 0), derivative(a, 1, 1), derivative(a, 0, 2)};
}

BendsAlong rational_bends(const Coefficients& a, const Coefficients& w, Interval s) {
    using namespace outward;
    const Interval weight = value(w), w_u = derivative(w, 1, 0), w_v = derivative(w, 0, 1);
    if (!(weight.lo > 0.0)) return {UNBOUNDED, UNBOUNDED, UNBOUNDED};
    const Interval s_u = divide(subtract(derivative(a, 1, 0), multiply(w_u, s)), weight);
    const Interval s_v = divide(subtract(derivative(a, 0, 1), multiply(w_v, s)), weight);
    const auto twice = [](Interval x) { return Interval{2.0 * x.lo, 2.0 * x.hi}; };
    const auto less = [](Interval x, Interval y, Interval z) {
        return subtract(x, multiply(y, z));
    };
    const Interval uu = less(less(derivative(a, 2, 0), twice(w_u), s_u), derivative(w, 2, 0), s);
    const Interval vv = less(less(derivative(a, 0, 2), twice(w_v), s_v), derivative(w, 0, 2), s);
    const Interval uv =
        less(less(less(derivative(a, 1, 1), w_u, s_v), w_v, s_u), derivative(w, 1, 1), s);
    return {divide(uu, weight), divide(uv, weight), divide(vv, weight)};
}

/// What is worked in, for one cell after the other.
struct Work {
    Array<SpanPart> u, v;
    Array<Homogeneous> control, line;
    Array<double> along, weights;
};

}  // namespace

SurfaceStatus SplineSurface::enclose(std::span<const Point2> uv,
                                     std::span<EnclosedPoint> out) const {
    if (u_.degree() > HIGHEST || v_.degree() > HIGHEST) return SurfaceStatus::UNKNOWN;
    Array<Point3> r(uv.size());
    const auto status = evaluate(uv, 0, {r.data(), r.size()});
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

SurfaceStatus SplineSurface::enclose_bends(std::span<const ParameterBox> cells,
                                           std::span<const Directions> directions,
                                           std::span<Bends> out) const {
    if (u_.degree() > HIGHEST || v_.degree() > HIGHEST) return SurfaceStatus::UNKNOWN;
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1, count = rows * columns;
    Work work;
    work.control.resize(count);
    work.line.resize(std::max(rows, columns));
    work.along.resize(count);
    work.weights.resize(count);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const auto& [low, high] = cells[cell];
        out[cell] = UNBOUNDED_BENDS;
        if (!split_at_knots(u_, low.x, high.x, work.u) ||
            !split_at_knots(v_, low.y, high.y, work.v))
            continue;
        bool first = true;
        for (const SpanPart& u : work.u)
            for (const SpanPart& v : work.v) {
                const Bends part = bends_of_part(u, v, directions[cell], work.control, work.line,
                                                 work.along, work.weights);
                for (std::size_t d = 0; d < 3; ++d) {
                    Bends& all = out[cell];
                    all.uu[d] = first ? part.uu[d] : outward::hull(all.uu[d], part.uu[d]);
                    all.uv[d] = first ? part.uv[d] : outward::hull(all.uv[d], part.uv[d]);
                    all.vv[d] = first ? part.vv[d] : outward::hull(all.vv[d], part.vv[d]);
                }
                first = false;
            }
    }
    return SurfaceStatus::DONE;
}

/// Over a part of one span each way; the arrays are what it works in.
Bends SplineSurface::bends_of_part(const SpanPart& u, const SpanPart& v,
                                   const Directions& directions, Array<Homogeneous>& control,
                                   Array<Homogeneous>& line, Array<double>& along,
                                   Array<double>& weights) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    const bool rational = !weights_.empty();
    const std::int64_t corner = (u.span - static_cast<std::int64_t>(u_.degree())) * columns_ +
                                v.span - static_cast<std::int64_t>(v_.degree());
    const Point3 middle = control_[corner + static_cast<std::int64_t>(rows / 2) * columns_ +
                                   static_cast<std::int64_t>(columns / 2)];
    double largest = 0.0;
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < columns; ++j) {
            const std::int64_t from =
                corner + static_cast<std::int64_t>(i) * columns_ + static_cast<std::int64_t>(j);
            const double w = rational ? weights_[from] : 1.0;
            const Point3 x = w * (control_[from] - middle);
            control[i * columns + j] = {x.x, x.y, x.z, w};
            largest = std::max(
                {largest, std::abs(x.x), std::abs(x.y), std::abs(x.z), rational ? w : 0.0});
        }
    for (std::size_t j = 0; j < columns; ++j)
        restrict_to(u_, u, control.data() + j, columns, line.data());
    for (std::size_t i = 0; i < rows; ++i)
        restrict_to(v_, v, control.data() + i * columns, 1, line.data());
    const double error = 2.0 * restriction_error(u_.degree() + v_.degree(), largest);
    const Homogeneous& c = control[(rows / 2) * columns + columns / 2];
    const Point3 about = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
    const double moved = rational ? error * (1.0 + norm(about)) + 4.0 * error : error;
    Bends found{};
    for (std::size_t d = 0; d < 3; ++d) {
        const Point3& direction = directions[d];
        Range s;
        for (std::size_t k = 0; k < rows * columns; ++k) {
            const Homogeneous& x = control[k];
            Point3 at = {x[0], x[1], x[2]};
            if (rational) at = at - x[3] * about;
            along[k] = dot(direction, at);
            weights[k] = x[3];
            if (rational) s.take(along[k] / x[3]);
        }
        const Coefficients a{rows,         columns,    u.last - u.first, v.last - v.first,
                             along.data(), 4.0 * moved};
        BendsAlong bends = rational ? BendsAlong{} : polynomial_bends(a);
        if (rational) {
            const Coefficients w{rows, columns, a.width_u, a.width_v, weights.data(), error};
            const double least = *std::min_element(weights.begin(), weights.end());
            const double off = least > 2.0 * error
                                   ? 4.0 * (a.error + error * largest / least) / least
                                   : intervals::INFINITE;
            bends = rational_bends(a, w, s.scaled(1.0, off));
        }
        found.uu[d] = bends.uu;
        found.uv[d] = bends.uv;
        found.vv[d] = bends.vv;
    }
    return found;
}

}  // namespace surfmesh
