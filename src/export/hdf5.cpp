// The names in the file are documented in docs/hdf5.md; people's scripts use them.
#include <array>
#include <functional>
#include <system_error>

#include "export/hdf5_file.h"
#include "export/output_file.h"
#include "topple/export.h"

namespace topple {
namespace {

using hdf5::Handle;
using hdf5::Writer;

constexpr std::int64_t kAtOnce = 65536;

void write_recipe(Writer& file, const Recording& recording) {
  const Recipe& recipe = recording.recipe();
  const Layout& layout = recording.layout();
  const RunEnd& end = recording.end();
  file.attribute("/", "format", "Topple recording");
  file.attribute("/", "format_version", std::int32_t{1});
  file.attribute("/", "title", layout.title);
  file.attribute("/", "gravity_m_s2", layout.gravity);
  file.attribute("/", "duration_s", recording.duration());
  file.attribute("/", "tolerance", recording.tolerance());
  file.group("recipe", "enough to run it again");
  file.attribute("recipe", "topple_version", recipe.version);
  file.attribute("recipe", "model", recipe.model);
  file.attribute("recipe", "time_step_s", recipe.time_step);
  file.attribute("recipe", "layout_name", layout.name);
  std::string overrides;
  for (const std::string& entry : layout.overrides) overrides += entry + "\n";
  file.text("recipe/overrides", overrides, "key=value, a line each");
  file.text("recipe/layout_toml", layout.text, "the layout file");
  file.group("end", "how the run ended");
  file.attribute("end", "reason", name_of(end.reason));
  file.attribute("end", "words", end.words);
  file.attribute("end", "brick", end.brick);
  file.attribute("end", "steps", end.step);
  file.attribute("end", "time_s", end.time);
  file.attribute("end", "hash", end.hash);
}

/// One number or a few of every item; written in portions, so that a long run is not held twice.
template <typename T>
void column(Writer& file, const std::string& name, std::string_view unit, std::string_view meaning, std::size_t columns, std::int64_t items,
            const std::function<void(std::int64_t, std::vector<T>&)>& add) {
  const Handle table = file.table(name, hdf5::type_of(T{}), columns, unit, meaning);
  std::vector<T> numbers;
  for (std::int64_t i = 0; i < items; ++i) {
    add(i, numbers);
    const bool last = i + 1 == items;
    if (numbers.size() < static_cast<std::size_t>(kAtOnce) * columns && !last) continue;
    // In whole chunks, so that none is written twice.
    const std::size_t chunk = hdf5::kRowsInChunk * columns;
    const std::size_t now = last ? numbers.size() : numbers.size() / chunk * chunk;
    file.append(table, std::span<const T>(numbers).first(now));
    numbers.erase(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(now));
  }
}

void write_kinds(Writer& file, const Layout& layout) {
  std::vector<double> numbers;
  std::string names;
  for (const BrickKind& kind : layout.kinds) {
    const Surface& s = kind.surface;
    numbers.insert(numbers.end(), {kind.height, kind.width, kind.thickness, kind.mass, s.brick_friction, s.floor_friction,
                                   s.brick_restitution, s.floor_restitution});
    names += kind.name + "\n";
  }
  file.group("kinds", "what many bricks share");
  file.write("kinds/numbers", std::span<const double>(numbers), 8, "m, m, m, kg, 1, 1, 1, 1",
             "height, width, thickness, mass, brick friction, floor friction, brick restitution, floor restitution");
  file.text("kinds/names", names, "a line each");
}

void write_bricks(Writer& file, const Layout& layout) {
  const std::int64_t count = layout.brick_count();
  const auto brick = [&](std::int64_t i) -> const Brick& { return layout.bricks[static_cast<std::size_t>(i)]; };
  file.group("bricks", "as they were put down; row i is brick i");
  column<double>(file, "bricks/foot", "m", "centre of the face it stands on: x, y, z", 3, count, [&](std::int64_t i, auto& out) {
    const Vec3& foot = brick(i).foot;
    out.insert(out.end(), {foot.x, foot.y, foot.z});
  });
  column<double>(file, "bricks/heading", "rad", "the way it falls, from +x, counter-clockwise", 1, count,
                 [&](std::int64_t i, auto& out) { out.push_back(brick(i).heading); });
  column<std::uint16_t>(file, "bricks/kind", "", "row of kinds/numbers", 1, count,
                        [&](std::int64_t i, auto& out) { out.push_back(brick(i).kind); });
  column<std::uint8_t>(file, "bricks/color", "", "red, green, blue, 0 to 255", 3, count, [&](std::int64_t i, auto& out) {
    const Color& color = layout.colors[brick(i).color];
    out.insert(out.end(), {color.red, color.green, color.blue});
  });
  column<std::uint8_t>(file, "bricks/stance", "", "0 standing, 1 flat, 2 on its side", 1, count,
                       [&](std::int64_t i, auto& out) { out.push_back(static_cast<std::uint8_t>(brick(i).stance)); });
}

void write_track_heads(Writer& file, const Recording& recording) {
  const std::int64_t count = recording.track_count();
  std::int64_t hinged = 0;
  std::int64_t free = 0;
  file.group("tracks", "one brick's motion from waking to rest, or a piece of it; row i is track i");
  column<std::int32_t>(file, "tracks/brick", "", "whose motion", 1, count,
                       [&](std::int64_t i, auto& out) { out.push_back(recording.track(i).brick); });
  column<double>(file, "tracks/start", "s", "when it begins", 1, count,
                 [&](std::int64_t i, auto& out) { out.push_back(recording.track(i).start); });
  column<std::int64_t>(file, "tracks/hinged_knots", "", "rows of tracks/hinged: first, count", 2, count, [&](std::int64_t i, auto& out) {
    const auto knots = static_cast<std::int64_t>(recording.track(i).hinged.size());
    out.insert(out.end(), {hinged, knots});
    hinged += knots;
  });
  column<std::int64_t>(file, "tracks/free_knots", "", "rows of tracks/free: first, count", 2, count, [&](std::int64_t i, auto& out) {
    const auto knots = static_cast<std::int64_t>(recording.track(i).free.size());
    out.insert(out.end(), {free, knots});
    free += knots;
  });
}

void write_knots(Writer& file, const Recording& recording) {
  const std::int64_t count = recording.track_count();
  column<float>(file, "tracks/hinged", "s, rad, rad/s, rad/s^2",
                "time since the track's start, angle, rate, acceleration; between two rows the quintic Hermite polynomial", 4, count,
                [&](std::int64_t i, auto& out) {
                  for (const HingedKnot& k : recording.track(i).hinged) out.insert(out.end(), {k.time, k.angle, k.rate, k.acceleration});
                });
  column<float>(
      file, "tracks/free", "s, m, m, m, 1, 1, 1, 1, m/s, m/s, m/s, rad/s, rad/s, rad/s",
      "time since the track's start, centre of mass against the brick as put down, orientation w x y z, velocity, angular velocity", 14,
      count, [&](std::int64_t i, auto& out) {
        for (const FreeKnot& k : recording.track(i).free) {
          out.insert(out.end(), {k.time, k.x, k.y, k.z, k.qw, k.qx, k.qy, k.qz, k.vx, k.vy, k.vz, k.wx, k.wy, k.wz});
        }
      });
}

void write_events(Writer& file, const Recording& recording) {
  const std::int64_t count = recording.event_count();
  file.group("events", "in the order of time; what a model does not have is not a number");
  column<double>(file, "events/time", "s", "when", 1, count, [&](std::int64_t i, auto& out) { out.push_back(recording.event(i).time); });
  column<std::uint8_t>(file, "events/kind", "", "0 pushed, 1 struck, 2 arrived, 3 landed, 4 missed, 5 rested", 1, count,
                       [&](std::int64_t i, auto& out) { out.push_back(static_cast<std::uint8_t>(recording.event(i).kind)); });
  column<std::int32_t>(file, "events/brick", "", "which brick", 1, count,
                       [&](std::int64_t i, auto& out) { out.push_back(recording.event(i).brick); });
  column<std::int32_t>(file, "events/by", "", "by which brick, -1 for none", 1, count,
                       [&](std::int64_t i, auto& out) { out.push_back(recording.event(i).by); });
  column<double>(file, "events/force", "N", "force of a hit", 1, count,
                 [&](std::int64_t i, auto& out) { out.push_back(recording.event(i).force); });
  column<double>(file, "events/impulse", "N s", "impulse of a hit", 1, count,
                 [&](std::int64_t i, auto& out) { out.push_back(recording.event(i).impulse); });
  column<double>(file, "events/point", "m", "where: x, y, z", 3, count, [&](std::int64_t i, auto& out) {
    const Vec3 point = recording.event(i).point;
    out.insert(out.end(), {point.x, point.y, point.z});
  });
}

void write_trails(Writer& file, const Recording& recording) {
  std::vector<double> time, kinetic, potential, push_work;
  for (const EnergySample& sample : recording.energy()) {
    time.push_back(sample.time);
    kinetic.push_back(sample.energy.kinetic);
    potential.push_back(sample.energy.potential);
    push_work.push_back(sample.energy.push_work);
  }
  file.group("energy", "of all bricks through time");
  file.write("energy/time", std::span<const double>(time), 1, "s", "when");
  file.write("energy/kinetic", std::span<const double>(kinetic), 1, "J", "of motion");
  file.write("energy/potential", std::span<const double>(potential), 1, "J", "of height, against all bricks as put down");
  file.write("energy/push_work", std::span<const double>(push_work), 1, "J", "put in by pushes so far");
  file.group("hashes", "the model's hash; row i of value belongs to step (i + 1) * stride");
  file.attribute("hashes", "stride", recording.hashes().stride);
  file.write("hashes/value", std::span<const std::uint64_t>(recording.hashes().values), 1, "", "hash");
}

}  // namespace

Result<void> export_hdf5(const Recording& recording, const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return failure(path.string() + ": is a directory, not a file to write");
  const std::filesystem::path part = part_of(path);
  auto file = Writer::create(part);
  if (!file) {
    std::filesystem::remove(part, code);
    return failure(path.string() + ": " + file.error().message);
  }
  write_recipe(*file, recording);
  write_kinds(*file, recording.layout());
  write_bricks(*file, recording.layout());
  write_track_heads(*file, recording);
  write_knots(*file, recording);
  write_events(*file, recording);
  write_trails(*file, recording);
  if (auto finished = file->finish(); !finished) {
    std::filesystem::remove(part, code);
    return failure(path.string() + ": " + finished.error().message);
  }
  std::filesystem::rename(part, path, code);
  if (code) return failure(path.string() + ": cannot be given its name: " + code.message());
  return {};
}

}  // namespace topple
