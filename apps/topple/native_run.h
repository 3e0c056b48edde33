/// Runs that the page asks of the program: the same recording, piece by piece, from an engine that is not the browser's.
#pragma once

#include <expected>
#include <functional>
#include <string>

#include "page_files.h"
#include "page_server.h"

namespace topple::app {

/// From so many bricks on the page asks the program rather than its own engine: a few seconds' work, for which starting a run here pays.
inline constexpr int kNativeBricks = 3'000;

/// Begins runs of layouts given as text, one at a time.
class NativeRuns {
 public:
  explicit NativeRuns(int threads, int lanes = 0) : threads_(threads), lanes_(lanes) {}

  /// Answers the page's orders under a token, and tells the page in its head where to send them.
  void offer(Site& site) const;
  void serve(PageServer& server) const;

 private:
  int threads_ = 1;
  int lanes_ = 0;
  std::string token_ = make_token();
};

}  // namespace topple::app
