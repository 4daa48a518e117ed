#include "faces/joined_faces.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t FACES_AT_ONCE = 16;
constexpr std::size_t FEW_CORNERS = 100'000;  // are put in a row before another thread has begun

/// Where what belongs to a face begins.
struct PlaceOfFace {
    std::size_t point = 0, corner = 0, uv = 0;
    std::size_t inner = 0;  // of the points within faces that a triangle has
};

class Joining {
  public:
    Joining(const SharedNodes& shared, std::span<const FacePart> parts)
        : shared_(shared), parts_(parts) {
        places_.reserve(parts.size() + 1);
        places_.push_back({});
        for (const FacePart& part : parts) {
            const PlaceOfFace before = places_.back();
            places_.push_back({before.point + part.points.size(),
                               before.corner + part.triangles.size(), before.uv + part.uv.size()});
        }
    }

    JoinedFaces joined() {
        find_used_points();
        rank_shared_nodes();
        const PlaceOfFace& all = places_.back();
        found_.triangles = Array<std::int32_t>::unfilled(all.corner);
        found_.face_ids = Array<std::int32_t>::unfilled(all.corner / 3);
        found_.uv = Array<Point2>::unfilled(all.uv);
        found_.uv_triangles = Array<std::int32_t>::unfilled(all.corner);
        for_each_face([&](std::size_t k) { place(k); });
        return std::move(found_);
    }

  private:
    template <class Work>
    void for_each_face(const Work& work) const {
        const bool are_few = places_.back().corner < FEW_CORNERS;
        const std::size_t block = are_few ? std::max<std::size_t>(parts_.size(), 1) : FACES_AT_ONCE;
        for_each_block(parts_.size(), block, [&](std::size_t k, std::size_t end) {
            for (; k < end; ++k) work(k);
        });
    }

    /// Which points have a triangle, and where those inside go.
    void find_used_points() {
        is_used_ = Array<std::uint8_t>::unfilled(places_.back().point);
        Array<std::size_t> inner(parts_.size());
        for_each_face([&](std::size_t k) {
            const FacePart& part = parts_[k];
            std::uint8_t* used = is_used_.data() + places_[k].point;
            std::fill_n(used, part.points.size(), std::uint8_t{0});
            for (const std::int32_t corner : part.triangles) used[corner] = 1;
            std::size_t count = 0;
            for (std::size_t i = 0; i < part.slots.size(); ++i)
                count += part.slots[i] < 0 ? used[i] : 0;
            inner.data()[k] = count;
        });
        for (std::size_t k = 0; k < parts_.size(); ++k)
            places_[k + 1].inner = places_[k].inner + inner.data()[k];
    }

    /// The vertices of the shared nodes, and the least size that any face has there.
    void rank_shared_nodes() {
        const std::size_t count = shared_.points.size();
        Array<std::uint8_t> used(count, 0);
        Array<double> sizes(shared_.sizes);
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const FacePart& part = parts_[k];
            const std::uint8_t* own = is_used_.data() + places_[k].point;
            for (std::size_t i = 0; i < part.slots.size(); ++i) {
                if (part.slots[i] < 0) continue;
                const std::int64_t number = part.numbers[static_cast<std::size_t>(part.slots[i])];
                if (own[i] != 0) used[number] = 1;
                sizes[number] = std::min(sizes[number], part.sizes[i]);
            }
        }
        found_.rank = Array<std::int64_t>(count);
        for (std::size_t n = 0; n < count; ++n)
            found_.rank.data()[n] = used.data()[n] ? static_cast<std::int64_t>(vertices_++) : -1;
        found_.points = Array<Point3>::unfilled(vertices_ + places_.back().inner);
        found_.sizes = Array<double>::unfilled(vertices_ + places_.back().inner);
        for (std::size_t n = 0; n < count; ++n) {
            if (!used.data()[n]) continue;
            const std::int64_t vertex = found_.rank.data()[n];
            found_.points[vertex] = shared_.points[n];
            found_.sizes[vertex] = sizes.data()[n];
        }
    }

    /// What a face adds to the rows of the whole mesh.
    void place(std::size_t k) {
        const FacePart& part = parts_[k];
        const PlaceOfFace& at = places_[k];
        Array<std::int32_t> vertices = vertices_of(k);
        put_triangles(part, vertices, found_.triangles.data() + at.corner);
        std::fill_n(found_.face_ids.data() + at.corner / 3, part.triangles.size() / 3, part.face);
        std::copy(part.uv.begin(), part.uv.end(), found_.uv.data() + at.uv);
        const auto first = static_cast<std::int32_t>(at.uv);
        std::int32_t* corner = found_.uv_triangles.data() + at.corner;
        for (std::size_t i = 0; i + 2 < part.uv_triangles.size(); i += 3, corner += 3) {
            corner[0] = first + part.uv_triangles[i];
            corner[1] = first + part.uv_triangles[i + (part.is_turned ? 2 : 1)];
            corner[2] = first + part.uv_triangles[i + (part.is_turned ? 1 : 2)];
        }
    }

    /// Those of the points of a face; points inside are put where they belong.
    [[nodiscard]] Array<std::int32_t> vertices_of(std::size_t k) {
        const FacePart& part = parts_[k];
        const std::uint8_t* used = is_used_.data() + places_[k].point;
        std::size_t inner = vertices_ + places_[k].inner;
        Array<std::int32_t> vertices(part.points.size());
        for (std::size_t i = 0; i < part.points.size(); ++i) {
            std::int64_t vertex = -1;
            if (part.slots[i] >= 0) {
                vertex = found_.rank[part.numbers[static_cast<std::size_t>(part.slots[i])]];
            } else if (used[i]) {
                found_.points.data()[inner] = part.points[i];
                found_.sizes.data()[inner] = part.sizes[i];
                vertex = static_cast<std::int64_t>(inner++);
            }
            vertices.data()[i] = static_cast<std::int32_t>(vertex);
        }
        return vertices;
    }

    static void put_triangles(const FacePart& part, std::span<const std::int32_t> vertices,
                              std::int32_t* corner) {
        const auto vertex = [&](std::size_t i) {
            return vertices[static_cast<std::size_t>(part.triangles[i])];
        };
        for (std::size_t i = 0; i + 2 < part.triangles.size(); i += 3, corner += 3) {
            corner[0] = vertex(i);
            corner[1] = vertex(i + (part.is_turned ? 2 : 1));
            corner[2] = vertex(i + (part.is_turned ? 1 : 2));
        }
    }

    const SharedNodes& shared_;
    std::span<const FacePart> parts_;
    std::vector<PlaceOfFace> places_;  // of the faces, and behind the last
    Array<std::uint8_t> is_used_;      // of the points of all faces
    std::size_t vertices_ = 0;         // that are shared nodes
    JoinedFaces found_;
};

}  // namespace

JoinedFaces joined_faces(const SharedNodes& shared, std::span<const FacePart> parts) {
    return Joining(shared, parts).joined();
}

}  // namespace surfmesh
