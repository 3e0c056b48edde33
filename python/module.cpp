#include "module.h"

PYBIND11_MODULE(topple, module) {
  namespace py = topple::python::py;
  module.doc() =
      "Topple plans and predicts domino runs.\n\n"
      "    layout = topple.load_layout('scenes/s_curve.toml')\n"
      "    recording = topple.simulate(layout)\n"
      "    print(recording.summary())\n\n"
      "SI units everywhere, angles in radians; bricks are called by their number in layout order.";
  module.attr("__version__") = TOPPLE_VERSION;
  py::register_exception<topple::python::Refusal>(module, "Error", PyExc_ValueError).doc() =
      "Why something cannot be done, in words; one problem a line.";
  topple::python::define_layout(module);
  topple::python::define_recording(module);
  topple::python::define_runs(module);
}
