// Verdicts, claims, mistakes in a source's file, and finished runs that are kept; on rows of hinged bricks, which run in milliseconds.
#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "topple/validation.h"

using namespace topple;

namespace {

namespace fs = std::filesystem;

constexpr const char* kRow = R"([[push]]
brick = 0
angular_speed_rad_s = 8.0
[[row]]
count = 60
gap_mm = 15
)";

// [vanLeeuwen2010]: 0.9586 m/s at friction 0.2, 0.8550 at 0.3 (V 1.24606 times 0.68622 m/s).
constexpr const char* kSource = R"(title = "A row"
kind = "theory"
solidity = "computed"
states = "s"
inputs = "i"
conclusion = "{y|row|15|4} m/s"
[[unknown]]
key = "contact.brick_friction"
name = "brick friction"
models = ["hinge"]
values = [0.1, 0.2, 0.3]
default = 0.2
[figure]
x_label = "Gap [mm]"
y_label = "Speed [m/s]"
caption = "c"
[[points]]
name = "points"
x = [15.0]
y = [SPEED]
error = [0.002]
[[series]]
name = "row"
model = "hinge"
scene = "row.toml"
take = "speed_m_s"
x = [15.0]
set = ["row.0.gap_mm={x}"]
from = 0.6
to = 0.9
vary = true
look = "band"
[[compare]]
name = "hinge"
series = "row"
points = "points"
[[claim]]
name = "the speed"
series = "row"
points = "points"
tolerance = 0.002
why = "the points are good to 0.002 m/s"
)";

/// A folder of sources with one source in it; gone in the end.
class Sources {
 public:
  explicit Sources(const std::string& speed, const std::string& more = {}) {
    folder_ = fs::temp_directory_path() / ("topple_validation_" + std::to_string(getpid()));
    fs::create_directories(folder_ / "row");
    std::ofstream(folder_ / "row" / "row.toml") << kRow;
    std::string text = kSource;
    text.replace(text.find("SPEED"), 5, speed);
    std::ofstream(folder_ / "row" / "source.toml") << text << more;
  }
  ~Sources() { fs::remove_all(folder_); }
  Sources(const Sources&) = delete;
  Sources& operator=(const Sources&) = delete;

  const fs::path& folder() const { return folder_; }
  ValidationConfig config() const { return {.cases = folder_, .kept = folder_ / "kept.jsonl"}; }

  SourceReport report() const {
    Result<Validation> validation = Validation::open(config());
    REQUIRE_MESSAGE(validation.has_value(), (validation ? std::string() : validation.error().message));
    const Result<bool> ran = validation->run({});
    REQUIRE_MESSAGE(ran.has_value(), (ran ? std::string() : ran.error().message));
    REQUIRE(*ran);
    REQUIRE(validation->reports().size() == 1);
    return validation->reports()[0];
  }

 private:
  fs::path folder_;
};

}  // namespace

TEST_CASE("a_point_at_the_default_friction_agrees_and_its_claim_holds") {
  const SourceReport report = Sources("0.9586").report();
  CHECK(report.comparisons.at(0).verdict == Verdict::agrees);
  CHECK(report.claims.at(0).holds);
}

TEST_CASE("a_point_that_another_plausible_friction_meets_agrees_for_some_and_the_claim_at_defaults_fails") {
  const SourceReport report = Sources("0.8551").report();
  CHECK(report.comparisons.at(0).verdict == Verdict::agrees_for_some);
  CHECK(report.comparisons.at(0).best.starts_with("brick friction 0.3"));
  CHECK(report.comparisons.at(0).point_fits == "0.3");
  CHECK(report.comparisons.at(0).worst_default == doctest::Approx(0.9586 / 0.8551 - 1.0).epsilon(0.01));
  CHECK(!report.claims.at(0).holds);
}

TEST_CASE("a_point_that_no_plausible_friction_meets_does_not_agree") {
  const SourceReport report = Sources("0.5").report();
  CHECK(report.comparisons.at(0).verdict == Verdict::does_not_agree);
  CHECK(report.comparisons.at(0).worst_best == doctest::Approx(0.855 / 0.5 - 1.0).epsilon(0.01));
  CHECK(report.comparisons.at(0).point_fits == "above 0.3");
}

TEST_CASE("a_misspelt_key_is_refused_with_its_line") {
  const Sources sources("0.9586", "[[claim]]\nname = \"n\"\nwhy = \"w\"\nserie = \"row\"\n");
  const Result<Validation> validation = Validation::open(sources.config());
  REQUIRE(!validation.has_value());
  CHECK(validation.error().message.find("source.toml:46: serie: there is no such key") != std::string::npos);
}

TEST_CASE("a_source_that_is_not_there_is_named_with_those_that_are") {
  const Sources sources("0.9586");
  ValidationConfig config = sources.config();
  config.names = {"column"};
  const Result<Validation> validation = Validation::open(config);
  REQUIRE(!validation.has_value());
  CHECK(validation.error().message == "There is no source \"column\"; there are row.");
}

TEST_CASE("finished_runs_are_kept_and_not_run_again_even_behind_a_line_that_was_cut_off") {
  const Sources sources("0.9586");
  sources.report();
  std::ofstream(sources.folder() / "kept.jsonl", std::ios::app) << "{\"run\":\"0.1";
  Result<Validation> again = Validation::open(sources.config());
  REQUIRE(again.has_value());
  std::size_t asked = 99;
  const Result<bool> ran = again->run([&asked](std::size_t, std::size_t all) {
    asked = all;
    return true;
  });
  CHECK((ran.has_value() && *ran));
  CHECK(asked == 0);
  CHECK(again->reports()[0].claims.at(0).holds);
}

TEST_CASE("a_validation_that_is_stopped_says_so_and_goes_on_later") {
  const Sources sources("0.9586");
  Result<Validation> validation = Validation::open(sources.config());
  REQUIRE(validation.has_value());
  const Result<bool> ran = validation->run([](std::size_t, std::size_t) { return false; });
  REQUIRE(ran.has_value());
  CHECK(sources.report().claims.at(0).holds);
}
