// A surface that is asked for block after block, and whether it has failed in any of them.
//
// Once it has, all values are zero and the surface is not asked again: whoever reads goes on with
// what makes no sense until the next look at ``status``, and gives up there.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>

#include "surfaces/surface.hpp"
#include "values/array.hpp"
#include "values/threads.hpp"

namespace surfmesh {

class SurfaceReader {
  public:
    explicit SurfaceReader(const Surface& surface) : surface_(surface) {}

    [[nodiscard]] ParameterBox domain() const { return surface_.domain(); }
    [[nodiscard]] SurfaceStatus status() const { return status_; }
    [[nodiscard]] bool failed() const { return status_ != SurfaceStatus::DONE; }

    /// Call ``work(reader, first, last)`` for blocks of [0, count), side by side, each with a
    /// reader of its own. Where one of them fails this one has failed.
    template <class Work>
    void for_each_block(std::size_t count, std::size_t block, const Work& work) {
        std::atomic<SurfaceStatus> worst = status_;
        surfmesh::for_each_block(count, block, [&](std::size_t first, std::size_t last) {
            SurfaceReader own(surface_);
            own.status_ = worst.load();
            work(own, first, last);
            if (own.failed()) worst.store(own.status_);
        });
        status_ = worst.load();
    }

    /// Read r and its derivatives up to an order at uv; the block before is forgotten.
    void read(std::span<const Point2> uv, int order) {
        points_ = uv.size();
        values_.resize(derivative_count(order) * points_);
        const std::span<Point3> out{values_.data(), derivative_count(order) * points_};
        if (!failed()) status_ = surface_.evaluate(uv, order, out);
        if (failed()) std::fill(out.begin(), out.end(), Point3{0.0, 0.0, 0.0});
    }
    /// Bounds of derivatives over cells, as ``Surface::derivative_magnitudes`` gives them; false
    /// where there are none.
    [[nodiscard]] bool read_magnitudes(std::span<const ParameterBox> cells, int order,
                                       std::span<Point3> out) {
        if (failed()) return false;
        const SurfaceStatus found = surface_.derivative_magnitudes(cells, order, out);
        if (found == SurfaceStatus::FAILED) status_ = found;
        return found == SurfaceStatus::DONE;
    }
    /// Derivative k at all points of the block, in the sequence of ``derivative_count``.
    [[nodiscard]] std::span<const Point3> operator[](std::size_t k) const {
        return {values_.data() + k * points_, points_};
    }

  private:
    const Surface& surface_;
    SurfaceStatus status_ = SurfaceStatus::DONE;
    Array<Point3> values_;
    std::size_t points_ = 0;
};

}  // namespace surfmesh
