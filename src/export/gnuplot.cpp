#include "export/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

namespace topple {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPoints = 4000;  // More than a printed figure can show; keeps a figure of a million bricks small.

/// [okabeIto2008] without its yellow, which is too pale on white, in an order that keeps neighbours apart.
constexpr std::array<std::string_view, 7> kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
constexpr std::array<std::string_view, 5> kDashes = {"1", "(14,5)", "(4,4)", "(14,4,3,4)", "(24,6)"};

constexpr std::string_view kStyle = R"(set encoding utf8
set border 3 lc rgb '#333333' lw 0.8
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set grid lc rgb '#E2E2E2' lw 0.7 lt 1, lc rgb '#F1F1F1' lw 0.5 lt 1
set key Left reverse textcolor rgb '#222222' samplen 3.2 spacing 1.15
set style fill transparent solid 0.12 noborder
)";

/// A file without a name that is gone when it is closed.
using Scratch = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Scratch make_scratch() { return {std::tmpfile(), std::fclose}; }

/// What was written to a scratch file, at most its first lines.
std::string first_words(std::FILE* scratch) {
  std::array<char, 400> buffer{};
  if (std::fseek(scratch, 0, SEEK_SET) != 0) return {};
  const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), scratch);
  std::string words(buffer.data(), size);
  std::replace(words.begin(), words.end(), '\n', ' ');
  words.erase(0, words.find_first_not_of(" \t^"));
  return words;
}

/// Starts gnuplot without a shell and without anybody's start-up file; gives 0 or an error number.
int start_gnuplot(pid_t& child, int input, int output, int errors) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, errors, STDERR_FILENO);
  std::array<std::string, 3> words = {"gnuplot", "-d", "-"};
  std::array<char*, 4> arguments = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  const int problem = posix_spawnp(&child, "gnuplot", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return problem;
}

bool ended_well(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return false;
    }
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// gnuplot says nothing of a full disk and ends well, but then the end of the picture is not there.
bool is_whole(const fs::path& picture, std::string_view ending) {
  const std::string_view mark = ending == ".svg" ? "</svg>" : ending == ".png" ? "IEND" : "%%EOF";
  std::array<char, 64> last{};
  std::ifstream stream(picture, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream.tellg();
  const std::streamoff read = std::min(size, static_cast<std::streamoff>(last.size()));
  stream.seekg(size - read);
  stream.read(last.data(), read);
  return stream && read > 0 && std::string_view(last.data(), static_cast<std::size_t>(read)).find(mark) != std::string_view::npos;
}

/// Why a file takes no more bytes; empty if it takes them.
std::string full(std::FILE* file) {
  const std::array<char, 4096> some{};
  std::fseek(file, 0, SEEK_END);
  const bool taken = std::fwrite(some.data(), 1, some.size(), file) == some.size() && std::fflush(file) == 0;
  return taken ? std::string() : std::string(std::strerror(errno)) + ".";
}

/// Keeps of each bucket of a long curve its first, lowest, highest and last point.
std::vector<Point> thinned(const std::vector<Point>& points) {
  if (points.size() <= kMostPoints) {
    return points;
  }
  std::vector<Point> kept;
  const std::size_t buckets = kMostPoints / 4;
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t first = b * points.size() / buckets;
    const std::size_t last = (b + 1) * points.size() / buckets - 1;
    std::size_t low = first;
    std::size_t high = first;
    for (std::size_t i = first; i <= last; ++i) {
      low = points[i].y < points[low].y ? i : low;
      high = points[i].y > points[high].y ? i : high;
    }
    std::array<std::size_t, 4> chosen = {first, std::min(low, high), std::max(low, high), last};
    for (auto it = chosen.begin(); it != std::unique(chosen.begin(), chosen.end()) && it != chosen.end(); ++it) {
      kept.push_back(points[*it]);
    }
  }
  return kept;
}

}  // namespace

std::string decimal(double value) {
  std::array<char, 32> buffer{};
  const auto [end, problem] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return problem == std::errc() ? std::string(buffer.data(), end) : "NaN";
}

std::string rounded(double value, int digits) {
  std::array<char, 48> buffer{};
  const int size = std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return {buffer.data(), static_cast<std::size_t>(std::max(size, 0))};
}

std::string curve_color(std::size_t index) { return std::string(kColors[index % kColors.size()]); }

std::string curve_style(std::size_t index) {
  // Seven colours and five dashes have no common factor, so 35 curves differ.
  std::string style = "lc rgb '" + curve_color(index) + "' dt ";
  style += kDashes[index % kDashes.size()];
  return style + " lw 1.6";
}

Result<GnuplotScript> GnuplotScript::begin(const fs::path& path, int width, int height) {
  const std::string extension = path.extension().string();
  const auto size = [&](double scale, const char* unit) { return decimal(width * scale) + unit + "," + decimal(height * scale) + unit; };
  GnuplotScript script;
  if (extension == ".svg") {
    script.line("set terminal svg enhanced size " + size(1.0, "") +
                " font 'sans-serif,12' background '#ffffff' linewidth 1 dashlength 0.5");
  } else if (extension == ".png") {
    script.line("set terminal pngcairo enhanced size " + size(2.5, "") +
                " font 'sans-serif,9' fontscale 2.5 linewidth 2.5 pointscale 2.5 dashlength 0.5 background rgb '#ffffff'");
  } else if (extension == ".pdf") {
    script.line("set terminal pdfcairo enhanced size " + size(0.025, "cm") +
                " font 'sans-serif,8.5' fontscale 1 linewidth 0.75 pointscale 0.5 dashlength 0.5 background rgb '#ffffff'");
  } else {
    return failure("A figure's name must end in .svg, .png or .pdf; " + path.filename().string() + " does not.");
  }
  script.text_ += kStyle;
  return script;
}

GnuplotScript& GnuplotScript::line(std::string_view command) {
  text_ += command;
  text_ += '\n';
  return *this;
}

GnuplotScript& GnuplotScript::data(std::string_view name, const std::vector<Point>& points) {
  text_ += name;
  text_ += " << EOD\n";
  for (const Point& point : thinned(points)) {
    if (std::isfinite(point.x) && std::isfinite(point.y)) {
      text_ += decimal(point.x) + " " + decimal(point.y);
    }
    text_ += '\n';  // A line without numbers breaks the curve.
  }
  text_ += "EOD\n";
  return *this;
}

GnuplotScript& GnuplotScript::table(std::string_view name, const std::vector<std::vector<double>>& rows) {
  text_ += name;
  text_ += " << EOD\n";
  for (const std::vector<double>& row : rows) {
    const bool whole = std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
    for (std::size_t i = 0; whole && i < row.size(); ++i) text_ += (i == 0 ? "" : " ") + decimal(row[i]);
    text_ += '\n';
  }
  text_ += "EOD\n";
  return *this;
}

Result<void> draw(const GnuplotScript& script, const fs::path& path) {
  fs::path unfinished = path;
  unfinished += ".part";
  const Scratch input = make_scratch();
  const Scratch errors = make_scratch();
  const Scratch output(std::fopen(unfinished.c_str(), "wb"), std::fclose);
  if (output == nullptr) {
    return failure("The figure cannot be written to " + path.string() + ": " + std::strerror(errno) + ".");
  }
  const auto give_up = [&](const std::string& why) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    return failure("The figure " + path.string() + " cannot be drawn: " + why);
  };
  if (input == nullptr || errors == nullptr || std::fputs(script.text().c_str(), input.get()) < 0 || std::fflush(input.get()) != 0 ||
      std::fseek(input.get(), 0, SEEK_SET) != 0) {
    return give_up("its scratch files in " + std::string(P_tmpdir) + " cannot be written: " + std::strerror(errno) + ".");
  }
  pid_t child = 0;
  if (const int problem = start_gnuplot(child, fileno(input.get()), fileno(output.get()), fileno(errors.get())); problem != 0) {
    return give_up(problem == ENOENT ? std::string("gnuplot is not installed (Debian: gnuplot-nox).")
                                     : std::string("gnuplot does not start: ") + std::strerror(problem) + ".");
  }
  if (!ended_well(child)) {
    return give_up("gnuplot says: " + first_words(errors.get()));
  }
  std::error_code problem;
  if (!is_whole(unfinished, path.extension().string())) {
    const std::string why = full(output.get());
    return give_up(!why.empty() ? why : "gnuplot gave no whole picture. " + first_words(errors.get()));
  }
  fs::rename(unfinished, path, problem);
  return problem ? give_up(problem.message() + ".") : Result<void>();
}

}  // namespace topple
