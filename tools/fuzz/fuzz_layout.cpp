// Any bytes are either a layout that holds what a layout promises, or an error in words. A byte 0x1E ends the file and each override.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "layout/text.h"
#include "topple/layout.h"

namespace {

void require(bool claim, const char* what) {
  if (claim) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

bool finite(const topple::Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_message(const std::string& message, const std::string& name) {
  require(!message.empty(), "an error says something");
  std::size_t lines = 0;
  for (std::size_t at = 0; at <= message.size(); ++lines) {
    const std::string line = message.substr(at, message.find('\n', at) - at);
    require(line.starts_with(name) || line.starts_with("--set ") || line.starts_with("and "), "every line of an error has its place");
    require(topple::printable(line, line.size()) == line, "an error is UTF-8 without control characters");
    at += line.size() + 1;
  }
  require(lines <= 51, "at most fifty problems are listed");
}

void check_layout(const topple::Layout& layout) {
  require(layout.brick_count() > 0, "a layout has bricks");
  topple::BrickId next = 0;
  for (const topple::Part& part : layout.parts) {
    require(part.first == next && part.count > 0, "parts follow each other");
    next += part.count;
  }
  require(next == layout.brick_count(), "every brick has its part");
  for (const topple::Brick& brick : layout.bricks) {
    require(finite(brick.foot) && std::isfinite(brick.heading), "bricks are somewhere");
    require(brick.kind < layout.kinds.size() && brick.color < layout.colors.size(), "bricks have a kind and a colour");
  }
  for (const topple::BrickKind& kind : layout.kinds) {
    require(kind.height > 0.0 && kind.width > 0.0 && kind.thickness > 0.0 && kind.mass > 0.0 && std::isfinite(kind.mass),
            "kinds are solid");
  }
  for (const topple::Push& push : layout.pushes) require(push.brick >= 0 && push.brick < layout.brick_count(), "pushes have their brick");
  const topple::LayoutSummary summary = topple::summarize(layout);
  require(finite(summary.low) && finite(summary.high) && std::isfinite(summary.length), "a summary is finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  std::vector<std::string> pieces(1);
  for (std::size_t i = 0; i < count; ++i) {
    if (bytes[i] == 0x1E) {
      pieces.emplace_back();
    } else {
      pieces.back() += static_cast<char>(bytes[i]);
    }
  }
  const std::vector<std::string> overrides(pieces.begin() + 1, pieces.end());
  const auto layout = topple::read_layout(pieces.front(), "fuzz.toml", overrides);
  if (layout) {
    check_layout(*layout);
  } else {
    check_message(layout.error().message, "fuzz.toml");
  }
  return 0;
}
