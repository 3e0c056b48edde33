/// `topple times`: the time sheet, when the wave comes to every part of a layout and how long it takes there.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>

#include "json_value.h"
#include "output.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "topple/measure.h"
#include "verb.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

/// A number with so many digits behind the point, or a dash where there is none.
std::string cell(double number, int digits) { return std::isfinite(number) ? formatted("%.*f", digits, number) : "-"; }

/// The part of a brick; empty where it has none.
std::string part_name(const Layout& layout, BrickId brick) {
  const Part* const part = brick == kNoBrick ? nullptr : layout.part_of(brick);
  return part == nullptr ? std::string() : part->name;
}

/// "row 3, brick 48", "push at 0.3 s".
std::string brought_by(const Layout& layout, const PartTimes& times) {
  if (times.from != kNoBrick) return part_name(layout, times.from) + ", brick " + std::to_string(times.from);
  if (std::isfinite(times.pushed_at)) return formatted("push at %.4g s", times.pushed_at);
  return times.reached > 0 ? "nobody" : "not reached";
}

/// Ties those together that start together.
const char* bracket(std::span<const PartTimes> sheet, std::size_t i) {
  const auto tied = [&](std::size_t a, std::size_t b) { return sheet[a].start >= 0 && sheet[a].start == sheet[b].start; };
  const bool above = i > 0 && tied(i - 1, i), below = i + 1 < sheet.size() && tied(i, i + 1);
  return above ? (below ? "\u2502" : "\u2514") : (below ? "\u250c" : " ");
}

class TimesVerb final : public Verb {
 public:
  const char* name() const override { return "times"; }
  const char* purpose() const override { return "The time sheet: when the wave comes to every part, how long it takes, who brings it"; }
  const char* example() const override { return "topple times scenes/by_hand.toml"; }

  void declare(Options& app) override {
    app::declare(app, options_, "RECORDING");
    app.add_option("-o,--out", output_, "Write the sheet as a table for other programs").type_name("FILE.csv");
    app.add_flag("--json", json_, "Print one JSON object and nothing else to standard output");
  }

  int run() override {
    if (!output_.empty()) {
      if (output_.extension() != ".csv") return complain("-o " + output_.string() + ": the name must end in .csv.", kBadInput);
      if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    }
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) return recording.error();
    const std::vector<PartTimes> sheet = measure_parts(*recording);
    if (json_) print_json(*recording, sheet);
    if (output_.empty()) {
      if (!json_) print(*recording, sheet);
      return kDone;
    }
    if (const Result<void> written = export_times_csv(*recording, output_); !written) return complain(written.error(), kFailed);
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  static void print(const Recording& recording, const std::vector<PartTimes>& sheet) {
    const Layout& layout = recording.layout();
    std::printf("%s, by %s\n", (layout.title.empty() ? layout.name : layout.title + " (" + layout.name + ")").c_str(),
                recording.recipe().model.c_str());
    int width = 4;
    for (const Part& part : layout.parts) width = std::max(width, static_cast<int>(part.name.size()));
    std::printf("  %-*s %9s %9s %9s %9s %9s %9s %7s  %s\n", width, "part", "bricks", "fallen", "first s", "last s", "takes s", "bricks/s",
                "m/s", "brought by");
    for (std::size_t i = 0; i < sheet.size(); ++i) {
      const PartTimes& times = sheet[i];
      const Part& part = layout.parts[times.part];
      std::printf("%s %-*s %9s %9s %9s %9s %9s %9s %7s  %s\n", bracket(sheet, i), width, part.name.c_str(), grouped(part.count).c_str(),
                  grouped(times.fallen).c_str(), cell(times.first_arrival, 3).c_str(), cell(times.last_arrival, 3).c_str(),
                  cell(times.last_arrival - times.first_arrival, 3).c_str(), cell(times.brick_rate, 1).c_str(),
                  cell(times.speed, 3).c_str(), brought_by(layout, times).c_str());
    }
    print_whole(recording, sheet, width);
  }

  static void print_whole(const Recording& recording, const std::vector<PartTimes>& sheet, int width) {
    const RunSummary whole = summarize(recording);
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const PartTimes& times : sheet) {
      first = std::fmin(first, times.first_arrival);
      last = std::fmax(last, times.last_arrival);
    }
    std::printf("  %-*s %9s %9s %9s %9s %9s\n", width, "all", grouped(whole.bricks).c_str(), grouped(whole.fallen).c_str(),
                cell(first, 3).c_str(), cell(last, 3).c_str(), cell(last - first, 3).c_str());
    const std::string end = recording.end().words;
    if (whole.standing > 0 && !end.empty()) std::printf("%s\n", end.c_str());
  }

  static void print_json(const Recording& recording, const std::vector<PartTimes>& sheet) {
    const Layout& layout = recording.layout();
    Json json;
    json["version"] = recording.recipe().version;
    json["layout"] = layout.name;
    json["title"] = layout.title;
    json["model"] = recording.recipe().model;
    json["bricks"] = layout.brick_count();
    json["end_words"] = recording.end().words;
    json["parts"] = Json::array();
    for (const PartTimes& times : sheet) {
      const Part& part = layout.parts[times.part];
      json["parts"].push_back({{"part", part.name},
                               {"bricks", part.count},
                               {"fallen", times.fallen},
                               {"reached", times.reached},
                               {"first_brick", brick_json(times.first)},
                               {"last_brick", brick_json(times.last)},
                               {"first_arrival_s", number_json(times.first_arrival)},
                               {"last_arrival_s", number_json(times.last_arrival)},
                               {"bricks_per_s", number_json(times.brick_rate)},
                               {"speed_m_s", number_json(times.speed)},
                               {"from_part", times.from == kNoBrick ? Json(nullptr) : Json(part_name(layout, times.from))},
                               {"from_brick", brick_json(times.from)},
                               {"pushed_at_s", number_json(times.pushed_at)},
                               {"start", times.start < 0 ? Json(nullptr) : Json(times.start)}});
    }
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  }

  RunOptions options_;
  std::filesystem::path output_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> times_verb() { return std::make_unique<TimesVerb>(); }

}  // namespace topple::app
