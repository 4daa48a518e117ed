// The boundaries of faces put together coedge by coedge, as their loops are walked.
#pragma once

#include <utility>

#include "faces/face_boundary.hpp"

namespace surfmesh {

/// Nodes along an edge.
struct EdgeNodeRows {
    std::span<const Point2> uv;  // in the plane of the face
    std::span<const std::int64_t> numbers;
    std::span<const Point3> points;
    std::span<const double> sizes;
};

/// A use of an edge by a face.
struct EdgeUse {
    bool is_reversed;  // the loop runs against the order of the nodes
    bool is_degenerate;
    double tolerance;
};

class BoundaryBuilder {
  public:
    /// Room for so many nodes and uses of edges.
    void reserve(std::size_t nodes, std::size_t uses);
    void add(const EdgeNodeRows& nodes, const EdgeUse& use);
    void end_loop() { made_.loop_end.push_back(made_.pieces()); }
    [[nodiscard]] FaceBoundary boundary() const& { return made_; }
    [[nodiscard]] FaceBoundary boundary() && { return std::move(made_); }

  private:
    FaceBoundary made_;
};

}  // namespace surfmesh
