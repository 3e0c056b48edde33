/// `topple layout`: what a layout file builds, without running it.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostDoubts = 5;  // Of each sort; the page shows all in their places.

/// Whichever unit a person would use for a length [m].
std::string length_text(double length) {
  if (length >= 1000.0) {
    return formatted("%.4g km", length / 1000.0);
  }
  return length >= 1.0 ? formatted("%.4g m", length) : formatted("%.4g mm", length * 1000.0);
}

/// The first of a long list (a gradient gives every brick a colour of its own), and how much more there is.
void print_counts(const char* what, const std::vector<LayoutSummary::Count>& counts) {
  constexpr std::size_t kMost = 16;
  const std::size_t shown = counts.size() > kMost ? kMost - 1 : counts.size();
  for (std::size_t i = 0; i < shown; ++i) {
    std::printf("  %-12s %s: %s\n", i == 0 ? what : "", counts[i].name.c_str(), count_of(counts[i].bricks, "brick").c_str());
  }
  if (shown == counts.size()) {
    return;
  }
  std::int64_t rest = 0;
  for (std::size_t i = shown; i < counts.size(); ++i) {
    rest += counts[i].bricks;
  }
  std::printf("  %-12s and %zu more %s: %s (--json lists them all)\n", "", counts.size() - shown, what, count_of(rest, "brick").c_str());
}

void print_summary(const Layout& layout, const LayoutSummary& summary) {
  std::printf("%s\n", (layout.title.empty() ? layout.name : layout.title + " (" + layout.name + ")").c_str());
  std::printf("  %-12s %s\n", "bricks", grouped(summary.bricks).c_str());
  std::printf("  %-12s %s\n", "length", length_text(summary.length).c_str());
  const Vec3 size = summary.high - summary.low;
  std::printf("  %-12s %s x %s x %s, from (%.4g, %.4g, %.4g) mm to (%.4g, %.4g, %.4g) mm\n", "box", length_text(size.x).c_str(),
              length_text(size.y).c_str(), length_text(size.z).c_str(), 1e3 * summary.low.x, 1e3 * summary.low.y, 1e3 * summary.low.z,
              1e3 * summary.high.x, 1e3 * summary.high.y, 1e3 * summary.high.z);
  print_counts("kinds", summary.kinds);
  print_counts("colours", summary.colors);
  std::printf("  %-12s %zu\n", "pushes", layout.pushes.size());
}

/// Where the run may stop, as far as geometry alone can say.
void print_doubts(const std::vector<Doubt>& doubts) {
  for (std::size_t i = 0; i < doubts.size(); ++i) std::printf("  %-12s %s\n", i == 0 ? "doubts" : "", doubts[i].words.c_str());
}

Json counts_json(const std::vector<LayoutSummary::Count>& counts) {
  Json json = Json::object();
  for (const LayoutSummary::Count& count : counts) {
    json[count.name] = count.bricks;
  }
  return json;
}

void print_json(const Layout& layout, const LayoutSummary& summary, const std::vector<Doubt>& doubts) {
  Json json;
  json["version"] = TOPPLE_VERSION;
  json["layout"] = layout.name;
  json["title"] = layout.title;
  json["bricks"] = summary.bricks;
  json["length_m"] = summary.length;
  json["low_m"] = {summary.low.x, summary.low.y, summary.low.z};
  json["high_m"] = {summary.high.x, summary.high.y, summary.high.z};
  json["kinds"] = counts_json(summary.kinds);
  json["colors"] = counts_json(summary.colors);
  json["pushes"] = layout.pushes.size();
  json["doubts"] = Json::array();
  for (const Doubt& doubt : doubts) json["doubts"].push_back(doubt.words);
  std::printf("%s\n", json.dump(2).c_str());
}

class LayoutVerb final : public Verb {
 public:
  const char* name() const override { return "layout"; }
  const char* purpose() const override { return "Check a layout file, print what it builds, and where its run may stop"; }
  const char* example() const override { return "topple layout scenes/report_row.toml"; }

  void declare(Options& app) override {
    app.add_option("FILE", file_, "A layout file (.toml)").required().type_name("");
    app.add_option("--set", settings_, "A setting over what the file says, as often as needed").type_name("KEY=VALUE").one_word();
    app.add_flag("--json", json_, "Print one JSON object");
  }

  int run() override {
    if (refused_as_recording(file_, "layout")) return kBadInput;
    const Result<Layout> layout = load_layout(file_, settings_);
    if (!layout) {
      return complain(layout.error(), kBadInput);
    }
    if (const Result<ModelConfig> model = model_config(*layout); !model) return complain(model.error(), kBadInput);
    const LayoutSummary summary = summarize(*layout);
    const std::vector<Doubt> doubts = find_stops(*layout, kMostDoubts);
    if (json_) {
      print_json(*layout, summary, doubts);
      return kDone;
    }
    print_summary(*layout, summary);
    print_doubts(doubts);
    return kDone;
  }

 private:
  std::filesystem::path file_;
  std::vector<std::string> settings_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> layout_verb() { return std::make_unique<LayoutVerb>(); }

}  // namespace topple::app
