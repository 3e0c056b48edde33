/// `topple convergence`: how the error of each integrator shrinks with its time step.
#include <cstdio>

#include "output.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "topple/run.h"
#include "verb.h"

namespace topple::app {
namespace {

struct IntegratorName {
  const char* setting;  ///< As in the layout file.
  const char* words;
};

IntegratorName name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::euler:
      return {"euler", "explicit Euler"};
    case Integrator::semi_implicit:
      return {"semi_implicit", "semi-implicit Euler"};
    case Integrator::rk4:
      return {"rk4", "Runge–Kutta, 4th order"};
  }
  return {"", ""};
}

class ConvergenceVerb final : public Verb {
 public:
  const char* name() const override { return "convergence"; }
  const char* purpose() const override { return "Draw the error of the pivot model's integrators against their time step"; }
  const char* example() const override { return "topple convergence scenes/report_row.toml -o convergence.svg"; }

  void declare(Options& app) override {
    app.add_option("LAYOUT", file_, "A layout file (.toml); its first brick falls freely from its tip angle + 1 degree")
        .required()
        .type_name("");
    app.add_option("-o,--out", output_, "The file to write; its ending says as what").required().type_name("FILE.svg|.png|.pdf");
  }

  int run() override {
    const std::string ending = output_.extension().string();
    if (ending != ".svg" && ending != ".png" && ending != ".pdf") {
      return complain("-o " + output_.string() + ": the name must end in .svg, .png or .pdf.", kBadInput);
    }
    if (refused_as_recording(file_, "convergence")) return kBadInput;
    if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    const Result<Layout> layout = load_layout(file_);
    if (!layout) {
      return complain(layout.error(), kBadInput);
    }
    const Convergence convergence = free_fall_convergence(*layout);
    std::vector<ErrorCurve> curves;
    std::printf("Error of the angle after a free fall of %.4g s, against the time step:\n", convergence.time);
    for (const ConvergenceSeries& series : convergence.series) {
      const IntegratorName names = name_of(series.integrator);
      std::printf("  %-14s slope %.4f\n", names.setting, series.slope);
      curves.push_back({names.words, series.time_steps, series.errors, series.slope});
    }
    if (const Result<void> drawn = plot_convergence(curves, output_); !drawn) {
      return complain(drawn.error(), kFailed);
    }
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path output_;
};

}  // namespace

std::unique_ptr<Verb> convergence_verb() { return std::make_unique<ConvergenceVerb>(); }

}  // namespace topple::app
