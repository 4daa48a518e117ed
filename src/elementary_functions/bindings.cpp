#include <nanobind/stl/pair.h>

#include <utility>

#include "binding/arrays.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh::binding {
namespace {

/// Numbers in an array of any shape, and a new array of the same shape.
using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using NewNumbers = nb::ndarray<nb::numpy, double>;

using Function = double (*)(double);
using BlockFunction = void (*)(std::span<const double>, std::span<double>);

std::span<const double> all(const Numbers& x) { return {x.data(), x.size()}; }

/// A new array of the shape of x over the memory of `values`.
NewNumbers shaped_as(const Numbers& x, const Array<double>& values) {
    using Memory = std::shared_ptr<double[]>;
    auto* kept = new Memory(values.memory());  // what the capsule deletes
    const nb::capsule owner(kept,
                            [](void* memory) noexcept { delete static_cast<Memory*>(memory); });
    Array<std::size_t> shape;
    for (std::size_t k = 0; k < x.ndim(); ++k) shape.push_back(x.shape(k));
    return NewNumbers(values.data(), x.ndim(), shape.data(), owner);
}

/// f of a number, and of an array of any shape.
void bind_function(nb::module_& m, const char* name, Function f, BlockFunction over_block,
                   const char* doc) {
    m.def(name, f, nb::arg("x"), doc);
    m.def(
        name,
        [over_block](const Numbers& x) {
            Array<double> found(x.size());
            {
                const nb::gil_scoped_release released;
                over_block(all(x), std::span<double>(found));
            }
            return shaped_as(x, found);
        },
        nb::arg("x"), "Likewise, for each number of an array.");
}

void bind_sine_and_cosine(nb::module_& m) {
    using namespace elementary;
    bind_function(m, "sin", sin, sin, "Sine; error below 0.85 ulp.");
    bind_function(m, "cos", cos, cos, "Cosine; error below 0.85 ulp.");
    bind_function(m, "tan", tan, tan, "Tangent; error below 1 ulp.");
    m.def(
        "sincos",
        [](double x) {
            const SineCosine both = sincos(x);
            return std::pair(both.sine, both.cosine);
        },
        nb::arg("x"), "Sine and cosine, those of ``sin`` and ``cos``.");
    m.def(
        "sincos",
        [](const Numbers& x) {
            Array<double> sine(x.size()), cosine(x.size());
            {
                const nb::gil_scoped_release released;
                sincos(all(x), std::span<double>(sine), std::span<double>(cosine));
            }
            return std::pair(shaped_as(x, sine), shaped_as(x, cosine));
        },
        nb::arg("x"), "Likewise, for each number of an array.");
}

}  // namespace

void bind_elementary_functions(nb::module_& m) {
    m.doc() =
        "Sine, cosine, exponential and the like: one implementation, the same bits everywhere.";
    bind_sine_and_cosine(m);
}

}  // namespace surfmesh::binding
