#include <atomic>
#include <functional>
#include <limits>
#include <optional>

#include "module.h"

namespace topple::python {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Nothing, as a function without `return` gives it, is no reason to end.
using Watch = std::function<std::optional<bool>(double time, std::int64_t arrived)>;

Recording run(const Layout& layout, double until, int threads, const Watch& watch) {
  const ModelConfig model = value_of(model_config(layout));
  Interrupt interrupt;
  RunConfig config;
  config.until = until;
  config.threads = threads;
  config.watch = [&](const RunProgress& progress, const Recording&) {
    return interrupt.go_on([&] { return !watch || watch(progress.time, progress.arrived).value_or(true); });
  };
  Result<Recording> recording = [&] {
    const py::gil_scoped_release released;
    return simulate(layout, model, config);
  }();
  interrupt.raise();
  return value_of(std::move(recording));
}

py::dict run_again(const Recording& recording, int threads) {
  Interrupt interrupt;
  RunConfig config;
  config.threads = threads;
  config.watch = [&](const RunProgress&, const Recording&) { return interrupt.go_on(); };
  Result<ReplayVerdict> verdict = [&] {
    const py::gil_scoped_release released;
    return replay(recording, config);
  }();
  interrupt.raise();
  const ReplayVerdict said = value_of(std::move(verdict));
  py::dict all;
  all["same"] = said.same;
  all["words"] = said.words;
  return all;
}

py::dict share(const Share& share) {
  py::dict all;
  all["count"] = share.count;
  all["of"] = share.of;
  all["share"] = share.value();
  all["low"] = share.low();
  all["high"] = share.high();
  return all;
}

py::dict risk_of(const Layout& layout, std::int64_t runs, double position, double heading, double until, int threads) {
  Interrupt interrupt;
  std::atomic<bool> stopped = false;
  RunConfig config;
  config.until = until;
  config.threads = threads;
  config.watch = [&](const RunProgress&, const Recording&) { return interrupt.go_on(); };
  const auto asked = [&]() -> Result<RiskStudy> {
    const py::gil_scoped_release released;
    Result<RiskStudy> study = RiskStudy::begin(layout, {.position = position, .heading = heading}, config);
    if (!study) return study;
    // Signals are the main thread's: it looks for them where a run is finished.
    const auto finished = [&](const PlacedRun&) { stopped = !interrupt.go_on(); };
    const Result<void> ran = study->run(runs, finished, [&stopped] { return !stopped.load(); });
    if (!ran) return std::unexpected(ran.error());
    return study;
  };
  Result<RiskStudy> study = asked();
  interrupt.raise();
  if (!study) throw Refusal(study.error().message);
  const Risk risk = study->risk();
  py::dict all;
  all["runs"] = risk.runs;
  all["not_built"] = risk.not_built;
  all["whole"] = share(risk.whole);
  all["arrival"] = risk.arrival;
  all["arrival_spread"] = risk.arrival_spread;
  py::list weak, parts;
  for (const Link& link : risk.weak) {
    py::dict one = share(link.stops);
    one["brick"] = link.brick;
    one["struck_by"] = link.from;
    weak.append(one);
  }
  for (const PartRisk& part : risk.parts) {
    py::dict one = share(part.stops);
    one["part"] = study->layout().parts[part.part].name;
    parts.append(one);
  }
  all["weak_links"] = weak;
  all["parts"] = parts;
  return all;
}

}  // namespace

void define_runs(py::module_& module) {
  module.def(
      "simulate", &run, py::arg("layout"), py::arg("until") = kNoLimit, py::arg("threads") = 1, py::arg("watch") = Watch(),
      "Runs a layout by the model that it names (layout.with_settings(['model.name=hinge']) asks for another one) to its end, or until "
      "that time [s]. `watch(time, arrived)` is called some twenty times a second; where it returns false the run ends. Ctrl-C raises "
      "KeyboardInterrupt. The result does not depend on the threads.");
  module.def("replay", &run_again, py::arg("recording"), py::arg("threads") = 1,
             "Runs a recording's recipe again: whether it is the same, bit by bit, and in words.");
  module.def(
      "risk", &risk_of, py::arg("layout"), py::arg("runs") = 100, py::arg("position") = PlacementError().position,
      py::arg("heading") = PlacementError().heading, py::arg("until") = kNoLimit, py::arg("threads") = 1,
      "How likely the run stops whose bricks are put down by hand, and where (docs/risk.md): standard deviations of position [m] and "
      "heading [rad]. Shares have a 95 % interval, low to high.");
}

}  // namespace topple::python
