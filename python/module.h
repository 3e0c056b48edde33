/// The Python module `topple`: the nouns and verbs of include/topple, with numpy arrays where there is one number a brick, an event or a
/// step. SI units everywhere, angles in radians, bricks by their number in layout order.
#pragma once

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "topple/topple.h"

namespace topple::python {

namespace py = pybind11;

/// What a Result's error becomes: topple.Error, with its words.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <typename T>
T value_of(Result<T> result) {
  if (!result) throw Refusal(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

template <typename T>
py::array_t<T> array_of(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

inline py::tuple tuple_of(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }
inline py::tuple tuple_of(const Quat& q) { return py::make_tuple(q.w, q.x, q.y, q.z); }

/// Lets Ctrl-C, and what a caller's function raises, end a run that goes on without the interpreter. Nothing may be thrown through the run:
/// it is kept until the run is over.
class Interrupt {
 public:
  /// Asked now and then, in the thread that began the run. @param ask More to ask; it may raise.
  bool go_on(const std::function<bool()>& ask = {}) {
    if (raised_) return false;
    const py::gil_scoped_acquire held;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      return !ask || ask();
    } catch (py::error_already_set&) {
      raised_ = std::current_exception();
      return false;
    }
  }
  /// After the run.
  void raise() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  std::exception_ptr raised_;
};

void define_layout(py::module_& module);
void define_recording(py::module_& module);
void define_runs(py::module_& module);

}  // namespace topple::python
