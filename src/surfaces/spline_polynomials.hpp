// A spline surface as polynomials, one over each pair of knot spans, for many points in few spans.
//
//     r(u, v) = c + sum a_kl s^k t^l        s, t from -1 to 1 over the spans of u and v
//
// In: a spline that is not rational. Out: its points and first derivatives by Horner's rule, without
// basis functions, to rounding but not to the last bit those of the spline; higher derivatives, and
// points beyond the spans that are prepared, are the spline's own. Spans are those that the spline
// finds, at knots, creases and seams too.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "surfaces/spline_surface.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// The knot spans of one parameter that are prepared.
class PreparedSpans {
  public:
    /// Those that a range meets. basis: outlives them.
    PreparedSpans(const SplineBasis& basis, double low, double high);

    struct Place {
        std::int32_t number;  // of the span among these, NIL: in none
        double s;             // from -1 to 1 over it
    };
    /// ``before``: the number of a span that is looked at first.
    [[nodiscard]] Place place_of(double t, std::int32_t before) const {
        const Prepared& likely = spans_[before];
        if (t > likely.low && t < likely.high) return {before, likely.rate * (t - likely.middle)};
        return located(t);
    }

    [[nodiscard]] std::size_t size() const { return spans_.size(); }
    [[nodiscard]] std::int64_t span(std::int32_t number) const { return spans_[number].span; }
    /// ds/dt.
    [[nodiscard]] double rate(std::int32_t number) const { return spans_[number].rate; }
    /// What a power series about the middle of a span takes of its functions: row k has their
    /// derivatives k times 1 / k! in s.
    [[nodiscard]] Array<double> series(std::int32_t number) const;

  private:
    struct Prepared {
        std::int64_t span;
        double low, high;  // between these no knot is near
        double middle, rate;
    };

    [[nodiscard]] Place located(double t) const;

    const SplineBasis* basis_;
    Array<Prepared> spans_;
    Array<std::int32_t> number_;  // of each span of the basis, or NIL
};

class SplinePolynomials final : public FaceSurface {
  public:
    /// Nothing of a rational spline, of one with more than ``most`` pairs of spans over its domain,
    /// and where powers would lose digits.
    static std::shared_ptr<SplinePolynomials> of(std::shared_ptr<const SplineSurface> spline,
                                                 std::size_t most);

    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;

  private:
    SplinePolynomials(std::shared_ptr<const SplineSurface> spline, PreparedSpans u,
                      PreparedSpans v);

    struct Place {
        PreparedSpans::Place u, v;
    };

    [[nodiscard]] bool prepare(std::int32_t u, std::int32_t v);
    [[nodiscard]] Place place_of(Point2 uv, const Place& before) const;
    template <int order>
    void evaluate_as(std::span<const Point2> uv, std::span<Point3> out) const;

    std::shared_ptr<const SplineSurface> spline_;
    PreparedSpans u_, v_;
    std::size_t rows_, columns_;  // coefficients of a polynomial: powers of s, and of t
    Array<Point3> about_;         // c of each pair of spans, those of v side by side
    Array<Point3> coefficients_;  // of each, from the highest powers on: rows of t
};

}  // namespace surfmesh
