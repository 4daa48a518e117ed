#include "surfaces/callback_surface.hpp"

#include <nanobind/stl/pair.h>

#include <algorithm>
#include <string>
#include <utility>

#include "binding/arrays.hpp"

namespace surfmesh {
namespace {

namespace nb = nanobind;
using NumberArray = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

/// The rows of three numbers in an array of this shape; throws ValueError for any other.
std::span<const Point3> checked_rows(nb::handle array, std::initializer_list<std::size_t> shape,
                                     NumberArray& kept) {
    const auto fits = [&] {
        return kept.ndim() == shape.size() &&
               std::equal(shape.begin(), shape.end(), kept.shape_ptr(),
                          [](std::size_t a, auto b) { return a == static_cast<std::size_t>(b); });
    };
    if (!nb::try_cast(array, kept) || !fits()) {
        std::string wanted;
        for (const std::size_t n : shape)
            wanted += (wanted.empty() ? "" : ", ") + std::to_string(n);
        throw nb::value_error(
            ("a surface returned what is no array of numbers of the shape (" + wanted + ")")
                .c_str());
    }
    return {reinterpret_cast<const Point3*>(kept.data()), kept.size() / 3};
}

/// The results of a call as a sequence of so many.
nb::tuple checked_results(const nb::object& results, std::size_t count) {
    nb::tuple found(results);
    if (found.size() != count)
        throw nb::value_error(("a surface returned " + std::to_string(found.size()) +
                               " arrays where " + std::to_string(count) + " were asked for")
                                  .c_str());
    return found;
}

template <class T>
nb::object numpy_copy(std::span<const T> values) {
    return nb::cast(binding::view(Array<T>(values)));
}

}  // namespace

CallbackSurface::CallbackSurface(nb::object surface) : surface_(std::move(surface)) {
    using Interval = std::pair<double, double>;
    const auto [u, v] = nb::cast<std::pair<Interval, Interval>>(surface_.attr("domain"));
    domain_ = {{u.first, v.first}, {u.second, v.second}};
}

CallbackSurface::~CallbackSurface() {
    const nb::gil_scoped_acquire held;
    surface_.reset();
    failure_ = nullptr;
}

SurfaceStatus CallbackSurface::evaluate(std::span<const Point2> uv, int order,
                                        std::span<Point3> out) const {
    const nb::gil_scoped_acquire held;
    try {
        const nb::object given = surface_.attr("evaluate")(numpy_copy(uv), order);
        const nb::tuple results = checked_results(given, derivative_count(order));
        auto place = out.begin();
        for (const nb::handle result : results) {
            NumberArray kept;
            const auto values = checked_rows(result, {uv.size(), 3}, kept);
            place = std::copy(values.begin(), values.end(), place);
        }
        return SurfaceStatus::DONE;
    } catch (...) {
        if (!failure_) failure_ = std::current_exception();
        return SurfaceStatus::FAILED;
    }
}

/// Bounds over cells as the object's ``method`` gives them.
SurfaceStatus CallbackSurface::bounds_by(const char* method, std::span<const ParameterBox> cells,
                                         std::span<Point3> lower, std::span<Point3> upper) const {
    const nb::gil_scoped_acquire held;
    if (cells.empty()) return SurfaceStatus::DONE;
    try {
        if (!nb::hasattr(surface_, method)) return SurfaceStatus::UNKNOWN;
        Array<Point2> low(cells.size()), high(cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            low[i] = cells[i].low;
            high[i] = cells[i].high;
        }
        const nb::object given =
            surface_.attr(method)(nb::cast(binding::view(low)), nb::cast(binding::view(high)));
        if (given.is_none()) return SurfaceStatus::UNKNOWN;
        const nb::tuple results = checked_results(given, 2);
        for (const auto& [number, out] : {std::pair{0, lower}, std::pair{1, upper}}) {
            NumberArray kept;
            const auto values =
                checked_rows(results[number], {cells.size(), lower.size() / cells.size(), 3}, kept);
            std::copy(values.begin(), values.end(), out.begin());
        }
        return SurfaceStatus::DONE;
    } catch (...) {
        if (!failure_) failure_ = std::current_exception();
        return SurfaceStatus::FAILED;
    }
}

SurfaceStatus CallbackSurface::derivative_bounds(std::span<const ParameterBox> cells,
                                                 std::span<Point3> lower,
                                                 std::span<Point3> upper) const {
    return bounds_by("derivative_bounds", cells, lower, upper);
}

SurfaceStatus CallbackSurface::all_bounds(std::span<const ParameterBox> cells,
                                          std::span<Point3> lower, std::span<Point3> upper) const {
    return bounds_by("all_bounds", cells, lower, upper);
}

std::exception_ptr CallbackSurface::take_failure() const {
    const nb::gil_scoped_acquire held;
    return std::exchange(failure_, nullptr);
}

void raise_failure(const Surface& surface, SurfaceStatus status) {
    if (status != SurfaceStatus::FAILED) return;
    if (const std::exception_ptr failure = surface.take_failure()) std::rethrow_exception(failure);
    throw nb::value_error("the surface could not be evaluated");
}

}  // namespace surfmesh
