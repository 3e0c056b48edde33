#include <doctest/doctest.h>

#include <string>

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

}  // namespace topple
