/// Validation: published measurements beside what each model predicts for the same bricks, verdicts, and claims that are checked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "topple/base.h"

namespace topple {

enum class Verdict : std::uint8_t {
  agrees,           ///< Inside the error bars at every point, with every unknown left at its default: nothing was chosen.
  agrees_for_some,  ///< One choice of the unknowns from their plausible ranges is inside the error bars at every point.
  does_not_agree    ///< No choice is.
};
/// "agrees for some plausible friction".
const char* words_of(Verdict verdict);

/// What one series of predictions says about one set of published points.
struct Comparison {
  std::string name;
  std::string model;
  std::string reading;  ///< Which reading of the published numbers; empty where there is only one.
  Verdict verdict = Verdict::does_not_agree;
  double worst_default = 0.0;  ///< Largest relative deviation from the points with every unknown at its default.
  double worst_best = 0.0;     ///< The same with the unknowns that fit best.
  std::string best;            ///< Those unknowns, in words; empty if there are none.
  std::string point_fits;      ///< The value of the first unknown that fits each point alone, in words.
  std::string words;           ///< The verdict as a sentence.
};

/// A statement that we make, and whether it holds.
struct ClaimCheck {
  std::string name;
  std::string why;    ///< Why this tolerance.
  std::string found;  ///< In words, with numbers.
  bool holds = false;
};

struct SourceReport {
  std::string name;  ///< Its folder.
  std::string title;
  std::string kind;
  std::vector<Comparison> comparisons;
  std::vector<ClaimCheck> claims;
};

struct ValidationConfig {
  // affects results
  std::filesystem::path cases;     ///< The folder with a folder for each source.
  std::vector<std::string> names;  ///< Only these sources; empty: all.
  bool quick = false;              ///< Only what takes seconds; what needs the rest is left out.
  // affects speed only
  int threads = 1;
  std::filesystem::path kept;  ///< Where finished runs are kept, so that they need not be run again; empty: nowhere.
  bool fresh = false;          ///< Runs everything again, whatever is kept.
};

/// Reads the sources, runs what is needed, judges.
class Validation {
 public:
  /// Fails, naming file, line and key, on a source that cannot be understood and on a name that is not there.
  static Result<Validation> open(const ValidationConfig& config);
  ~Validation();
  Validation(Validation&&) noexcept;
  Validation& operator=(Validation&&) noexcept;

  /// Called in this thread a few times a second with the runs done and all runs; returning false stops it. What was done is kept.
  using Watch = std::function<bool(std::size_t done, std::size_t all)>;
  /// True when all was run, false when it was stopped.
  Result<bool> run(const Watch& watch);

  /// After run(): why not all finished runs are kept, as on a full disk; empty if they are.
  const std::string& not_kept() const;

  /// After run(): in the order of the page.
  std::span<const SourceReport> reports() const;

  /// After run(): writes index.html and figures/*.svg.
  Result<void> write_page(const std::filesystem::path& folder) const;

 private:
  Validation();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple
