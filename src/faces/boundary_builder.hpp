// The boundary of a face put together coedge by coedge, as its loops are walked.
#pragma once

#include "faces/face_boundary.hpp"
#include "surfaces/curve.hpp"

namespace surfmesh {

/// The nodes of an edge, from its start to its end.
struct EdgeNodeRows {
    std::span<const double> t;  // fractions of the edge's range
    std::span<const std::int64_t> numbers;
    std::span<const Point3> points;
    std::span<const double> sizes;
};

/// The image of an edge in (u, v): its parameters where the edge starts and ends, linear between.
struct EdgeImage {
    const Curve& curve;
    double p0, p1;
    bool is_reversed;  // the loop runs from the edge's end to its start
};

class BoundaryBuilder {
  public:
    void add(const EdgeImage& image, const EdgeNodeRows& nodes, double tolerance);
    /// A coedge whose nodes are known in (u, v), in walking order.
    void add_nodes(std::span<const Point2> uv, const EdgeNodeRows& nodes, bool is_degenerate,
                   double tolerance);
    void end_loop() { made_.loop_end.push_back(made_.pieces()); }
    [[nodiscard]] const FaceBoundary& boundary() const { return made_; }

  private:
    void end_piece(bool is_degenerate, double tolerance);

    FaceBoundary made_;
    Array<double> parameter_;
    Array<Point3> place_;
};

}  // namespace surfmesh
