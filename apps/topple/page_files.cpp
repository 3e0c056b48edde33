#include "page_files.h"

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

namespace topple::app {
namespace {

namespace fs = std::filesystem;

std::string content_type(const fs::path& file) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kTypes = {{{".html", "text/html; charset=utf-8"},
                                                                                     {".js", "text/javascript; charset=utf-8"},
                                                                                     {".mjs", "text/javascript; charset=utf-8"},
                                                                                     {".css", "text/css; charset=utf-8"},
                                                                                     {".json", "application/json"},
                                                                                     {".map", "application/json"},
                                                                                     {".wasm", "application/wasm"},
                                                                                     {".svg", "image/svg+xml"},
                                                                                     {".png", "image/png"},
                                                                                     {".jpg", "image/jpeg"},
                                                                                     {".webp", "image/webp"},
                                                                                     {".ico", "image/x-icon"},
                                                                                     {".woff2", "font/woff2"},
                                                                                     {".txt", "text/plain; charset=utf-8"},
                                                                                     {".webmanifest", "application/manifest+json"}}};
  const std::string extension = file.extension().string();
  for (const auto& [known, type] : kTypes) {
    if (extension == known) {
      return std::string(type);
    }
  }
  return "application/octet-stream";
}

Result<std::string> read_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) {
    return failure("The page's file " + file.string() + " cannot be read.");
  }
  return bytes;
}

bool holds_page(const fs::path& folder) {
  std::error_code unknown;
  return fs::is_regular_file(folder / "index.html", unknown);
}

/// Where the page may be, seen from the program: in the tree it was built in, or installed.
std::vector<fs::path> places_beside_program() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  if (unknown) {
    return {};
  }
  const fs::path folder = program.parent_path();
  // build/release/topple, build/<preset>/apps/topple/topple, bin/topple.
  return {folder / "../../studio/dist", folder / "../../../../studio/dist", folder / "../share/topple/studio"};
}

}  // namespace

Result<Site> read_page(const fs::path& folder) {
  Site site;
  std::error_code problem;
  for (fs::recursive_directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    if (it->is_symlink() || !it->is_regular_file()) {
      continue;
    }
    Result<std::string> bytes = read_bytes(it->path());
    if (!bytes) {
      return std::unexpected(bytes.error());
    }
    std::string address = "/";
    address += it->path().lexically_relative(folder).generic_string();
    site[address] = {content_type(it->path()), std::move(*bytes), "no-cache"};
  }
  if (problem) {
    return failure("The page's folder " + folder.string() + " cannot be read: " + problem.message() + ".");
  }
  const auto index = site.find("/index.html");
  if (index == site.end()) {
    return failure("The folder " + folder.string() + " has no index.html, so it is not the page.");
  }
  site["/"] = index->second;
  return site;
}

Result<fs::path> find_page() {
  if (const char* chosen = std::getenv("TOPPLE_STUDIO"); chosen != nullptr && *chosen != '\0') {
    if (!holds_page(chosen)) {
      return failure("TOPPLE_STUDIO is " + std::string(chosen) +
                     ", where there is no index.html; it must be the folder of the built page.");
    }
    return fs::path(chosen);
  }
  std::string looked;
  for (const fs::path& place : places_beside_program()) {
    if (holds_page(place)) {
      return place.lexically_normal();
    }
    looked += "\n  " + place.lexically_normal().string();
  }
  return failure("The page is not built: there is no index.html in" + looked +
                 "\nBuild it with `npm ci && npm run build` in studio/ (./run does), or name its folder in TOPPLE_STUDIO.");
}

}  // namespace topple::app
