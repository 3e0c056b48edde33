/// A browser without a window that draws one address, for `topple render`.
#pragma once

#include <filesystem>
#include <string>

#include "topple/base.h"

namespace topple::app {

class FilmBrowser {
 public:
  /// Starts Chromium ($TOPPLE_CHROMIUM, or the one that is installed) on the address.
  static Result<FilmBrowser> start(const std::string& address);
  ~FilmBrowser();  ///< Ends it, and removes what it kept.
  FilmBrowser(FilmBrowser&& other) noexcept;
  FilmBrowser& operator=(FilmBrowser&&) = delete;

  bool running();                  ///< False once it has ended by itself.
  std::string last_words() const;  ///< The end of what it said.

 private:
  FilmBrowser() = default;
  int process_ = -1;
  std::filesystem::path folder_;  ///< Its profile and its log.
};

}  // namespace topple::app
