// Rows side by side, and the line that starts them one after the other.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/trigonometry.h"
#include "layout/style.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr Range kAngularSpeed{0.0, 10000.0};  // [rad/s]
// Where the line splits one brick strikes two side by side, each this far aside: an eighth of the width is free between them.
constexpr double kSplit = 9.0 / 16.0;  // of the width
// A row turns off the line on an arc of at least this radius, so that neighbours do not meet on its inner side.
constexpr double kTurnRadius = 3.0;      // widths
constexpr double kLeastRowPitch = 3.0;   // widths: the next split stands clear of the arc before
constexpr std::int64_t kLeastSteps = 3;  // bricks of the line from row to row: they bring it back to where it was

void read_starter(Section& section, const PartPlan& plan, double width, FieldPlan& field) {
  constexpr std::array<std::string_view, 3> kStarters{"none", "line", "pushes"};
  field.starter = static_cast<FieldPlan::Starter>(section.word("starter", kStarters).value_or(0));
  field.angular_speed = section.number("angular_speed_rad_s", kAngularSpeed).value_or(0.0);
  const bool pushes = field.starter == FieldPlan::Starter::pushes;
  if (pushes && !section.has("angular_speed_rad_s"))
    section.missing("angular_speed_rad_s must be there: how each row's first brick is pushed");
  if (!pushes && section.has("angular_speed_rad_s")) section.problem("angular_speed_rad_s", "goes with the starter \"pushes\" alone");
  if (field.starter != FieldPlan::Starter::line || !section.good()) return;
  if (plan.stance != Stance::standing) section.problem("pose", "must be \"standing\" where the starter is a line");
  const double least = std::fmax(kLeastRowPitch * width, (static_cast<double>(kLeastSteps) - 0.5) * field.pitch);
  if (field.row_pitch < least) {
    section.problem("row_pitch_mm", "must be at least " + number_text(std::ceil(least * 1e6) / 1e3) +
                                        " where the starter is a line, so that it can turn into every row; is " +
                                        number_text(field.row_pitch * 1000.0));
  }
  field.steps = static_cast<std::int64_t>(std::floor(field.row_pitch / field.pitch + 0.5));
  field.turn = static_cast<std::int64_t>(std::ceil(0.5 * kPi * kTurnRadius * width / field.pitch));
}

void check_size(Section& section, const FieldPicture& picture, std::int64_t rows, std::int64_t count) {
  if (rows != picture.rows)
    section.problem("rows", "must be the " + count_text(picture.rows) + " lines of the picture, is " + count_text(rows));
  if (count == picture.count) return;
  const std::string letters = "the " + count_text(picture.count) + " letters of each of the picture's lines";
  section.problem(section.has("count") ? "count" : "length_mm", section.has("count")
                                                                    ? "must be " + letters + ", is " + count_text(count)
                                                                    : "gives rows of " + count_text(count) + " bricks, not " + letters);
}

/// The picture's colours over the rows, behind their line and turns; strokes of a brush over those.
std::vector<PaintStroke> painted(const FieldPicture& picture, std::int64_t line_bricks, std::int64_t turn_bricks,
                                 const std::vector<PaintStroke>& over) {
  std::vector<PaintStroke> paint;
  for (std::int64_t row = 0; row < picture.rows; ++row)
    paint_row(picture, row, line_bricks + row * (turn_bricks + picture.count) + turn_bricks, paint);
  paint.insert(paint.end(), over.begin(), over.end());
  return paint;
}

}  // namespace

std::optional<PartPlan> read_field(Section& section, std::vector<BrickKind>& kinds) {
  PartPlan plan = read_style(section, kinds);
  const Extents size = extents(kinds[plan.kind], plan.stance);
  FieldPlan field;
  field.from = section.point("from_mm", 3).value_or(Vec3{});
  field.heading_deg = section.number("heading_deg", kHeading).value_or(0.0);
  const std::optional<FieldPicture> picture = read_picture(section);
  const auto rows = section.has("rows") || !picture ? section.whole("rows", 1, kMaxBricks) : picture->rows;
  if (!section.has("rows") && !section.has("picture")) section.missing("rows must be there: how many there are side by side");
  const auto row_pitch = section.number("row_pitch_mm", kPitch);
  if (!section.has("row_pitch_mm")) section.missing("row_pitch_mm must be there: from one row to the next");
  // A picture with a mistake says nothing of how many there are, but they need not be said elsewhere.
  const auto counted = section.has("picture") ? std::optional(picture ? picture->count : 1) : std::nullopt;
  const auto line = read_line(section, plan, kinds, counted);
  if (picture && line) check_size(section, *picture, rows.value_or(picture->rows), line->count);
  if (!line || !rows || !row_pitch || !section.good()) return std::nullopt;
  field.rows = *rows;
  field.count = line->count;
  field.pitch = line->pitch;
  field.row_pitch = *row_pitch / 1000.0;
  constexpr double kLastDigits = 1e-9;
  if (field.rows > 1 && field.row_pitch < size.across * (1.0 - kLastDigits)) {
    section.problem("row_pitch_mm", "must be at least the brick's " + number_text(size.across * 1000.0) +
                                        " across its heading, or the rows overlap; is " + number_text(*row_pitch));
  }
  read_starter(section, plan, size.across, field);
  if (!section.good()) return std::nullopt;
  if (field.count + field.turn + field.steps > kMaxBricks / field.rows) {
    section.missing("would take more than the " + count_text(kMaxBricks) + " bricks that are allowed");
    return std::nullopt;
  }
  const bool with_line = field.starter == FieldPlan::Starter::line;
  const std::int64_t line_bricks = with_line ? field.rows * field.steps - field.steps + 2 : 0, turn_bricks = with_line ? field.turn + 1 : 0;
  plan.count = line_bricks + field.rows * (turn_bricks + field.count);
  if (picture) plan.paint = painted(*picture, line_bricks, turn_bricks, plan.paint);
  plan.shape = field;
  return plan;
}

namespace {

/// The line runs to the left of the rows' heading. At each row one of its bricks strikes two: one begins the turn into the row, the other
/// goes on, and the next few bricks step back to where the line was.
class StartedField {
 public:
  StartedField(const FieldPlan& field, double width, BrickLayer& layer)
      : field_(field), layer_(layer), along_(direction_of(field.heading_deg)), left_{-along_.y, along_.x, 0.0}, aside_(kSplit * width) {
    step_ = field.row_pitch / static_cast<double>(field.steps);
    radius_ = static_cast<double>(field.turn) * field.pitch / (0.5 * kPi);
  }

  void put_line() {
    const double heading = radians(field_.heading_deg + 90.0);
    layer_.put(place(0.0, 0.0), heading);
    for (std::int64_t row = 0; row < field_.rows; ++row) {
      const std::int64_t steps = row + 1 < field_.rows ? field_.steps : 1;
      for (std::int64_t k = 1; k <= steps; ++k) {
        const double back = static_cast<double>(k - 1) / static_cast<double>(field_.steps - 1);
        // Late rather than early: first the turn beside it has to get away.
        layer_.put(place(-aside_ * (1.0 - back * back), start(row) + static_cast<double>(k) * step_), heading);
      }
    }
  }

  void put_row(std::int64_t row) {
    const double from = start(row) + step_;
    for (std::int64_t k = 0; k <= field_.turn; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(field_.turn);
      const SinCos turned = sin_cos(0.5 * kPi * share);
      layer_.put(place(aside_ + radius_ * (1.0 - turned.cos), from + radius_ * turned.sin),
                 radians(field_.heading_deg + 90.0 * (1.0 - share)));
    }
    for (std::int64_t i = 1; i <= field_.count; ++i)
      layer_.put(place(aside_ + radius_ + static_cast<double>(i) * field_.pitch, from + radius_), radians(field_.heading_deg));
  }

 private:
  double start(std::int64_t row) const { return static_cast<double>(row) * field_.row_pitch; }
  Vec3 place(double ahead, double aside) const { return field_.from + ahead * along_ + aside * left_; }

  const FieldPlan& field_;
  BrickLayer& layer_;
  Vec3 along_, left_;
  double aside_ = 0.0, step_ = 0.0, radius_ = 0.0;  // [m]
};

}  // namespace

void put_field(const PartPlan& plan, const FieldPlan& field, BrickLayer& layer) {
  StartedField started(field, extents(layer.layout().kinds[plan.kind], plan.stance).across, layer);
  const bool with_line = field.starter == FieldPlan::Starter::line;
  if (with_line) {
    started.put_line();
    layer.close_part(plan.name + " line", true);
  }
  const Vec3 along = direction_of(field.heading_deg), left{-along.y, along.x, 0.0};
  for (std::int64_t row = 0; row < field.rows; ++row) {
    const BrickId first = layer.layout().brick_count();
    if (with_line) {
      started.put_row(row);
    } else {
      const Vec3 from = field.from + (static_cast<double>(row) * field.row_pitch) * left;
      for (std::int64_t i = 0; i < field.count; ++i)
        layer.put(from + (static_cast<double>(i) * field.pitch) * along, radians(field.heading_deg));
    }
    layer.close_part(plan.name + " row " + std::to_string(row + 1), true);
    if (field.starter == FieldPlan::Starter::pushes) layer.layout().pushes.push_back({first, 0.0, AngularSpeedPush{field.angular_speed}});
  }
}

}  // namespace topple
