// Derivatives of a spline surface to the third order over cells, by the differences of the Bezier
// coefficients of each span that a cell meets; and its tangents at points, by those at a corner.
#include <algorithm>

#include "surfaces/bezier_boxes.hpp"
#include "surfaces/boxed_vectors.hpp"
#include "surfaces/knot_places.hpp"
#include "surfaces/spline_surface.hpp"

namespace surfmesh {

/// What is worked in, for one part after the other.
struct SplineSurface::ThirdWork {
    Array<SpanPart> u, v;
    Array<Homogeneous> control;
    BezierWork numbers;

    explicit ThirdWork(std::size_t rows, std::size_t columns)
        : control(rows * columns), numbers(rows * columns) {}
};

/// Over a part, to the third order.
DerivativeBoxes SplineSurface::boxes_of_part(const PartOfCell& part, const Directions& directions,
                                             ThirdWork& work) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1;
    const auto& [u, v] = part;
    const double largest = coefficients(part, middle_of(part), work.control);
    const BezierNet net{rows,
                        columns,
                        u.last - u.first,
                        v.last - v.first,
                        {work.control.data(), rows * columns},
                        2.0 * restriction_error(u_.degree() + v_.degree(), largest),
                        largest,
                        !weights_.empty()};
    return boxes_of_net(net, directions, 3, nullptr, work.numbers);
}

/// At a corner of a part, by the four coefficients there: those of a net of degree one whose first
/// derivatives there are the same, as it is by the degree narrower.
TangentBoxes SplineSurface::tangents_at(const PartOfCell& part, const BezierCorner& corner,
                                        Array<Homogeneous>& control) const {
    const std::size_t p = u_.degree(), q = v_.degree(), columns = q + 1;
    const double largest = controls_of(part, middle_of(part), control);
    const Restriction along_u(u_, part.u), along_v(v_, part.v);
    std::array<Homogeneous, 2 * (HIGHEST_DEGREE + 1)> lines;  // NOLINT: what is read is set
    for (std::size_t j = 0; j < columns; ++j) {
        const auto ends = along_u.at_end(control.data() + j, columns, corner.last_u);
        for (std::size_t i = 0; i < 2; ++i) lines[i * columns + j] = ends[i];
    }
    std::array<Homogeneous, 4> found;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto ends = along_v.at_end(lines.data() + i * columns, 1, corner.last_v);
        std::copy(ends.begin(), ends.end(), found.begin() + static_cast<std::ptrdiff_t>(2 * i));
    }
    const BezierNet net{2,
                        2,
                        (part.u.last - part.u.first) / static_cast<double>(p),
                        (part.v.last - part.v.first) / static_cast<double>(q),
                        found,
                        2.0 * restriction_error(p + q, largest),
                        largest,
                        !weights_.empty()};
    BezierWork work(found.size());
    const DerivativeBoxes boxes = boxes_of_net(net, AXES, 1, &corner, work);
    return {boxes[1], boxes[2]};
}

bool SplineSurface::enclose_third(const ParameterBox& cell, const Directions& directions,
                                  PartBoxes& out) const {
    if (std::max(u_.degree(), v_.degree()) > HIGHEST_DEGREE) return false;
    ThirdWork work(u_.degree() + 1, v_.degree() + 1);
    if (!split_at_knots(u_, cell.low.x, cell.high.x, work.u) ||
        !split_at_knots(v_, cell.low.y, cell.high.y, work.v) ||
        !jumps_before(u_, work.u, out.jumps_u) || !jumps_before(v_, work.v, out.jumps_v))
        return false;
    out.parts_u = work.u.size();
    out.parts_v = work.v.size();
    out.boxes.clear();
    for (const SpanPart& part_u : work.u)
        for (const SpanPart& part_v : work.v) {
            const SpanPart u = with_width(u_, part_u), v = with_width(v_, part_v);
            out.boxes.push_back(boxes_of_part({u, v}, directions, work));
        }
    return true;
}

bool SplineSurface::enclose_tangents(Point2 uv, TangentBoxes& out) const {
    if (std::max(u_.degree(), v_.degree()) > HIGHEST_DEGREE) return false;
    Array<Homogeneous> control((u_.degree() + 1) * (v_.degree() + 1));
    const auto places_u = places_at(u_, uv.x, {domain_.low.x, domain_.high.x});
    const auto places_v = places_at(v_, uv.y, {domain_.low.y, domain_.high.y});
    for (std::size_t i = 0; i < places_u.count; ++i)
        for (std::size_t j = 0; j < places_v.count; ++j) {
            const BezierCorner corner{places_u.from_last[i], places_v.from_last[j]};
            const TangentBoxes found =
                tangents_at({places_u.part[i], places_v.part[j]}, corner, control);
            out = i + j == 0
                      ? found
                      : TangentBoxes{outward::hull(out.u, found.u), outward::hull(out.v, found.v)};
        }
    return true;
}

}  // namespace surfmesh
