#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "topple/sweep.h"

using namespace topple;

namespace {

const std::string kPush = "[[push]]\nangular_speed_rad_s = 4\n";

// Seven bricks, and behind a wide gap five more.
std::string gap_of(double gap_mm) {
  return kPush + "[[row]]\ncount = 7\npitch_mm = 24\n[[row]]\nfrom_mm = [" + std::to_string(6 * 24.0 + 7.5 + gap_mm) +
         ", 0]\ncount = 5\npitch_mm = 24\n";
}

RiskStudy study_of(const std::string& text, const PlacementError& error, int threads = 1) {
  Result<RiskStudy> study = RiskStudy::begin(read_layout(text, "test").value(), error, {.threads = threads});
  REQUIRE_MESSAGE(study.has_value(), (study ? "" : study.error().message));
  return std::move(*study);
}

void run(RiskStudy& study, std::int64_t runs) {
  const Result<void> done = study.run(runs, [](const PlacedRun&) {}, [] { return true; });
  REQUIRE_MESSAGE(done.has_value(), (done ? "" : done.error().message));
}

std::string told(const RiskStudy& study) {
  std::string out;
  for (const PlacedRun& run : study.done()) {
    out += std::to_string(run.seed) + (run.built ? " " : " not built ") + std::to_string(run.last_arrival);
    for (const BrickRange& range : run.standing) out += " " + std::to_string(range.first) + "-" + std::to_string(range.last);
    out += "\n";
  }
  return out;
}

}  // namespace

TEST_CASE("the interval of a share is that of Wilson") {
  // [Wilson1927] with z = 1.96: 5 of 10 gives 0.2366 to 0.7634, none of 10 gives 0 to z^2 / (10 + z^2) = 0.2775.
  const Share half{5, 10}, none{0, 10}, all{10, 10};
  CHECK(half.value() == 0.5);
  CHECK(half.low() == doctest::Approx(0.23659).epsilon(1e-4));
  CHECK(half.high() == doctest::Approx(0.76341).epsilon(1e-4));
  CHECK(none.low() == 0.0);
  CHECK(none.high() == doctest::Approx(0.27753).epsilon(1e-4));
  CHECK(all.low() == doctest::Approx(1.0 - 0.27753).epsilon(1e-4));
  CHECK(all.high() == 1.0);
  CHECK(std::isnan(Share{}.value()));
  CHECK(Share{}.high() == 1.0);
}

TEST_CASE("bricks that are exactly in their places fall in every run, at the same time") {
  RiskStudy study = study_of(kPush + "[[row]]\ncount = 12\npitch_mm = 24\n", {.position = 0.0, .heading = 0.0});
  run(study, 3);
  const Risk risk = study.risk();
  CHECK(risk.runs == 3);
  CHECK(risk.whole.count == 3);
  CHECK(risk.links == 12);
  CHECK(risk.weak.empty());
  CHECK(risk.least_tested == 3);
  CHECK(risk.arrival == measure_wave(study.exact()).arrival.back());
  CHECK(risk.arrival_spread == 0.0);
}

TEST_CASE("a gap as wide as a brick reaches is the weakest link, and what is behind it is asked only where the wave came") {
  // Exactly in its place the seventh brick reaches the eighth; half of all errors of 1.5 mm along the row are away from it.
  RiskStudy study = study_of(gap_of(46.0), {.position = 0.0015, .heading = 0.0});
  run(study, 24);
  const Risk risk = study.risk();
  REQUIRE(risk.runs == 24);
  REQUIRE_FALSE(risk.weak.empty());
  CHECK(risk.weak.front().brick == 7);
  CHECK(risk.weak.front().from == 6);
  CHECK(risk.weak.front().stops.of == 24);
  CHECK(risk.weak.front().stops.count > 0);
  CHECK(risk.whole.count == 24 - risk.weak.front().stops.count);
  REQUIRE(risk.parts.size() == 2);
  CHECK(study.layout().parts[risk.parts.front().part].name == "row 2");
  CHECK(risk.parts.front().stops.count == risk.weak.front().stops.count);
  // The bricks behind were asked for only in the runs that came to them.
  CHECK(risk.least_tested == risk.whole.count);
}

TEST_CASE("what falls beside a line does not count as standing when it stood from the beginning") {
  RiskStudy study = study_of(gap_of(80.0), {});
  run(study, 2);
  const Risk risk = study.risk();
  CHECK(summarize(study.exact()).standing == 5);
  CHECK(risk.links == 7);
  CHECK(risk.whole.count == 2);
}

TEST_CASE("a study does not depend on threads, and goes on where another one stopped") {
  const PlacementError error{.position = 0.0015, .heading = 0.05};
  RiskStudy one = study_of(gap_of(44.0), error), two = study_of(gap_of(44.0), error, 2), resumed = study_of(gap_of(44.0), error);
  run(one, 9);
  run(two, 9);
  CHECK(told(one) == told(two));
  for (std::size_t i : {4U, 1U, 4U}) resumed.add(one.done()[i]);
  CHECK(resumed.done().size() == 2);
  CHECK(resumed.key() == one.key());
  run(resumed, 9);
  CHECK(told(resumed) == told(one));
  CHECK(study_of(gap_of(44.0), {.position = 0.0016, .heading = 0.05}).key() != one.key());
  const auto key_of = [&error](double gap_mm) {
    return RiskStudy::begin(read_layout(gap_of(gap_mm), "test").value(), error, {.until = 9.0}).value().key();
  };
  CHECK(key_of(43.0) != key_of(44.0));
}

TEST_CASE("a study that is told to stop keeps what is whole") {
  RiskStudy study = study_of(kPush + "[[row]]\ncount = 12\npitch_mm = 24\n", {});
  int finished = 0;
  const Result<void> done = study.run(50, [&finished](const PlacedRun&) { ++finished; }, [&finished] { return finished < 3; });
  CHECK(done.has_value());
  CHECK(finished == 3);
  CHECK(study.done().size() == 3);
}

TEST_CASE("bricks that would be in one place are put right by the hand, so their run does not count") {
  RiskStudy study = study_of("[[push]]\nangular_speed_rad_s = 10\n[[row]]\ncount = 12\ngap_mm = 2\n", {.position = 0.001, .heading = 0.0});
  run(study, 8);
  const Risk risk = study.risk();
  CHECK(risk.not_built > 0);
  CHECK(risk.runs + risk.not_built == 8);
}

TEST_CASE("the errors of a study replace those that the layout has itself") {
  const std::string row = kPush + "[[row]]\ncount = 12\npitch_mm = 24\n";
  RiskStudy plain = study_of(row, {.position = 0.001, .heading = 0.0});
  RiskStudy noisy = study_of(row + "[noise]\nseed = 5\nposition_mm = 3\nheading_deg = 9\n", {.position = 0.001, .heading = 0.0});
  run(plain, 3);
  run(noisy, 3);
  CHECK(told(plain) == told(noisy));
}

TEST_CASE("a layout of which nothing falls is refused in words") {
  const Result<RiskStudy> study = RiskStudy::begin(read_layout("[[row]]\ncount = 3\npitch_mm = 24\n", "still.toml").value(), {});
  REQUIRE_FALSE(study.has_value());
  CHECK(study.error().message.find("still.toml: no brick of a line falls") == 0);
}

TEST_CASE("a wall that is struck is no line: its bricks are no links") {
  RiskStudy study = study_of(kPush + "[[row]]\ncount = 4\npitch_mm = 24\n[[wall]]\nat_mm = [100, 0]\ncount = 2\ncourses = 2\n",
                             {.position = 0.0, .heading = 0.0});
  run(study, 1);
  CHECK(study.layout().brick_count() > 4);
  CHECK(summarize(study.exact()).fallen > 4);
  CHECK(study.risk().links == 4);
}
