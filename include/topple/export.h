/// Files: the only chapter that knows paths. Layouts, images and recordings in; recordings, tables, HDF5, glTF, plots and plans out.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "topple/measure.h"
#include "topple/picture.h"
#include "topple/recording.h"

namespace topple {

/// Reads a layout file; a missing file, a directory or bad UTF-8 is an error in words.
Result<Layout> load_layout(const std::filesystem::path& path, std::span<const std::string> overrides = {});

/// Reads an image, PNG or JPEG of at most 100 million pixels, whatever its name ends in, turned as its camera
/// says. What is no such image is an error in words.
Result<Image> load_image(const std::filesystem::path& path);

/// Reads a `.topple` file.
Result<Recording> load_recording(const std::filesystem::path& path);

/// Writes a recording while it grows, under `path`.part until finish() renames it. It may be created inside RunConfig::watch:
/// it stays valid when the recording is moved, not when it is destroyed.
class RecordingFile {
 public:
  static Result<RecordingFile> create(const Recording& recording, const std::filesystem::path& path);
  ~RecordingFile();
  RecordingFile(RecordingFile&&) noexcept;
  RecordingFile& operator=(RecordingFile&&) noexcept;
  Result<void> append();  ///< What was finished since the last call.
  void let_go();          ///< RecordingWriter::let_go(): of what is on disk.
  Result<void> finish();

 private:
  RecordingFile();
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes any file; one of that name stays as it was until the new one is whole.
Result<void> save_bytes(std::string_view bytes, const std::filesystem::path& path);

Result<void> save_recording(const Recording& recording, const std::filesystem::path& path);
Result<void> export_knots_csv(const Recording& recording, const std::filesystem::path& path);
Result<void> export_events_csv(const Recording& recording, const std::filesystem::path& path);
/// The time sheet (measure_parts), a line a part.
Result<void> export_times_csv(const Recording& recording, const std::filesystem::path& path);
Result<void> export_hdf5(const Recording& recording, const std::filesystem::path& path);

struct GltfConfig {
  /// Straight keyframes, so many a second, for programs that leave out the tangents of curves [1/s]; 0: the curves of the recording.
  double frames = 0.0;
};
/// Writes an animated scene as binary glTF 2.0 (docs/gltf.md): in metres and seconds, y up, a node a brick. The curves of free tracks are
/// those of the recording; those of hinged ones are within Recording::tolerance() of it. More than 4 GiB is an error.
Result<void> export_gltf(const Recording& recording, const GltfConfig& config, const std::filesystem::path& path);

enum class Figure : std::uint8_t { motion, arrival, speed, energy };
struct PlotConfig {
  Figure figure = Figure::motion;
  std::vector<BrickId> bricks;  ///< Of a motion figure; empty: the first few that moved.
};
/// Draws with gnuplot; the format follows the path's extension: .svg, .png or .pdf.
Result<void> plot(const Recording& recording, const PlotConfig& config, const std::filesystem::path& path);

/// A plan for the table: the whole layout from above, true to scale.
struct PlanConfig {
  double scale = 0.0;  ///< N of 1:N, 1 to 100,000; 0: the largest usual one (1, 2, 2.5, 5, 10 ...) at which one sheet holds the layout.
  std::string paper;   ///< "A4" to "A0" or "letter"; empty: the smallest of A4 to A0 on which bricks can be told apart.
};
/// What was drawn.
struct PlanSheets {
  double scale = 0.0;
  std::string paper;   ///< Empty: an SVG of a size of its own.
  int sheets = 1;      ///< Besides the first page, which shows how they lie, where there are several.
  bool bricks = true;  ///< Every brick is drawn; otherwise rows are lines, since a brick would be thinner than 0.3 mm.
};
/// Draws a plan, as PDF or SVG as the path ends in .pdf or .svg. What does not fit one sheet at the scale goes over several, PDF alone;
/// an SVG is as large as the scale needs. A scale or a paper that cannot be, a layout without bricks, or more than 500 sheets is an error
/// in words. The same layout gives the same bytes on one machine.
Result<PlanSheets> draw_plan(const Layout& layout, const PlanConfig& config, const std::filesystem::path& path);

/// How the error of an integrator shrinks with its time step.
struct ErrorCurve {
  std::string name;                ///< For the legend; of our own words.
  std::vector<double> time_steps;  ///< Falling [s].
  std::vector<double> errors;      ///< Of the angle [rad].
  double slope = 0.0;              ///< Of log(error) against log(time step).
};
/// Draws the curves on logarithmic axes, with their slopes in the legend.
Result<void> plot_convergence(std::span<const ErrorCurve> curves, const std::filesystem::path& path);

/// A file of lines that grows with a long job, each a JSON object: what was finished is there after a kill, and is not done again.
class KeptLines {
 public:
  /// Reads what is there and appends from then on; `fresh` begins anew. A last line that was cut off is left out. Makes the folder it is
  /// in. Refuses a file that holds anything else, and a place that cannot be written. An empty path keeps nothing.
  static Result<KeptLines> open(const std::filesystem::path& path, bool fresh);

  std::span<const std::string> lines() const { return lines_; }  ///< Those that were there.
  void add(const std::string& line);
  const std::string& problem() const { return problem_; }  ///< Why not all that was added is on disk; empty if it is.

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::filesystem::path path_;
  std::vector<std::string> lines_;
  std::string problem_;
};

}  // namespace topple
