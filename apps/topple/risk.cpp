/// `topple risk`: how likely it is that a run put down by hand stops, and at which bricks.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "interrupt.h"
#include "json_value.h"
#include "progress.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "topple/sweep.h"
#include "verb.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRadian = 57.295779513082323;  // [degrees]
constexpr int kMostRuns = 1'000'000;
constexpr std::size_t kMostShown = 12;  // Of links, and of parts.

/// In percent, as exactly as it matters: "0.035", "7.1", "42", "99.93".
std::string in_percent(double share) {
  const double value = 100.0 * share;
  return formatted(value < 9.95 ? "%.2g" : value < 98.95 ? "%.0f" : "%.4g", value);
}

/// "12 % (7.1 to 20 %)".
std::string with_interval(const Share& share) {
  return in_percent(share.value()) + " % (" + in_percent(share.low()) + " to " + in_percent(share.high()) + " %)";
}

Json share_json(const Share& share) {
  return {{"count", share.count}, {"of", share.of}, {"share", share.value()}, {"low", share.low()}, {"high", share.high()}};
}

/// A run as a line of the file of --kept, under the key of its study.
std::string line_of(const std::string& key, const PlacedRun& run) {
  Json standing = Json::array();
  for (const BrickRange& range : run.standing) standing.push_back({range.first, range.last});
  return Json{
      {"study", key}, {"seed", run.seed}, {"built", run.built}, {"standing", standing}, {"last_arrival_s", number_json(run.last_arrival)}}
      .dump();
}

/// Adds the runs that were kept of the same study; lines of others, and what is no run at all, are passed over.
void add_kept(const KeptLines& kept, RiskStudy& study) {
  const std::string key = study.key();
  for (const std::string& line : kept.lines()) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("study", Json()) != Json(key)) continue;
    try {
      PlacedRun run{.seed = json.at("seed").get<std::uint64_t>(), .built = json.at("built").get<bool>()};
      for (const Json& range : json.at("standing")) run.standing.push_back({range.at(0).get<BrickId>(), range.at(1).get<BrickId>()});
      if (json.at("last_arrival_s").is_number()) run.last_arrival = json["last_arrival_s"].get<double>();
      study.add(std::move(run));
    } catch (const Json::exception&) {
      continue;
    }
  }
}

class RiskVerb final : public Verb {
 public:
  const char* name() const override { return "risk"; }
  const char* purpose() const override {
    return "How likely a run stops whose bricks are put down by hand, and where: many runs, by rigid";
  }
  const char* example() const override { return "topple risk scenes/curve_u.toml --runs 20 --position-mm 1 --threads 2"; }

  void declare(Options& app) override {
    app::declare(app, options_, "LAYOUT");
    app.add_option("--runs", runs_, "How many runs, each with bricks put down anew (default 100)")
        .type_name("N")
        .check(whole_number(1, kMostRuns));
    app.add_option("--position-mm", position_,
                   "How far bricks stand from their places: standard deviation along x, and along y (default 0.5)")
        .type_name("MM")
        .check(number(0.0, 1000.0));
    app.add_option("--heading-deg", heading_, "How far they are turned: standard deviation (default 1.7)")
        .type_name("DEG")
        .check(number(0.0, 180.0));
    app.add_option("--kept", kept_, "Keep finished runs in this file, and take those from it that are there already").type_name("FILE");
    app.add_flag("--json", json_, "Print one JSON object and nothing else to standard output");
  }

  int run() override {
    if (refused_as_recording(options_.file, "risk")) return kBadInput;
    // What a hand has put down is in no plane: the other models are asked only where somebody wants them.
    if (options_.model.empty()) options_.model = "rigid";
    const Result<Layout> layout = load_layout(options_.file, overrides_of(options_));
    if (!layout) return complain(layout.error(), kBadInput);
    Result<KeptLines> kept = KeptLines::open(kept_, false);
    if (!kept) return complain(kept.error(), kBadInput);
    Result<RiskStudy> study = begin(*layout);
    if (interrupted()) return complain("Interrupted: not even the run with exact bricks is whole.", kInterrupted);
    if (!study) return complain(study.error(), kBadInput);
    add_kept(*kept, *study);
    if (const Result<void> done = run_all(*study, *kept); !done) return complain(done.error(), kBadInput);
    if (!kept->problem().empty()) complain(kept->problem(), kFailed);
    if (study->done().empty()) return complain("Interrupted: no run is whole.", kInterrupted);
    const Risk risk = study->risk();
    if (json_) {
      print_json(*study, risk);
    } else {
      print(*study, risk);
    }
    if (interrupted()) return complain(interrupted_words(), kInterrupted);
    return kept->problem().empty() ? kDone : kFailed;
  }

 private:
  Result<RiskStudy> begin(const Layout& layout) const {
    Progress bar;
    RunConfig config;
    config.until = options_.until;
    config.threads = options_.threads;
    config.lanes = options_.lanes;
    config.watch = [&bar](const RunProgress& progress, const Recording&) {
      bar.show(progress);
      return !interrupted();
    };
    return RiskStudy::begin(layout, {.position = position_ / 1000.0, .heading = heading_ / kRadian}, config);
  }

  Result<void> run_all(RiskStudy& study, KeptLines& kept) const {
    Progress bar;
    const std::string key = study.key();
    const auto of = static_cast<std::int64_t>(runs_);
    std::int64_t done = 0;
    for (const PlacedRun& run : study.done()) done += static_cast<std::int64_t>(run.seed) <= of ? 1 : 0;
    return study.run(
        of,
        [&](const PlacedRun& run) {
          kept.add(line_of(key, run));
          bar.show(++done, of, "run");
        },
        [] { return !interrupted(); });
  }

  std::string interrupted_words() const {
    return kept_.empty() ? "Interrupted; with --kept FILE a later call would go on from here."
                         : "Interrupted; finished runs are kept in " + kept_.string() + ".";
  }

  void print(const RiskStudy& study, const Risk& risk) const {
    const Layout& layout = study.layout();
    std::printf("%s\n", (layout.title.empty() ? layout.name : layout.title + " (" + layout.name + ")").c_str());
    std::printf("  %-12s %s, put down with standard deviations of %.4g mm and %.4g degrees, by %s\n", "runs", grouped(risk.runs).c_str(),
                position_, heading_, study.exact().recipe().model.c_str());
    if (risk.not_built > 0) {
      std::printf("  %-12s in %s bricks would have been in one place: a hand puts that right, so they do not count\n", "",
                  count_of(risk.not_built, "more run").c_str());
    }
    if (const std::int64_t standing = summarize(study.exact()).standing; standing > 0) {
      std::printf("  %-12s with every brick exactly in its place %s standing (%s); asked is after those that fall then\n", "but",
                  (count_of(standing, "brick") + (standing == 1 ? " stays" : " stay")).c_str(), study.exact().end().words.c_str());
    }
    if (risk.runs == 0) return;
    std::printf("  %-12s in %s of %s: %s\n", "all fall", grouped(risk.whole.count).c_str(), count_of(risk.whole.of, "run").c_str(),
                with_interval(risk.whole).c_str());
    if (risk.whole.count > 1) {
      std::printf("  %-12s after %.4g s, give or take %.2g s from run to run\n", "last brick", risk.arrival, risk.arrival_spread);
    }
    print_parts(layout, risk);
    print_links(layout, risk);
  }

  static void print_parts(const Layout& layout, const Risk& risk) {
    if (risk.parts.size() < 2 || risk.weak.empty()) return;
    std::size_t shown = 0;
    for (const PartRisk& part : risk.parts) {
      if (part.stops.count == 0 || shown == kMostShown) break;
      std::printf("  %-12s %s stops %s\n", shown == 0 ? "weak parts" : "", layout.parts[part.part].name.c_str(),
                  stops_text(part.stops).c_str());
      ++shown;
    }
  }

  static std::string stops_text(const Share& stops) {
    return "in " + grouped(stops.count) + " of the " + count_of(stops.of, "run") + " that come there: " + with_interval(stops);
  }

  static std::string where_text(const Layout& layout, BrickId brick) {
    const Part* const part = layout.part_of(brick);
    const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
    return (part == nullptr ? std::string() : part->name + ", ") + formatted("(%.4g, %.4g) mm", 1000.0 * foot.x, 1000.0 * foot.y);
  }

  static void print_links(const Layout& layout, const Risk& risk) {
    const std::size_t shown = std::min(risk.weak.size(), kMostShown);
    for (std::size_t i = 0; i < shown; ++i) {
      const Link& link = risk.weak[i];
      std::printf("  %-12s brick %d (%s) stops %s\n", i == 0 ? "weak links" : "", link.brick, where_text(layout, link.brick).c_str(),
                  stops_text(link.stops).c_str());
    }
    if (risk.weak.size() > shown) std::printf("  %-12s and %zu more (--json lists them all)\n", "", risk.weak.size() - shown);
    const auto held = risk.links - static_cast<std::int64_t>(risk.weak.size());
    if (held == 0) return;
    std::printf("  %-12s %s never stopped in at least %s: each stops in less than %s %%\n", risk.weak.empty() ? "links" : "",
                risk.weak.empty() ? ("all " + grouped(held)).c_str() : ("the other " + grouped(held)).c_str(),
                count_of(risk.least_tested, "run").c_str(), in_percent(Share{0, risk.least_tested}.high()).c_str());
  }

  void print_json(const RiskStudy& study, const Risk& risk) const {
    const Layout& layout = study.layout();
    Json json;
    json["version"] = TOPPLE_VERSION;
    json["layout"] = layout.name;
    json["title"] = layout.title;
    json["model"] = study.exact().recipe().model;
    json["bricks"] = layout.brick_count();
    json["position_mm"] = position_;
    json["heading_deg"] = heading_;
    json["runs"] = risk.runs;
    json["not_built"] = risk.not_built;
    json["exact_end_words"] = study.exact().end().words;
    json["whole"] = share_json(risk.whole);
    json["last_arrival_s"] = number_json(risk.arrival);
    json["last_arrival_spread_s"] = number_json(risk.arrival_spread);
    json["links"] = risk.links;
    json["weak_links"] = Json::array();
    for (const Link& link : risk.weak) {
      const Vec3& foot = layout.bricks[static_cast<std::size_t>(link.brick)].foot;
      json["weak_links"].push_back({{"brick", link.brick},
                                    {"struck_by", brick_json(link.from)},
                                    {"foot_m", {foot.x, foot.y, foot.z}},
                                    {"stops", share_json(link.stops)}});
    }
    json["parts"] = Json::array();
    for (const PartRisk& part : risk.parts) {
      json["parts"].push_back({{"part", layout.parts[part.part].name}, {"links", part.links}, {"stops", share_json(part.stops)}});
    }
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  }

  RunOptions options_;
  int runs_ = 100;
  double position_ = 0.5;  ///< [mm]
  double heading_ = 1.7;   ///< [degrees]
  std::filesystem::path kept_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> risk_verb() { return std::make_unique<RiskVerb>(); }

}  // namespace topple::app
