#include <nanobind/stl/pair.h>

#include <utility>

#include "binding/arrays.hpp"
#include "elementary_functions/bessel.hpp"
#include "elementary_functions/error_function.hpp"
#include "elementary_functions/exponential.hpp"
#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/power.hpp"
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
    Array<std::size_t> shape;
    for (std::size_t k = 0; k < x.ndim(); ++k) shape.push_back(x.shape(k));
    return NewNumbers(values.data(), x.ndim(), shape.data(), owner_of(values));
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

using FunctionOfTwo = double (*)(double, double);
using BlockFunctionOfTwo = void (*)(std::span<const double>, std::span<const double>,
                                    std::span<double>);

/// f of two numbers, and of two arrays of one shape.
void bind_function_of_two(nb::module_& m, const char* name, FunctionOfTwo f,
                          BlockFunctionOfTwo over_block, const char* first, const char* second,
                          const char* doc) {
    m.def(name, f, nb::arg(first), nb::arg(second), doc);
    m.def(
        name,
        [over_block](const Numbers& a, const Numbers& b) {
            bool same = a.ndim() == b.ndim();
            for (std::size_t k = 0; same && k < a.ndim(); ++k) same = a.shape(k) == b.shape(k);
            if (!same) throw nb::value_error("the two arrays differ in shape");
            Array<double> found(a.size());
            {
                const nb::gil_scoped_release released;
                over_block(all(a), all(b), std::span<double>(found));
            }
            return shaped_as(a, found);
        },
        nb::arg(first), nb::arg(second), "Likewise, for each pair of two arrays of one shape.");
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

void bind_exponential_and_logarithm(nb::module_& m) {
    using namespace elementary;
    bind_function(m, "exp", exp, exp, "Exponential; error below 0.7 ulp.");
    bind_function(m, "log", log, log, "Natural logarithm; error below 0.6 ulp; nan below 0.");
    bind_function(m, "sinh", sinh, sinh, "Hyperbolic sine; error below 1.5 ulp.");
    bind_function(m, "cosh", cosh, cosh, "Hyperbolic cosine; error below 1.5 ulp.");
    bind_function(m, "tanh", tanh, tanh, "Hyperbolic tangent; error below 1.5 ulp.");
    bind_function(m, "asinh", asinh, asinh, "Inverse of sinh; error below 1 ulp.");
    bind_function(m, "acosh", acosh, acosh, "Inverse of cosh; error below 1 ulp; nan below 1.");
    bind_function(m, "atanh", atanh, atanh,
                  "Inverse of tanh; error below 1 ulp; nan outside [-1, 1].");
}

void bind_inverse_trigonometric(nb::module_& m) {
    using namespace elementary;
    bind_function(m, "asin", asin, asin, "Arcus sine; error below 1.5 ulp; nan outside [-1, 1].");
    bind_function(m, "acos", acos, acos, "Arcus cosine; error below 1.5 ulp; nan outside [-1, 1].");
    bind_function(m, "atan", atan, atan, "Arcus tangent; error below 0.7 ulp.");
    bind_function_of_two(m, "atan2", atan2, atan2, "y", "x",
                         "The angle of the point (x, y), in [-pi, pi]; error below 0.7 ulp.");
}

void bind_others(nb::module_& m) {
    using namespace elementary;
    bind_function_of_two(m, "pow", pow, pow, "x", "y",
                         "x to the power y; error below 1 ulp; nan for x < 0 unless y is whole.");
    bind_function_of_two(m, "hypot", hypot, hypot, "x", "y",
                         "sqrt(x^2 + y^2) without overflow on the way; error below 0.51 ulp.");
    bind_function(m, "cbrt", cbrt, cbrt, "Cube root, of either sign; error below 0.51 ulp.");
    bind_function(m, "erf", erf, erf, "The error function; error below 1 ulp.");
    bind_function(m, "bessel_0", bessel_0, bessel_0,
                  "Spherical Bessel function j0 = sin(x)/x, 1 at 0.");
    bind_function(m, "bessel_1", bessel_1, bessel_1, "Spherical Bessel function j1.");
    bind_function(m, "bessel_2", bessel_2, bessel_2, "Spherical Bessel function j2.");
}

}  // namespace

void bind_elementary_functions(nb::module_& m) {
    m.doc() =
        "Sine, cosine, exponential and the like: one implementation, the same bits everywhere.";
    bind_sine_and_cosine(m);
    bind_exponential_and_logarithm(m);
    bind_inverse_trigonometric(m);
    bind_others(m);
}

}  // namespace surfmesh::binding
