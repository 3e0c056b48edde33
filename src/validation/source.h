/// A source as its folder describes it: what was published, how it is run, what is claimed. Read once, then constant.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "topple/base.h"

namespace topple::validation {

/// Another way to understand published numbers: all of them times a factor.
struct Reading {
  std::string name;
  double factor = 1.0;
};

/// Published points.
struct Points {
  std::string name;
  std::string solidity;  ///< How far they can be trusted: where they were read.
  std::vector<double> x, y;
  std::vector<double> error;  ///< Half an error bar, one for each point, in the unit of y.
  std::vector<Reading> readings;
  std::string label;    ///< In the figure's key; empty: not there.
  bool hidden = false;  ///< Not in the figure.
  bool line = false;    ///< A formula of others: drawn as a line.
};

/// A number that the source does not state, and its plausible values.
struct Unknown {
  std::string key;   ///< In the layout file.
  std::string name;  ///< For people.
  std::vector<std::string> models;
  std::vector<double> values;
  double standard = 0.0;  ///< One of the values.
};

/// How a series is drawn.
enum class Look : std::uint8_t { line, points, band, hidden };

/// Predictions of one model along x.
struct Series {
  std::string name;
  std::string model;
  std::string scene;                ///< File name inside the source's folder.
  std::string scene_text;           ///< What is in it.
  std::string take;                 ///< Which number of a run.
  double scale = 1.0;               ///< y is that number times this.
  std::vector<double> x;            ///< Along the axis.
  std::vector<std::string> values;  ///< What stands for {x} in `set`, one for each x.
  std::vector<std::string> set;     ///< Overrides of the scene; {x} and {seed} are replaced.
  int repeat = 1;                   ///< Runs with {seed} = 1, 2, ...
  double from = 0.2, to = 0.8;      ///< Speeds are between these bricks, as shares of the row.
  int window = 1;                   ///< A profile's speed is over so many bricks on either side.
  double until = 0.0;               ///< Stops a run at this time; 0: never [s].
  std::vector<double> least;        ///< {x} is sought between these two: the least at which all bricks fall.
  bool spread = false;              ///< Error bars are the standard deviation over the repeats.
  bool quick = false;
  std::string label;  ///< In the figure's key; empty: not there.
  Look look = Look::line;
  int color = 0;
  std::vector<Unknown> unknowns;  ///< Those of its source that its model has, if it is asked to vary them.
};

/// A series against points.
struct Compare {
  std::string name;
  std::string series;
  std::string points;
};

/// A statement that must hold. Exactly one of its forms is used: points with a tolerance; a value with bounds; a verdict.
struct Claim {
  std::string name;
  std::string why;
  std::string series;
  std::string points;            ///< Every point of these, within `tolerance`.
  std::optional<double> x;       ///< The series there,
  std::optional<double> over_x;  ///< divided by the series there, if given,
  std::string over_series;       ///< or by this series.
  std::optional<double> expect;  ///< Within `tolerance` of this, or
  double tolerance = 0.0;        ///< Relative.
  std::optional<double> low, high;
  std::string compare, reading;  ///< This comparison
  std::string verdict;           ///< has this verdict.
};

struct Figure {
  std::string x_label, y_label;
  std::vector<double> x_range, y_range;
  bool log_x = false, log_y = false;
  std::string caption;
};

struct Source {
  std::string name;  ///< Of its folder.
  std::string title;
  std::string kind;  ///< "theory", "experiment", "study".
  double order = 0.0;
  std::vector<std::string> references;  ///< Keys of docs/references.bib.
  std::string solidity;
  std::string states, does_not_state, inputs, conclusion;
  std::vector<Figure> figure;  ///< None or one.
  std::vector<Points> points;
  std::vector<Series> series;
  std::vector<Compare> compares;
  std::vector<Claim> claims;
};

/// Reads `folder`/source.toml and the scenes that it names.
Result<Source> read_source(const std::filesystem::path& folder);

/// Which unknowns are fixed at what: setting s of all combinations, the first unknown varying fastest.
std::size_t setting_count(const Series& series);
std::vector<double> setting_values(const Series& series, std::size_t setting);
std::size_t standard_setting(const Series& series);

}  // namespace topple::validation
