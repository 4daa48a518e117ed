#include "faces/face_queue.hpp"

#include <algorithm>
#include <utility>

namespace surfmesh {
namespace {

/// A first part becomes the row.
template <class T>
void extend(Array<T>& row, Array<T>& more) {
    if (row.empty()) {
        row.swap(more);
        return;
    }
    const std::size_t before = row.size();
    row.resize(before + more.size());
    std::copy(more.begin(), more.end(), row.begin() + before);
}

/// Is it done, with triangles, and asks for nothing?
bool is_plain(const FaceMesh& made) {
    const auto& [chord, folds, angle] = made.patch.requests;
    return made.end == FaceEnd::done && !chord && !folds && !angle && made.coarse.sizes.empty() &&
           !made.patch.mapped.seamless.triangles.empty();
}

FaceMesh mesh_queued(const QueuedFace& face, const PatchHooks& hooks) {
    if (const auto* graded = std::get_if<GradedFace>(&face)) return mesh_graded(*graded, hooks);
    return mesh_inward(std::get<InwardFace>(face), hooks);
}

}  // namespace

void FaceRows::append(std::int64_t number, FaceMesh made) {
    MappedPatch& mapped = made.patch.mapped;
    face.push_back(number);
    extend(points, mapped.points);
    extend(slots, made.slots);
    extend(sizes, mapped.sizes);
    extend(triangles, mapped.seamless.triangles);
    extend(uv_triangles, mapped.seamless.corners);
    extend(uv, mapped.uv);
    point_end.push_back(static_cast<std::int64_t>(points.size()));
    triangle_end.push_back(static_cast<std::int64_t>(triangles.size() / 3));
    corner_end.push_back(static_cast<std::int64_t>(uv.size()));
}

const Surface& FaceQueue::surface_of(std::int64_t number) const {
    const QueuedFace& face = faces_[static_cast<std::size_t>(number)];
    if (const auto* graded = std::get_if<GradedFace>(&face)) return *graded->surface.over_box;
    return *std::get<InwardFace>(face).surface;
}

FinishedFaces FaceQueue::work(std::int64_t triangles, const std::function<bool()>& goes_on) {
    const auto is_wanted = [&] { return !stopped_ && goes_on(); };
    const PatchHooks hooks{
        [&](PatchStage) { return !stopped_; },
        [&](Vertex) { return is_wanted(); },
        [&] { return !stopped_; },
    };
    FinishedFaces finished;
    std::int64_t left = triangles;
    while (left > 0 && !stopped_) {
        const std::size_t number = begun_++;
        if (number >= faces_.size()) break;
        FaceMesh made = mesh_queued(faces_[number], hooks);
        if (made.end == FaceEnd::patch_failed && made.patch.end == PatchEnd::cancelled) {
            stop();
            break;
        }
        left -= 1 + static_cast<std::int64_t>(made.patch.mapped.seamless.triangles.size() / 3);
        const auto place = static_cast<std::int64_t>(number);
        if (is_plain(made))
            finished.rows.append(place, std::move(made));
        else
            finished.others.push_back({place, std::move(made)});
    }
    return finished;
}

}  // namespace surfmesh
