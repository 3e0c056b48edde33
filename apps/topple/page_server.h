/// The server of the page: on this machine's loopback alone, for one recording.
#pragma once

#include <functional>
#include <memory>

#include "page_files.h"

namespace topple::app {

class PageServer {
 public:
  /// `port` 0: 8017 or the next free one. A port that was asked for and is taken is an error.
  static Result<PageServer> listen(Site site, int port);
  ~PageServer();
  PageServer(PageServer&&) noexcept;
  PageServer& operator=(PageServer&&) noexcept;

  /// Takes what the page sends to /token/WHAT: called with WHAT and the bytes, in the server's threads, one at a time. Nothing else is
  /// taken.
  void receive(const std::string& token, std::function<void(const std::string& what, std::string bytes)> take);

  std::string address() const;       ///< "http://127.0.0.1:8017/".
  bool serve_until(bool (*done)());  ///< Serves until `done()`, which is asked many times a second; false if the network gave up first.

 private:
  PageServer();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::app
