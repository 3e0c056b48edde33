/// `topple plot`: figures of a recording.
#include <charconv>
#include <cstdio>
#include <string_view>

#include "output.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

constexpr std::size_t kMostCurves = 64;  // More cannot be told apart in print.

/// Reads a brick's number off the front of `text`.
bool take_number(std::string_view& text, BrickId& number) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || number < 0) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// "0,5,9-12" as numbers.
Result<std::vector<BrickId>> parse_bricks(const std::string& list) {
  std::vector<BrickId> bricks;
  std::string_view rest = list;
  const auto bad = [&list] { return failure("--bricks " + list + ": give numbers and ranges from 0, as in 0,5,9-12."); };
  while (true) {
    BrickId first = 0;
    if (!take_number(rest, first)) {
      return bad();
    }
    BrickId last = first;
    if (rest.starts_with('-')) {
      rest.remove_prefix(1);
      if (!take_number(rest, last) || last < first) {
        return bad();
      }
    }
    if (bricks.size() + static_cast<std::size_t>(last - first) + 1 > kMostCurves) {
      return failure(formatted("--bricks %s: at most %zu curves fit in one figure.", list.c_str(), kMostCurves));
    }
    for (BrickId brick = first; brick <= last; ++brick) {
      bricks.push_back(brick);
    }
    if (rest.empty()) {
      return bricks;
    }
    if (!rest.starts_with(',')) {
      return bad();
    }
    rest.remove_prefix(1);
  }
}

Figure figure_of(std::string_view name) {
  return name == "arrival" ? Figure::arrival : name == "speed" ? Figure::speed : name == "energy" ? Figure::energy : Figure::motion;
}

class PlotVerb final : public Verb {
 public:
  const char* name() const override { return "plot"; }
  const char* purpose() const override { return "Draw a figure of a recording: motion, arrival, speed or energy"; }
  const char* example() const override { return "topple plot scenes/report_row.toml -o motion.svg --figure motion --bricks 0-4"; }

  void declare(Options& app) override {
    app::declare(app, options_, "RECORDING");
    app.add_option("-o,--out", output_, "The file to write; its ending says as what").required().type_name("FILE.svg|.png|.pdf");
    app.add_option("--figure", figure_,
                   "motion: angle, angular velocity and acceleration of chosen bricks; arrival: when the wave came, along the run; "
                   "speed: how fast, along the run; energy: through time (default motion)")
        .type_name("NAME")
        .check(one_of({"motion", "arrival", "speed", "energy"}));
    app.add_option("--bricks", bricks_, "Bricks of a motion figure (default: the first few that moved)").type_name("0,5,9-12");
  }

  int run() override {
    const std::string ending = output_.extension().string();
    if (ending != ".svg" && ending != ".png" && ending != ".pdf") {
      return complain("-o " + output_.string() + ": the name must end in .svg, .png or .pdf.", kBadInput);
    }
    config_.figure = figure_of(figure_);
    if (!bricks_.empty() && config_.figure != Figure::motion) {
      return complain("--bricks chooses the curves of --figure motion; a figure of " + figure_ + " is of all bricks.", kBadInput);
    }
    if (!bricks_.empty()) {
      Result<std::vector<BrickId>> bricks = parse_bricks(bricks_);
      if (!bricks) {
        return complain(bricks.error(), kBadInput);
      }
      config_.bricks = std::move(*bricks);
    }
    if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) {
      return recording.error();
    }
    for (const BrickId brick : config_.bricks) {
      if (brick >= recording->layout().brick_count()) {
        return complain(formatted("--bricks %s: there is no brick %d; %s has bricks 0 to %d.", bricks_.c_str(), brick,
                                  recording->layout().name.c_str(), recording->layout().brick_count() - 1),
                        kBadInput);
      }
    }
    if (const Result<void> drawn = plot(*recording, config_, output_); !drawn) {
      return complain(drawn.error(), kFailed);
    }
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  RunOptions options_;
  std::filesystem::path output_;
  std::string figure_ = "motion";
  std::string bricks_;
  PlotConfig config_;
};

}  // namespace

std::unique_ptr<Verb> plot_verb() { return std::make_unique<PlotVerb>(); }

}  // namespace topple::app
