#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "export/output_file.h"
#include "topple/export.h"

namespace topple {
namespace {

/// Lines of a table, written in large pieces; numbers the same in every language of the machine.
class Table {
 public:
  explicit Table(OutputFile file) : file_(std::move(file)) {}

  void head(std::string_view columns) { text_ = std::string(columns) + "\n"; }

  /// A cell; the shortest number that reads back as the same bits, empty where there is none.
  template <typename Number>
  Table& cell(Number number) {
    separate();
    if constexpr (std::is_floating_point_v<Number>) {
      if (std::isnan(number)) return *this;
      number += Number{0};  // No minus before a zero.
    }
    std::array<char, 64> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    text_.append(digits.data(), end.ptr);
    return *this;
  }
  Table& word(std::string_view word) {
    separate();
    text_ += word;
    return *this;
  }
  Table& skip(int cells = 1) {
    for (int i = 0; i < cells; ++i) separate();
    return *this;
  }
  Result<void> end_line() {
    text_ += '\n';
    fresh_ = true;
    if (text_.size() < kPiece) return {};
    return write();
  }
  Result<void> finish() {
    if (auto written = write(); !written) return written;
    return file_.finish();
  }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 20;

  void separate() {
    if (!fresh_) text_ += ',';
    fresh_ = false;
  }
  Result<void> write() {
    auto written = file_.write(text_);
    text_.clear();
    return written;
  }

  OutputFile file_;
  std::string text_;
  bool fresh_ = true;
};

Result<Table> create(const std::filesystem::path& path, std::string_view columns) {
  auto file = OutputFile::create(path, OutputFile::Unfinished::removed);
  if (!file) return std::unexpected(file.error());
  Table table(std::move(*file));
  table.head(columns);
  return table;
}

// What a place that was kept as a float against the brick's foot is worth in the world: 10 nm.
double in_steps(double metres) { return std::isnan(metres) ? metres : std::round(metres * 1e8) / 1e8; }

void add_brick(Table& table, BrickId brick) {
  if (brick == kNoBrick) {
    table.skip();
  } else {
    table.cell(brick);
  }
}

void add_pose(Table& table, const Pose& pose) {
  table.cell(pose.position.x).cell(pose.position.y).cell(pose.position.z);
  table.cell(pose.orientation.w).cell(pose.orientation.x).cell(pose.orientation.y).cell(pose.orientation.z);
}

Result<void> add_track(Table& table, const Layout& layout, const Track& track) {
  for (const HingedKnot& knot : track.hinged) {
    table.cell(track.brick).cell(track.start + double{knot.time}).cell(knot.angle).cell(knot.rate).cell(knot.acceleration);
    add_pose(table, hinged_pose(layout, track.brick, double{knot.angle}));
    if (auto done = table.skip(6).end_line(); !done) return done;
  }
  for (const FreeKnot& knot : track.free) {
    table.cell(track.brick).cell(track.start + double{knot.time}).skip(3);
    const Vec3 offset{knot.x, knot.y, knot.z};
    add_pose(table, {standing_pose(layout, track.brick).position + offset, {knot.qw, knot.qx, knot.qy, knot.qz}});
    table.cell(knot.vx).cell(knot.vy).cell(knot.vz).cell(knot.wx).cell(knot.wy).cell(knot.wz);
    if (auto done = table.end_line(); !done) return done;
  }
  return {};
}

}  // namespace

Result<void> export_knots_csv(const Recording& recording, const std::filesystem::path& path) {
  auto table = create(path,
                      "brick,time_s,angle_rad,angular_velocity_rad_s,angular_acceleration_rad_s2,x_m,y_m,z_m,qw,qx,qy,qz,"
                      "vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s");
  if (!table) return std::unexpected(table.error());
  for (std::int64_t i = 0; i < recording.track_count(); ++i) {
    if (auto done = add_track(*table, recording.layout(), recording.track(i)); !done) return done;
  }
  return table->finish();
}

Result<void> export_events_csv(const Recording& recording, const std::filesystem::path& path) {
  auto table = create(path, "time_s,event,brick,by,force_n,impulse_n_s,x_m,y_m,z_m");
  if (!table) return std::unexpected(table.error());
  for (std::int64_t i = 0; i < recording.event_count(); ++i) {
    const Event event = recording.event(i);
    table->cell(event.time).word(name_of(event.kind)).cell(event.brick);
    add_brick(*table, event.by);
    // Both were kept as floats.
    table->cell(static_cast<float>(event.force)).cell(static_cast<float>(event.impulse));
    table->cell(in_steps(event.point.x)).cell(in_steps(event.point.y)).cell(in_steps(event.point.z));
    if (auto done = table->end_line(); !done) return done;
  }
  return table->finish();
}

Result<void> export_times_csv(const Recording& recording, const std::filesystem::path& path) {
  auto table = create(path,
                      "part,bricks,fallen,reached,first_brick,last_brick,first_arrival_s,last_arrival_s,bricks_per_s,speed_m_s,"
                      "from_part,from_brick,pushed_at_s,start");
  if (!table) return std::unexpected(table.error());
  const Layout& layout = recording.layout();
  for (const PartTimes& times : measure_parts(recording)) {
    const Part& part = layout.parts[times.part];
    table->word(part.name).cell(part.count).cell(times.fallen).cell(times.reached);
    add_brick(*table, times.first);
    add_brick(*table, times.last);
    table->cell(times.first_arrival).cell(times.last_arrival).cell(times.brick_rate).cell(times.speed);
    const Part* const from = times.from == kNoBrick ? nullptr : layout.part_of(times.from);
    table->word(from == nullptr ? std::string_view() : std::string_view(from->name));
    add_brick(*table, times.from);
    table->cell(times.pushed_at);
    if (times.start < 0) {
      table->skip();
    } else {
      table->cell(times.start);
    }
    if (auto done = table->end_line(); !done) return done;
  }
  return table->finish();
}

}  // namespace topple
