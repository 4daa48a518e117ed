// How arrays pass between numpy and the core: spans in, shared memory out, shapes checked.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "values/array.hpp"
#include "values/point.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh::binding {

namespace nb = nanobind;

/// So many numbers in a row.
template <class T, std::size_t count>
struct RowOf {
    using Number = T;
    static constexpr std::size_t columns = count;
};

/// How a value looks to numpy: its numbers, and how many there are in a row.
template <class T>
struct Row : RowOf<T, 1> {};
template <>
struct Row<Point2> : RowOf<double, 2> {};
template <>
struct Row<Point3> : RowOf<double, 3> {};
template <>
struct Row<SizeTensor> : RowOf<double, 3> {};
template <>
struct Row<MetricRoot3> : RowOf<double, 6> {};

/// An array of numpy that a function takes: C-contiguous rows, converted where the type differs.
template <class T>
using Vector = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T, std::size_t columns>
using Matrix = nb::ndarray<const T, nb::shape<-1, columns>, nb::c_contig, nb::device::cpu>;
using Points2 = Matrix<double, 2>;
using Points3 = Matrix<double, 3>;
using SizeTensors = Matrix<double, 3>;

/// The rows of an array as values.
template <class T, class Given>
std::span<const T> rows(const Given& array) {
    static_assert(sizeof(T) % sizeof(typename Row<T>::Number) == 0);
    return {reinterpret_cast<const T*>(array.data()), array.shape(0)};
}

/// What keeps the memory of an array for numpy.
template <class T>
nb::capsule owner_of(const Array<T>& array) {
    using Memory = std::shared_ptr<T[]>;
    auto* kept = new Memory(array.memory());  // what the capsule deletes
    return nb::capsule(kept, [](void* memory) noexcept { delete static_cast<Memory*>(memory); });
}

/// An array of numpy over the memory of the core's: (n,) or (n, columns).
template <class T, class Number = typename Row<T>::Number>
auto view(const Array<T>& array) {
    constexpr std::size_t columns = Row<T>::columns;
    const nb::capsule owner = owner_of(array);
    auto* data = reinterpret_cast<Number*>(array.data());
    if constexpr (columns == 1) {
        const std::size_t shape[] = {array.size()};
        return nb::ndarray<nb::numpy, Number, nb::ndim<1>>(data, 1, shape, owner);
    } else {
        const std::size_t shape[] = {array.size(), columns};
        return nb::ndarray<nb::numpy, Number, nb::shape<-1, columns>>(data, 2, shape, owner);
    }
}

/// The same, not to be written to.
template <class T>
auto read_only_view(const Array<T>& array) {
    return view<T, const typename Row<T>::Number>(array);
}

/// Indices as rows of three.
inline nb::ndarray<nb::numpy, std::int32_t, nb::shape<-1, 3>> in_threes(
    const Array<std::int32_t>& corners) {
    const std::size_t shape[] = {corners.size() / 3, 3};
    return {corners.data(), 2, shape, owner_of(corners)};
}

/// A property that gives an array of its owner as a view, which keeps the memory alive by itself.
template <class Owner, class T>
void bind_array(nb::class_<Owner>& c, const char* name, Array<T> Owner::* member, const char* doc) {
    c.def_prop_ro(
        name, [member](const Owner& owner) { return view(owner.*member); },
        nb::rv_policy::automatic, doc);
}

/// The same, not to be written to.
template <class Owner, class T>
void bind_read_only_array(nb::class_<Owner>& c, const char* name, Array<T> Owner::* member,
                          const char* doc) {
    c.def_prop_ro(
        name, [member](const Owner& owner) { return read_only_view(owner.*member); },
        nb::rv_policy::automatic, doc);
}

/// Refuse indices outside 0 .. count - 1; ``what`` names the argument.
template <class Number>
void require_indices(std::span<const Number> indices, std::size_t count, const char* what) {
    // no branch that depends on data: several are looked at at once, by signs
    using Unsigned = std::make_unsigned_t<Number>;
    constexpr auto LARGEST = static_cast<std::size_t>(std::numeric_limits<Number>::max());
    const auto last = static_cast<Unsigned>(std::min(count - 1, LARGEST));
    Unsigned signs = count == 0 && !indices.empty() ? ~Unsigned{0} : 0;
    for (const Number index : indices)
        signs |= static_cast<Unsigned>(index) | (last - static_cast<Unsigned>(index));
    if (static_cast<Number>(signs) < 0)
        throw nb::value_error((std::string(what) + " has an index that is out of range").c_str());
}

/// Refuse what does not have the wanted number of rows.
inline void require_rows(std::size_t found, std::size_t wanted, const char* what) {
    if (found != wanted)
        throw nb::value_error((std::string(what) + " has " + std::to_string(found) +
                               " rows instead of " + std::to_string(wanted))
                                  .c_str());
}

}  // namespace surfmesh::binding
