#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "topple/export.h"
#include "topple/run.h"

namespace topple {
namespace {

RunEnd end_of(const std::string& scene, const std::vector<std::string>& overrides) {
  const auto layout = load_layout(TOPPLE_SOURCE_DIR "/scenes/" + scene, overrides);
  REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
  const auto config = model_config(*layout);
  REQUIRE_MESSAGE(config.has_value(), config.error().message);
  const auto recording = simulate(*layout, *config);
  REQUIRE_MESSAGE(recording.has_value(), recording.error().message);
  return recording->end();
}

}  // namespace

TEST_CASE("a row that falls is at rest") {
  const RunEnd end = end_of("report_row.toml", {"row.0.count=5"});
  CHECK(end.reason == EndReason::at_rest);
  CHECK(end.brick == kNoBrick);
  CHECK(end.words == "everything is at rest");
}

TEST_CASE("a gap wider than a brick is high ends the wave by a miss") {
  // 49 mm against a height of 43.53 mm.
  const RunEnd end = end_of("report_row.toml", {"row.0.gap_mm=49"});
  CHECK(end.reason == EndReason::wave_died);
  CHECK(end.brick == 0);
  CHECK(end.words == "the wave died at brick 0: it fell flat without reaching brick 1");
}

TEST_CASE("a brick that was pushed too softly stands again") {
  const RunEnd end = end_of("report_returns.toml", {});
  CHECK(end.reason == EndReason::wave_died);
  CHECK(end.words == "the wave died at brick 0: it stands again: it was moved too slowly to pass its tip angle");
}

TEST_CASE("on a slippery floor the end tells how far the foot slid") {
  // At a floor friction of 0.01 no brick can tip another one: it slides before it tilts.
  const RunEnd end = end_of("row_default.toml", {"model.name=\"rigid\"", "row.0.count=6", "contact.floor_friction=0.01"});
  CHECK(end.reason == EndReason::wave_died);
  CHECK_MESSAGE(end.words.find(": it slid ") != std::string::npos, end.words);
}

}  // namespace topple
