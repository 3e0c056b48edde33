/// The page's own files, read once: what is not among them cannot be served.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "topple/base.h"

namespace topple::app {

/// What the server answers to one address.
struct Content {
  std::string type;  ///< As the browser is told.
  std::string bytes;
  std::string cache;  ///< Cache-Control.
};
/// By address, "/assets/index.js". "/" is the page itself.
using Site = std::map<std::string, Content>;

/// Every regular file below the folder; links are left out, so nothing outside it can get in.
Result<Site> read_page(const std::filesystem::path& folder);

/// The folder with the built page: $TOPPLE_STUDIO, or beside the program as it was built or installed.
Result<std::filesystem::path> find_page();

}  // namespace topple::app
