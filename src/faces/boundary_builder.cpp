#include "faces/boundary_builder.hpp"

namespace surfmesh {

void BoundaryBuilder::add(const EdgeImage& image, const EdgeNodeRows& nodes, double tolerance) {
    const std::size_t count = nodes.t.size();
    parameter_.clear();
    for (const double t : nodes.t) parameter_.push_back(image.p0 + t * (image.p1 - image.p0));
    place_.resize(count);
    image.curve.evaluate({parameter_.data(), count}, 0, {place_.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = image.is_reversed ? count - 1 - k : k;
        made_.uv.push_back({place_[at].x, place_[at].y});
        made_.numbers.push_back(nodes.numbers[at]);
        made_.points.push_back(nodes.points[at]);
        made_.sizes.push_back(nodes.sizes[at]);
    }
    end_piece(false, tolerance);
}

void BoundaryBuilder::add_nodes(std::span<const Point2> uv, const EdgeNodeRows& nodes,
                                bool is_degenerate, double tolerance) {
    for (std::size_t k = 0; k < uv.size(); ++k) {
        made_.uv.push_back(uv[k]);
        made_.numbers.push_back(nodes.numbers[k]);
        made_.points.push_back(nodes.points[k]);
        made_.sizes.push_back(nodes.sizes[k]);
    }
    end_piece(is_degenerate, tolerance);
}

void BoundaryBuilder::end_piece(bool is_degenerate, double tolerance) {
    made_.piece_end.push_back(static_cast<std::int32_t>(made_.uv.size()));
    made_.degenerate.push_back(is_degenerate ? 1 : 0);
    made_.tolerance.push_back(tolerance);
}

}  // namespace surfmesh
