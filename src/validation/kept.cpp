#include "validation/kept.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace topple::validation {
namespace {

using Json = nlohmann::json;

double number_of(const Json& json) { return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN(); }

bool read_line(const std::string& line, std::map<std::string, Outcome>& runs) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("run") || !json["run"].is_string()) return false;
  Outcome outcome;
  if (json.contains("numbers")) {
    for (const auto& [key, value] : json["numbers"].items()) outcome.numbers[key] = number_of(value);
  }
  if (json.contains("profile")) {
    for (const Json& value : json["profile"]) outcome.profile.push_back(number_of(value));
  }
  runs[json["run"].get<std::string>()] = std::move(outcome);
  return true;
}

}  // namespace

Result<KeptRuns> KeptRuns::open(const std::filesystem::path& path, bool fresh) {
  Result<KeptLines> lines = KeptLines::open(path, fresh);
  if (!lines) return std::unexpected(lines.error());
  KeptRuns kept;
  for (const std::string& line : lines->lines()) read_line(line, kept.runs_);
  kept.lines_ = std::move(*lines);
  return kept;
}

std::string KeptRuns::name(const std::string& model, std::uint64_t fingerprint, const Job& job) {
  return std::string(TOPPLE_VERSION) + "-" + model + "-" + hash_digits(fingerprint) + "-" + hash_digits(job.key());
}

std::optional<Outcome> KeptRuns::find(const std::string& name) const {
  const auto at = runs_.find(name);
  return at == runs_.end() ? std::nullopt : std::optional(at->second);
}

void KeptRuns::add(const std::string& name, const Outcome& outcome) {
  runs_[name] = outcome;
  lines_.add(Json{{"run", name}, {"numbers", outcome.numbers}, {"profile", outcome.profile}}.dump());
}

}  // namespace topple::validation
