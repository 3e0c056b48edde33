#include "progress.h"

#include <unistd.h>

#include <algorithm>
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
  show(progress.bricks > 0 ? static_cast<double>(progress.arrived) / static_cast<double>(progress.bricks) : 0.0, [&](double wall) {
    return grouped(progress.arrived) + " of " + count_of(progress.bricks, "brick") +
           formatted(", %.1f s, %.1f x real time", progress.time, progress.time / wall);
  });
}

void Progress::show(std::int64_t done, std::int64_t of, const std::string& noun) {
  show(static_cast<double>(done) / static_cast<double>(of), [&](double wall) {
    const double left = wall / static_cast<double>(std::max<std::int64_t>(done, 1)) * static_cast<double>(of - done);
    return grouped(done) + " of " + count_of(of, noun) + (done > 0 ? formatted(", about %.0f s to go", left) : "");
  });
}

void Progress::show(double share, const std::function<std::string(double wall)>& words) {
  const Clock::time_point now = Clock::now();
  if (now < next_) {
    return;
  }
  next_ = now + (terminal_ ? kBarInterval : kLineInterval);
  const std::string said = words(std::chrono::duration<double>(now - start_).count());
  if (terminal_) {
    std::fprintf(stderr, "\r[%s] %s\033[K", bar(share).c_str(), said.c_str());
    drawn_ = true;
  } else {
    std::fprintf(stderr, "%s\n", said.c_str());
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
