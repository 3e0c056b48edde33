#include "progress.h"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "text.h"

namespace topple::app {
namespace {

constexpr std::chrono::milliseconds kQuiet{1000};         // A run shorter than this shows nothing.
constexpr std::chrono::milliseconds kBarInterval{100};    // Smooth to the eye.
constexpr std::chrono::milliseconds kLineInterval{5000};  // Few lines in a log.
constexpr int kBarWidth = 24;                             // The whole line fits 80 columns up to 50 million bricks.

std::string bar(double share) {
  const int filled = static_cast<int>(share * kBarWidth);
  return std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
}

}  // namespace

Progress::Progress() : start_(Clock::now()), next_(start_ + kQuiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { clear(); }

void Progress::show(const RunProgress& progress) {
  const Clock::time_point now = Clock::now();
  if (now < next_) {
    return;
  }
  next_ = now + (terminal_ ? kBarInterval : kLineInterval);
  const double wall = std::chrono::duration<double>(now - start_).count();
  const std::string words = grouped(progress.arrived) + " of " + count_of(progress.bricks, "brick") +
                            formatted(", %.1f s, %.1f x real time", progress.time, progress.time / wall);
  if (terminal_) {
    const double share = progress.bricks > 0 ? static_cast<double>(progress.arrived) / static_cast<double>(progress.bricks) : 0.0;
    std::fprintf(stderr, "\r[%s] %s\033[K", bar(share).c_str(), words.c_str());
    drawn_ = true;
  } else {
    std::fprintf(stderr, "%s\n", words.c_str());
  }
  std::fflush(stderr);
}

void Progress::clear() {
  if (drawn_) {
    std::fprintf(stderr, "\r\033[K");
    std::fflush(stderr);
    drawn_ = false;
  }
}

}  // namespace topple::app
