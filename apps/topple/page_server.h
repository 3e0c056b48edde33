/// The server of the page: on this machine's loopback alone, for one recording.
#pragma once

#include <expected>
#include <functional>
#include <memory>

#include "page_files.h"

namespace topple::app {

/// Appends the next bytes of an answer, or none yet; false once it is over.
using NextBytes = std::function<bool(std::string& bytes)>;
/// Why there is no answer.
struct Refusal {
  int status = 400;
  std::string words;
};

/// So that no other page can order anything here: only who has read this server's page knows it.
std::string make_token();

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

  /// Answers POST /token/run, of at most so many bytes, piece by piece as they come; a page that goes away ends it.
  void stream(const std::string& token, std::size_t most, std::function<std::expected<NextBytes, Refusal>(const std::string& body)> begin);

  std::string address() const;       ///< "http://127.0.0.1:8017/".
  bool serve_until(bool (*done)());  ///< Serves until `done()`, which is asked many times a second; false if the network gave up first.

 private:
  PageServer();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::app
