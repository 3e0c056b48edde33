// From a source's folder to a Source: its file is understood as a whole, every mistake is named.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>

#include "export/gnuplot.h"
#include "validation/entry.h"
#include "validation/source.h"

namespace topple::validation {
namespace {

namespace fs = std::filesystem;

Result<std::string> read_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) return failure(path.string() + " cannot be read.");
  return text;
}

Points read_points(Entry& entry) {
  Points points;
  points.name = entry.text("name", true);
  points.solidity = entry.text("solidity");
  points.label = entry.has("label") ? entry.text("label") : points.name;
  points.x = entry.numbers("x");
  points.y = entry.numbers("y");
  points.error = entry.numbers("error");
  points.line = entry.flag("line", false);
  points.hidden = entry.flag("hidden", false);
  const std::optional<double> share = entry.number("relative_error");
  if (points.x.empty() || points.x.size() != points.y.size()) entry.wrong("y", "x and y must be lists of the same length, not empty");
  if (share) {
    for (const double y : points.y) points.error.push_back(*share * std::fabs(y));
  }
  if (points.error.empty()) points.error.assign(points.y.size(), 0.0);
  if (points.error.size() != points.y.size()) entry.wrong("error", "must have one number for each y, or there is relative_error");
  for (Entry& one : entry.entries("reading")) {
    Reading reading;
    reading.name = one.text("name", true);
    reading.factor = one.number("factor", 1.0);
    one.finish();
    points.readings.push_back(reading);
  }
  if (points.readings.empty()) points.readings.emplace_back();
  entry.finish();
  return points;
}

Unknown read_unknown(Entry& entry) {
  Unknown unknown;
  unknown.key = entry.text("key", true);
  unknown.name = entry.text("name", true);
  unknown.models = entry.texts("models");
  unknown.values = entry.numbers("values");
  unknown.standard = entry.number("default", std::nan(""));
  if (!std::is_sorted(unknown.values.begin(), unknown.values.end())) entry.wrong("values", "must rise");
  if (std::find(unknown.values.begin(), unknown.values.end(), unknown.standard) == unknown.values.end()) {
    entry.wrong("default", "must be one of values");
  }
  entry.finish();
  return unknown;
}

Look look_of(Entry& entry) {
  constexpr std::array<std::pair<std::string_view, Look>, 4> kLooks = {
      {{"line", Look::line}, {"points", Look::points}, {"band", Look::band}, {"hidden", Look::hidden}}};
  const std::string name = entry.text("look");
  if (name.empty()) return Look::line;
  for (const auto& [known, look] : kLooks) {
    if (known == name) return look;
  }
  entry.wrong("look", "must be \"line\", \"points\", \"band\" or \"hidden\"");
  return Look::line;
}

void read_how(Entry& entry, Series& series) {
  series.take = entry.text("take", true);
  series.scale = entry.number("scale", 1.0);
  series.x = entry.numbers("x");
  series.set = entry.texts("set");
  series.values = entry.texts("values");
  if (series.values.empty()) {
    for (const double x : series.x) series.values.push_back(decimal(x));
  }
  const bool profile = series.take.starts_with("profile_");
  if (!profile && series.x.empty()) entry.wrong("x", "must be there");
  if (!profile && series.values.size() != series.x.size()) entry.wrong("values", "must have one for each x");
  series.repeat = static_cast<int>(entry.number("repeat", 1.0));
  series.from = entry.number("from", series.from);
  series.to = entry.number("to", series.to);
  series.window = static_cast<int>(entry.number("window", 1.0));
  series.until = entry.number("until_s", 0.0);
  series.least = entry.numbers("least");
  if (!series.least.empty() && series.least.size() != 2) entry.wrong("least", "must be two numbers");
}

Series read_series(Entry& entry, const fs::path& folder, std::span<const Unknown> unknowns) {
  Series series;
  series.name = entry.text("name", true);
  series.model = entry.text("model", true);
  series.label = entry.has("label") ? entry.text("label") : series.name;
  series.scene = entry.text("scene", true);
  read_how(entry, series);
  series.spread = entry.flag("spread", false);
  series.quick = entry.flag("quick", series.model != "rigid");
  series.look = look_of(entry);
  series.color = static_cast<int>(entry.number("color", series.model == "rigid" ? 1.0 : series.model == "pivot" ? 3.0 : 0.0));
  if (entry.flag("vary", false)) {
    for (const Unknown& unknown : unknowns) {
      if (std::find(unknown.models.begin(), unknown.models.end(), series.model) != unknown.models.end()) series.unknowns.push_back(unknown);
    }
  }
  if (const Result<std::string> text = read_text(folder / series.scene); text) {
    series.scene_text = *text;
  } else {
    entry.wrong("scene", text.error().message);
  }
  entry.finish();
  return series;
}

Claim read_claim(Entry& entry) {
  Claim claim;
  claim.name = entry.text("name", true);
  claim.why = entry.text("why", true);
  claim.series = entry.text("series");
  claim.points = entry.text("points");
  claim.x = entry.number("x");
  claim.over_x = entry.number("over_x");
  claim.over_series = entry.text("over_series");
  claim.expect = entry.number("expect");
  claim.tolerance = entry.number("tolerance", 0.0);
  claim.low = entry.number("low");
  claim.high = entry.number("high");
  claim.compare = entry.text("compare");
  claim.reading = entry.text("reading");
  claim.verdict = entry.text("verdict");
  const bool bounded = claim.x && ((claim.expect && claim.tolerance > 0.0) || claim.low || claim.high);
  const int forms = (!claim.points.empty() && claim.tolerance > 0.0 ? 1 : 0) + (bounded ? 1 : 0) + (!claim.verdict.empty() ? 1 : 0);
  if (forms != 1) entry.wrong("name", "a claim has points with a tolerance, or x with expect or low and high, or a verdict");
  entry.finish();
  return claim;
}

Figure read_figure(Entry& entry) {
  Figure figure;
  figure.x_label = entry.text("x_label", true);
  figure.y_label = entry.text("y_label", true);
  figure.x_range = entry.numbers("x_range");
  figure.y_range = entry.numbers("y_range");
  figure.log_x = entry.flag("log_x", false);
  figure.log_y = entry.flag("log_y", false);
  figure.caption = entry.text("caption", true);
  entry.finish();
  return figure;
}

template <typename List>
bool named(const List& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&name](const auto& one) { return one.name == name; });
}

/// What a compare or a claim names must be there.
void check_names(const Source& source, Entry& entry) {
  const auto need = [&entry](bool there, const std::string& who, const std::string& what) {
    if (!there) entry.wrong("title", who + " names " + what + ", which is not there");
  };
  for (const Compare& compare : source.compares) {
    need(named(source.series, compare.series), compare.name, "series " + compare.series);
    need(named(source.points, compare.points), compare.name, "points " + compare.points);
  }
  for (const Claim& claim : source.claims) {
    if (claim.verdict.empty()) need(named(source.series, claim.series), claim.name, "series " + claim.series);
    if (!claim.over_series.empty()) need(named(source.series, claim.over_series), claim.name, "series " + claim.over_series);
    if (!claim.points.empty()) need(named(source.points, claim.points), claim.name, "points " + claim.points);
    if (!claim.verdict.empty()) need(named(source.compares, claim.compare), claim.name, "compare " + claim.compare);
  }
}

void read_lists(Entry& entry, const fs::path& folder, Source& source) {
  std::vector<Unknown> unknowns;
  for (Entry& one : entry.entries("unknown")) unknowns.push_back(read_unknown(one));
  for (Entry& one : entry.entries("figure")) source.figure.push_back(read_figure(one));
  for (Entry& one : entry.entries("points")) source.points.push_back(read_points(one));
  for (Entry& one : entry.entries("series")) source.series.push_back(read_series(one, folder, unknowns));
  for (Entry& one : entry.entries("compare")) {
    source.compares.push_back({one.text("name", true), one.text("series", true), one.text("points", true)});
    one.finish();
  }
  for (Entry& one : entry.entries("claim")) source.claims.push_back(read_claim(one));
}

}  // namespace

Result<Source> read_source(const fs::path& folder) {
  const fs::path file = folder / "source.toml";
  const Result<std::string> text = read_text(file);
  if (!text) return std::unexpected(text.error());
  const toml::parse_result parsed = toml::parse(*text, file.string());
  if (!parsed) {
    return failure(file.string() + ":" + std::to_string(parsed.error().source().begin.line) + ": " +
                   std::string(parsed.error().description()));
  }
  std::string problems;
  Entry entry(parsed.table(), file.string(), problems);
  Source source;
  source.name = folder.filename().string();
  source.title = entry.text("title", true);
  source.kind = entry.text("kind", true);
  source.order = entry.number("order", 0.0);
  source.references = entry.texts("references");
  source.solidity = entry.text("solidity", true);
  source.states = entry.text("states", true);
  source.does_not_state = entry.text("does_not_state");
  source.inputs = entry.text("inputs", true);
  source.conclusion = entry.text("conclusion", true);
  read_lists(entry, folder, source);
  entry.finish();
  check_names(source, entry);
  if (!problems.empty()) return failure(problems);
  return source;
}

std::size_t setting_count(const Series& series) {
  std::size_t count = 1;
  for (const Unknown& unknown : series.unknowns) count *= unknown.values.size();
  return count;
}

std::vector<double> setting_values(const Series& series, std::size_t setting) {
  std::vector<double> values;
  for (const Unknown& unknown : series.unknowns) {
    values.push_back(unknown.values[setting % unknown.values.size()]);
    setting /= unknown.values.size();
  }
  return values;
}

std::size_t standard_setting(const Series& series) {
  std::size_t setting = 0;
  std::size_t stride = 1;
  for (const Unknown& unknown : series.unknowns) {
    const auto at = std::find(unknown.values.begin(), unknown.values.end(), unknown.standard);
    setting += stride * static_cast<std::size_t>(at - unknown.values.begin());
    stride *= unknown.values.size();
  }
  return setting;
}

}  // namespace topple::validation
