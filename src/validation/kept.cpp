#include "validation/kept.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
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
  KeptRuns kept;
  if (path.empty()) return kept;
  kept.path_ = path;
  std::error_code problem;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), problem);
  bool whole = true;
  // Kept runs are lines of JSON; whatever else somebody names here by mistake is not written into.
  if (const int first = std::ifstream(path).get(); first != std::char_traits<char>::eof() && first != '{')
    return failure("Finished runs cannot be kept in " + path.string() + ": it holds something else.");
  if (!fresh) {
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
      whole = !stream.eof();
      read_line(line, kept.runs_);
    }
  }
  kept.file_.reset(std::fopen(path.c_str(), fresh ? "wb" : "ab"));
  if (kept.file_ == nullptr) return failure("Finished runs cannot be kept in " + path.string() + ": " + std::strerror(errno) + ".");
  if (!whole) std::fputc('\n', kept.file_.get());
  return kept;
}

std::string KeptRuns::name(const std::string& model, std::uint64_t fingerprint, const Job& job) {
  std::array<char, 40> numbers{};
  std::snprintf(numbers.data(), numbers.size(), "%016llx-%016llx", static_cast<unsigned long long>(fingerprint),
                static_cast<unsigned long long>(job.key()));
  return std::string(TOPPLE_VERSION) + "-" + model + "-" + numbers.data();
}

std::optional<Outcome> KeptRuns::find(const std::string& name) const {
  const auto at = runs_.find(name);
  return at == runs_.end() ? std::nullopt : std::optional(at->second);
}

void KeptRuns::add(const std::string& name, const Outcome& outcome) {
  runs_[name] = outcome;
  if (file_ == nullptr) return;
  const std::string line = Json{{"run", name}, {"numbers", outcome.numbers}, {"profile", outcome.profile}}.dump() + "\n";
  if (std::fputs(line.c_str(), file_.get()) >= 0 && std::fflush(file_.get()) == 0) return;
  problem_ = "Finished runs cannot be kept in " + path_.string() + ": " + std::strerror(errno) + ".";
}

}  // namespace topple::validation
