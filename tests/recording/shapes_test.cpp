// The piece that tells balls from boxes.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "topple/run.h"

namespace topple {
namespace {

std::vector<std::uint8_t> file_of(const std::string& text) {
  auto layout = read_layout(text, "test.toml");
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  auto recording = simulate(*std::move(layout), RigidConfig{.time_step = 0.003}, {.until = 0.04});
  REQUIRE(recording.has_value());
  RecordingWriter writer(*recording);
  std::vector<std::uint8_t> bytes = writer.begin();
  for (std::vector<std::uint8_t> more = writer.more(); !more.empty(); more = writer.more())
    bytes.insert(bytes.end(), more.begin(), more.end());
  const std::vector<std::uint8_t> end = writer.end();
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

bool has_shapes(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kName = "SHAP";
  return std::search(bytes.begin(), bytes.end(), kName.begin(), kName.end()) != bytes.end();
}

}  // namespace

TEST_CASE("a recording says which kinds are balls, and nothing where none is; it is read again either way") {
  const auto with = file_of("[[row]]\ncount = 2\ngap_mm = 10\n[[ball]]\nat_mm = [-50, 0]\nspeed_m_s = 1\n");
  CHECK(has_shapes(with));
  const auto again = read_recording(with, "test.topple");
  REQUIRE_MESSAGE(again.has_value(), again.error().message);
  CHECK(again->layout().kinds[1].shape == Shape::ball);
  CHECK(again->at(2, 0.03).velocity.x == doctest::Approx(1.0).epsilon(0.01));
  const auto without = file_of("[[row]]\ncount = 2\ngap_mm = 10\n[[push]]\nangular_speed_rad_s = 4\n");
  CHECK_FALSE(has_shapes(without));
  CHECK(read_recording(without, "test.topple").has_value());
}

}  // namespace topple
