/// Finished runs on disk, a line of JSON each: an interrupted validation goes on where it was.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "topple/export.h"
#include "validation/job.h"

namespace topple::validation {

class KeptRuns {
 public:
  /// Reads what is there and appends from then on; a line that was cut off by a kill is left out. An empty path keeps nothing.
  static Result<KeptRuns> open(const std::filesystem::path& path, bool fresh);

  /// A run is named by version, model, the model's fingerprint and the job's key.
  static std::string name(const std::string& model, std::uint64_t fingerprint, const Job& job);

  std::optional<Outcome> find(const std::string& name) const;
  void add(const std::string& name, const Outcome& outcome);
  const std::string& problem() const { return lines_.problem(); }  ///< Why some of them are not on disk; empty if all are.

 private:
  std::map<std::string, Outcome> runs_;
  KeptLines lines_;
};

}  // namespace topple::validation
