#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "export/folder.h"
#include "recording/scripted_model.h"
#include "topple/export.h"

using namespace topple;
using namespace topple::scripted;

namespace {

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

class EventfulScript : public HingedScript {
 public:
  using HingedScript::HingedScript;
  std::span<const Event> events() const override { return step_count() == 30 ? std::span<const Event>{events_} : std::span<const Event>{}; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Event> events_ = {{0.0149, EventKind::struck, 1, 0, 5.0703, 0.0021, {0.0203, -0.0, 0.0426}},
                                {0.015, EventKind::arrived, 0, kNoBrick, kNone, kNone, {kNone, kNone, kNone}}};
};

Recording three_bricks() {
  EventfulScript script(wave(3), 0.0005);
  auto layout = read_layout("[[row]]\ncount = 3\npitch_mm = 24\n", "three.toml");
  REQUIRE(layout.has_value());
  return record(std::move(*layout), script);
}

}  // namespace

TEST_CASE("a recording that is saved and loaded has the same tracks") {
  const Folder folder("saved");
  const Recording before = three_bricks();
  REQUIRE(save_recording(before, folder / "run.topple").has_value());
  const auto after = load_recording(folder / "run.topple");
  REQUIRE_MESSAGE(after.has_value(), after.error().message);
  CHECK(after->track_count() == before.track_count());
  CHECK(after->at(2, 0.1).hinge.angle == before.at(2, 0.1).hinge.angle);
  CHECK_FALSE(std::filesystem::exists(folder / "run.topple.part"));
}

TEST_CASE("an unfinished recording stays under its temporary name and can be read") {
  const Folder folder("killed");
  const Recording recording = three_bricks();
  {
    auto file = RecordingFile::create(recording, folder / "run.topple");
    REQUIRE(file.has_value());
    REQUIRE(file->append().has_value());
  }
  CHECK_FALSE(std::filesystem::exists(folder / "run.topple"));
  const auto read = load_recording(folder / "run.topple.part");
  REQUIRE_MESSAGE(read.has_value(), read.error().message);
  CHECK(read->track_count() == recording.track_count());
  CHECK(read->end().reason == EndReason::running);
}

TEST_CASE("files that cannot be are errors in words") {
  const Folder folder("wrong");
  const Recording recording = three_bricks();
  CHECK(load_recording(folder / "none.topple").error().message.find("No such file") != std::string::npos);
  CHECK(load_recording(folder / "").error().message.find("is a directory") != std::string::npos);
  CHECK(save_recording(recording, folder / "no/such/run.topple").error().message.find("cannot be written") != std::string::npos);
  CHECK(export_events_csv(recording, folder / "").error().message.find("is a directory") != std::string::npos);
}

TEST_CASE("the table of events has the documented columns, and is empty where a model has nothing") {
  const Folder folder("events");
  REQUIRE(export_events_csv(three_bricks(), folder / "events.csv").has_value());
  const auto lines = lines_of(folder / "events.csv");
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == "time_s,event,brick,by,force_n,impulse_n_s,x_m,y_m,z_m");
  CHECK(lines[1] == "0.0149,struck,1,0,5.0703,0.0021,0.0203,0,0.0426");
  CHECK(lines[2] == "0.015,arrived,0,,,,,,");
}

TEST_CASE("the table of knots has a line a knot and as many cells as columns") {
  const Folder folder("knots");
  const Recording recording = three_bricks();
  REQUIRE(export_knots_csv(recording, folder / "knots.csv").has_value());
  const auto lines = lines_of(folder / "knots.csv");
  std::size_t knots = 0;
  for (std::int64_t i = 0; i < recording.track_count(); ++i) knots += recording.track(i).hinged.size();
  REQUIRE(lines.size() == knots + 1);
  for (const std::string& line : lines) CHECK(std::count(line.begin(), line.end(), ',') == 17);
  CHECK(lines[0].starts_with("brick,time_s,angle_rad,"));
}

TEST_CASE("h5py reads an exported run by the documented names") {
  const Folder folder("hdf5");
  const Recording recording = three_bricks();
  const auto exported = export_hdf5(recording, folder / "run.h5");
  REQUIRE_MESSAGE(exported.has_value(), exported.error().message);
  CHECK_FALSE(std::filesystem::exists(folder / "run.h5.part"));
  // Debian's python3, for which there is a package of h5py.
  const auto quoted = [](const std::string& path) { return "'" + path + "'"; };
  const std::string command = "/usr/bin/python3 " + quoted(TOPPLE_SOURCE_DIR "/tests/export/read_hdf5.py") + " " +
                              quoted((folder / "run.h5").string()) + " > " + quoted((folder / "found.json").string());
  REQUIRE(std::system(command.c_str()) == 0);
  const std::string found = lines_of(folder / "found.json").at(0);
  const auto says = [&](const std::string& what) { return found.find(what) != std::string::npos; };
  INFO(found);
  CHECK(says("\"format\": \"Topple recording\""));
  CHECK(says("\"model\": \"scripted\""));
  CHECK(says("\"layout\": \"[[row]]\\ncount = 3\\npitch_mm = 24\\n\""));
  CHECK(says("\"reason\": \"at_rest\""));
  CHECK(says("\"bricks\": 3"));
  CHECK(says("\"foot\": [0.048, 0.0, 0.0]"));
  CHECK(says("\"tracks\": 3"));
  CHECK(says("\"force\": 5.0703"));
  CHECK(says("\"no_force\": true"));
  CHECK(says("\"by\": [0, -1]"));
  CHECK(says("\"samples\": " + std::to_string(recording.energy().size())));
  CHECK(says("\"stride\": 1"));
}

TEST_CASE("an HDF5 file that cannot be written is an error in words") {
  const Folder folder("hdf5_wrong");
  const Recording recording = three_bricks();
  CHECK(export_hdf5(recording, folder / "").error().message.find("is a directory") != std::string::npos);
  CHECK(export_hdf5(recording, folder / "no/such/run.h5").error().message.find("cannot be written as HDF5") != std::string::npos);
}
