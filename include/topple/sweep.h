/// Many runs of one layout, its bricks put down anew for each as a hand does: where is it likely to stop?
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "topple/measure.h"
#include "topple/run.h"

namespace topple {

/// How far from its place a brick is put down: standard deviations of normal errors, as [noise] of the layout file has them.
struct PlacementError {
  double position = 0.0005;  ///< Along x, and along y [m].
  double heading = 0.03;     ///< [rad]
};

/// Some of all, and what that says of the share that is behind it.
struct Share {
  std::int64_t count = 0;
  std::int64_t of = 0;

  double value() const;  ///< Not a number where `of` is 0.
  double low() const;    ///< Of the 95 % interval [Wilson1927]; 0 where `of` is 0.
  double high() const;   ///< 1 where `of` is 0.
};

/// Bricks with numbers that follow each other.
struct BrickRange {
  BrickId first = 0;
  BrickId last = 0;  ///< Itself included.
};

/// What one run came to.
struct PlacedRun {
  std::uint64_t seed = 0;
  bool built = true;                 ///< Not where two bricks would have been in one place: a hand puts that right.
  std::vector<BrickRange> standing;  ///< Bricks that fall when all are exactly in their places, and did not.
  double last_arrival = std::numeric_limits<double>::quiet_NaN();  ///< When the wave reached its last brick [s].
};

/// A brick of a line that falls when all are exactly in their places, and the one that strikes it then.
struct Link {
  BrickId from = kNoBrick;  ///< kNoBrick: it is pushed.
  BrickId brick = kNoBrick;
  Share stops;  ///< Runs in which `brick` did not fall, of those in which `from` did.
};

/// The links into the bricks of one part.
struct PartRisk {
  std::size_t part = 0;    ///< Of Layout::parts.
  std::int64_t links = 0;  ///< How many there are.
  Share stops;             ///< Runs in which one of them stopped, of those that came to one.
};

/// What all runs came to.
struct Risk {
  std::int64_t runs = 0;          ///< That were built.
  std::int64_t not_built = 0;     ///< In which two bricks would have been in one place.
  Share whole;                    ///< Runs in which every brick fell that falls when all are exactly in their places.
  double arrival = 0.0;           ///< When the wave reached its last brick, mean of the whole runs [s]; not a number without any.
  double arrival_spread = 0.0;    ///< Standard deviation of that [s].
  std::vector<Link> weak;         ///< Links that stopped at least once; the weakest first.
  std::vector<PartRisk> parts;    ///< Parts that have links, the weakest first.
  std::int64_t links = 0;         ///< All there are.
  std::int64_t least_tested = 0;  ///< Of those that never stopped, the fewest runs that came to one.
};

/// Runs a layout again and again with other seeds. Seed s gives the same bricks, and so the same run, on every machine.
class RiskStudy {
 public:
  /// Runs the layout once with every brick exactly in its place: what falls then is what ought to fall. Of `config` it takes `until`,
  /// threads and lanes; where that has no `until`, every later run may take twice as long as this one and five seconds.
  /// Refuses what the model refuses, and a layout of which nothing falls.
  static Result<RiskStudy> begin(const Layout& layout, const PlacementError& error, const RunConfig& config = {});

  /// Runs seeds 1 to `runs` but for those that are there already, config.threads of them side by side. `finished` gets each in this
  /// thread, `go_on` is asked by any thread some twenty times a second; when it says no, runs under way are given up. Fails where the
  /// model refuses bricks that are not exactly in their places.
  Result<void> run(std::int64_t runs, const std::function<void(const PlacedRun&)>& finished, const std::function<bool()>& go_on);
  /// One seed's run, for those who share out the runs themselves; it is not added. Nothing where `go_on` said no; without one it
  /// runs to its end. Any number of threads at once may ask.
  Result<std::optional<PlacedRun>> run_seed(std::uint64_t seed, const std::function<bool()>& go_on) const;
  void add(PlacedRun run);  ///< One of an earlier study with the same key; a seed that is there already is left as it is.
  std::span<const PlacedRun> done() const { return runs_; }  ///< In the order of their seeds.

  const Layout& layout() const { return exact_.layout(); }  ///< With every brick exactly in its place.
  const Recording& exact() const { return exact_; }         ///< Its run.
  const PlacementError& error() const { return error_; }
  std::string key() const;  ///< Of layout, model, errors and version: runs of studies with the same key belong together.
  Risk risk() const;        ///< Of what has been run so far.

 private:
  RiskStudy(Recording exact, const PlacementError& error, const RunConfig& config);
  void count_links(Risk& risk) const;
  bool waits_for(std::size_t brick, std::span<const std::uint8_t> fell) const;
  void list_links(Risk& risk, std::span<const Share> stops) const;

  Recording exact_;
  PlacementError error_;
  RunConfig config_;
  std::vector<BrickId> from_;        // Of each brick that is a link; kNoBrick of all others.
  std::vector<std::uint8_t> ought_;  // Whether each brick falls.
  std::vector<PlacedRun> runs_;
};

}  // namespace topple
