#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "topple/export.h"
#include "topple/run.h"

namespace topple {

TEST_CASE("in the scenes of rows and curves every brick falls") {
  for (const std::string name : {"row_default", "row_mixed", "noise", "s_curve", "curve_u"}) {
    const auto layout = load_layout(TOPPLE_SOURCE_DIR "/scenes/" + name + ".toml");
    REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
    const auto config = model_config(*layout);
    REQUIRE_MESSAGE(config.has_value(), config.error().message);
    const auto recording = simulate(*layout, *config);
    REQUIRE_MESSAGE(recording.has_value(), recording.error().message);
    CHECK_MESSAGE(summarize(*recording).fallen == layout->brick_count(), name);
  }
}

TEST_CASE("no track of a scene runs back in time") {
  // Knots are rounded to a grid; in the bends of the U-turn two hits of one brick lie closer than that.
  for (const std::string name : {"row_default", "row_mixed", "noise", "s_curve", "curve_u"}) {
    const auto layout = load_layout(TOPPLE_SOURCE_DIR "/scenes/" + name + ".toml", std::vector<std::string>{"model.name=hinge"});
    REQUIRE_MESSAGE(layout.has_value(), layout.error().message);
    const auto recording = simulate(*layout, *model_config(*layout));
    REQUIRE_MESSAGE(recording.has_value(), recording.error().message);
    for (std::int64_t i = 0; i < recording->track_count(); ++i) {
      const Track track = recording->track(i);
      const bool ascends =
          std::is_sorted(track.hinged.begin(), track.hinged.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
      CHECK_MESSAGE(ascends, name, ", brick ", track.brick);
    }
  }
}

}  // namespace topple
