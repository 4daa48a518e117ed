// The triangles at a vertex, seen along a normal: how much longer a path over them is than a straight
// one.
//
// The normal is the mean of those of its triangles, or one that is nearer to the worst of them.
//
// In: a mesh, a vertex. Out: |x - y| times this bounds what h changes by between two points of the
// star (isotopy.hpp); infinite where triangles do not lie round the vertex as those of a graph do.
// Nothing is changed.
#pragma once

#include "proof/isotopy.hpp"

namespace surfmesh {

class VertexStars {
  public:
    explicit VertexStars(const MovedMesh& mesh);

    [[nodiscard]] std::int32_t count() const {
        return static_cast<std::int32_t>(first_.size()) - 1;
    }
    /// The largest |h(x) - h(y)| / |x - y| in the star of v.
    [[nodiscard]] double change(std::int32_t v);

  private:
    /// One triangle at the vertex: the next corners round it, and its normal.
    struct Member {
        std::int32_t a, b, triangle;
        Point3 normal;
    };

    [[nodiscard]] Member member_of(std::int32_t v, std::int32_t triangle) const;
    bool put_in_order(std::int32_t v);
    [[nodiscard]] double turned_inwards(std::int32_t v, Point3 n) const;
    [[nodiscard]] double change_along(std::int32_t v, Point3 n) const;
    [[nodiscard]] Point3 turned_to_worst(Point3 n) const;

    MovedMesh mesh_;
    Array<std::int32_t> first_, at_vertex_;
    Array<Member> members_;
    bool is_closed_ = false;
};

}  // namespace surfmesh
