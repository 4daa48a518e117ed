// How the core calls Python while it runs without the interpreter.
#pragma once

#include <nanobind/nanobind.h>

#include <exception>

namespace surfmesh::binding {

namespace nb = nanobind;

/// Calls of Python out of the running core. What one raises stops the core, and comes through.
class CallsBack {
  public:
    /// Run ``call`` with the interpreter held; false once something was raised.
    template <class Call>
    bool run(Call call) {
        const nb::gil_scoped_acquire held;
        try {
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            call();
        } catch (...) {
            raised_ = std::current_exception();
        }
        return raised_ == nullptr;
    }
    /// Raise what was raised.
    void finish() {
        if (raised_) std::rethrow_exception(raised_);
    }

  private:
    std::exception_ptr raised_;
};

}  // namespace surfmesh::binding
