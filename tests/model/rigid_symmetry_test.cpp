// The same layout in another place, mirrored, turned, larger or under another gravity is one computation.
#include <array>
#include <span>

#include "rigid_scene.h"

using namespace topple;
using namespace topple::test;

namespace {

/// About the x axis.
Layout mirrored(Layout layout) {
  for (Brick& brick : layout.bricks) {
    brick.foot.y = -brick.foot.y;
    brick.heading = -brick.heading;
  }
  return layout;
}

/// Lengths times `scale`, gravity times `pull`: Froude's law makes times longer by sqrt(scale / pull).
Layout scaled(Layout layout, double scale, double pull) {
  layout.gravity *= pull;
  for (BrickKind& kind : layout.kinds) {
    kind.height *= scale;
    kind.width *= scale;
    kind.thickness *= scale;
    kind.mass *= scale * scale * scale;
  }
  for (Brick& brick : layout.bricks) brick.foot = scale * brick.foot;
  const double clock = std::sqrt(scale / pull), heavier = scale * scale * scale * pull;
  for (Push& push : layout.pushes) {
    push.at *= clock;
    if (auto* spin = std::get_if<AngularSpeedPush>(&push.how)) {
      spin->angular_speed /= clock;
    } else if (auto* force = std::get_if<ForcePush>(&push.how)) {
      *force = {heavier * force->force, scale * force->height, clock * force->duration};
    } else {
      auto& blow = std::get<ImpulsePush>(push.how);
      blow = {heavier * clock * blow.impulse, scale * blow.height};
    }
  }
  return layout;
}

/// The same layout elsewhere: mirrored about the x axis, then larger, then turned, then shifted.
struct Likeness {
  bool mirror = false;
  double scale = 1.0, pull = 1.0;
  double turn = 0.0;
  Vec3 shift;

  Layout of(const Layout& layout) const { return moved(scaled(mirror ? mirrored(layout) : layout, scale, pull), turn, shift); }
  double clock() const { return std::sqrt(scale / pull); }
  double mass() const { return scale * scale * scale; }
  Vec3 direction(const Vec3& v) const {
    const SinCos angle = sin_cos(turn);
    const double y = mirror ? -v.y : v.y;
    return {angle.cos * v.x - angle.sin * y, angle.sin * v.x + angle.cos * y, v.z};
  }
  Vec3 place(const Vec3& at) const { return shift + scale * direction(at); }
  Vec3 spin(const Vec3& w) const { return (mirror ? -1.0 : 1.0) * direction(w); }  // Of a mirror image: the other way round.
};

constexpr std::array kLike = {Likeness{.mirror = true},
                              Likeness{.turn = 0.6},
                              Likeness{.turn = -2.5},
                              Likeness{.shift = {1000.0, -1000.0, 0.0}},
                              Likeness{.scale = 10.0, .pull = 0.3},
                              Likeness{.mirror = true, .scale = 0.1, .pull = 7.0, .turn = 2.0, .shift = {-3.0, 5.0, 0.0}},
                              Likeness{.mirror = true, .scale = 10.0, .pull = 0.3, .turn = 0.6, .shift = {1000.0, -1000.0, 0.0}}};

/// The largest differences of two runs, as fractions of a brick's height, of sqrt(height x gravity), of what the layout is pushed with...
struct Differences {
  double time = 0.0, place = 0.0, axes = 0.0, velocity = 0.0, spin = 0.0, blow = 0.0, energy = 0.0;
  bool alike = true;  ///< The same happened to the same bricks.
};

/// Where the axes of a brick point. In a mirror that one is turned round which lies across the brick as it was put down.
double difference_of_axes(const Likeness& like, Stance stance, const Quat& here, const Quat& there) {
  double most = 0.0;
  const Vec3 across = stance == Stance::on_side ? Vec3{0.0, 0.0, 1.0} : Vec3{0.0, 1.0, 0.0};
  for (const Vec3& axis : {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}}) {
    const double side = like.mirror && axis == across ? -1.0 : 1.0;
    most = std::max(most, norm(rotate(there, side * axis) - like.direction(rotate(here, axis))));
  }
  return most;
}

double difference_of(const Vec3& left, const Vec3& right) { return std::isnan(left.x) && std::isnan(right.x) ? 0.0 : norm(left - right); }

void compare(const Likeness& like, double height, const Event& here, const Event& there, Differences& most) {
  most.alike = most.alike && here.kind == there.kind && here.brick == there.brick && here.by == there.by;
  most.time = std::max(most.time, std::abs(like.clock() * here.time - there.time) / there.time);
  most.place = std::max(most.place, difference_of(like.place(here.point), there.point) / (like.scale * height));
  if (std::isnan(here.impulse) || here.impulse == 0.0) return;
  most.blow = std::max(most.blow, std::abs(there.impulse / (like.mass() * like.scale / like.clock() * here.impulse) - 1.0));
}

void compare(const Likeness& like, const Layout& layout, const FreeMotion& here, const FreeMotion& there, Differences& most) {
  const double height = layout.kinds[0].height, rate = std::sqrt(layout.gravity / height);
  most.alike = most.alike && here.brick == there.brick && here.phase == there.phase;
  most.place = std::max(most.place, norm(like.place(here.pose.position) - there.pose.position) / (like.scale * height));
  most.axes = std::max(most.axes, difference_of_axes(like, layout.bricks[static_cast<std::size_t>(here.brick)].stance,
                                                     here.pose.orientation, there.pose.orientation));
  const Vec3 velocity = (like.scale / like.clock()) * like.direction(here.velocity);
  most.velocity = std::max(most.velocity, norm(velocity - there.velocity) / (like.scale / like.clock() * rate * height));
  const Vec3 spin = (1.0 / like.clock()) * like.spin(here.angular_velocity);
  most.spin = std::max(most.spin, norm(spin - there.angular_velocity) / (rate / like.clock()));
}

/// Step by step, all that can be asked of the model; a run that is another layout's to the last bit has its hash.
void check_alike(const Layout& layout, const Likeness& like, double until) {
  CAPTURE(like.mirror);
  CAPTURE(like.turn);
  CAPTURE(like.scale);
  CAPTURE(like.shift.x);
  const Layout other = like.of(layout);
  auto here = rigid::make_rigid_model(layout, {.repeats = false}), there = rigid::make_rigid_model(other, {.repeats = false});
  REQUIRE(here.has_value());
  REQUIRE(there.has_value());
  Frame frame, image;
  Differences most;
  std::size_t happened = 0;
  for (bool running = true; running && frame.time < until;) {
    running = (*here)->step().progress == Progress::running;
    most.alike = most.alike && running == ((*there)->step().progress == Progress::running);
    (*here)->read(frame);
    (*there)->read(image);
    const std::span<const Event> events = (*here)->events(), images = (*there)->events();
    most.alike = most.alike && events.size() == images.size() && frame.free.size() == image.free.size();
    for (std::size_t i = 0; most.alike && i < events.size(); ++i) compare(like, layout.kinds[0].height, events[i], images[i], most);
    for (std::size_t i = 0; most.alike && i < frame.free.size(); ++i) compare(like, layout, frame.free[i], image.free[i], most);
    const double work = like.mass() * like.scale * like.scale / (like.clock() * like.clock());
    const double left = frame.energy.kinetic + frame.energy.potential, right = image.energy.kinetic + image.energy.potential;
    most.energy = std::max(most.energy, std::abs(work * left - right) / (work * frame.energy.push_work));
    happened += events.size();
  }
  CHECK(most.alike);
  CHECK(happened > layout.bricks.size() / 2);
  CHECK((*here)->hash() == (*there)->hash());
  // A kilometre away a place is rounded to 1e-13 m, 2e-12 of a height.
  for (const double difference : {most.time, most.place, most.axes, most.velocity, most.spin, most.blow, most.energy})
    CHECK(difference < 1e-9);
}

// A quarter of a circle in ten bricks, between two straight pieces.
Layout turn_of_ten(double restitution) {
  Layout layout = straight_row(0, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
  Brick brick;
  for (int i = 0; i < 18; ++i) {
    layout.bricks.push_back(brick);
    const double next = brick.heading + (i >= 3 && i < 13 ? 0.05 * kPi : 0.0);
    const double middle = 0.5 * (brick.heading + next);
    brick.foot = brick.foot + 0.024 * Vec3{std::cos(middle), std::sin(middle), 0.0};
    brick.heading = next;
  }
  layout.parts = {{"turn", 0, layout.brick_count()}};
  return layout;
}

Layout split(double restitution) {
  Layout layout = straight_row(6, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
  Brick brick;
  for (const double side : {-0.0135, 0.0135}) {
    for (int i = 6; i < 14; ++i) {
      brick.foot = {0.024 * i, side, 0.0};
      layout.bricks.push_back(brick);
    }
  }
  return layout;
}

}  // namespace

TEST_CASE("rigid: a straight row falls alike wherever and however it lies, and however large it is") {
  for (const double restitution : {0.0, 0.3}) {
    CAPTURE(restitution);
    const Layout row = straight_row(15, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
    for (const Likeness& like : kLike) check_alike(row, like, 1.0);
  }
}

TEST_CASE("rigid: a curve and a split fall alike wherever and however they lie, and however large they are") {
  for (const double restitution : {0.0, 0.3}) {
    CAPTURE(restitution);
    for (const Likeness& like : kLike) {
      check_alike(turn_of_ten(restitution), like, 0.8);
      check_alike(split(restitution), like, 0.5);
    }
  }
}

TEST_CASE("rigid: a run by force, by a blow or by a ball is alike wherever and however it lies, and however large it is") {
  Layout forced = turn_of_ten(0.0), struck = split(0.3);
  forced.pushes = {{0, 0.01, ForcePush{0.12, 0.04, 0.06}}};
  struck.pushes = {{0, 0.0, ImpulsePush{0.002, 0.045}}};
  const Layout ball =
      layout_of("[[ball]]\nat_mm = [-40, 3]\nheading_deg = 5\nspeed_m_s = 0.6\n[[row]]\nfrom_mm = [0, 0]\ncount = 6\ngap_mm = 16.5\n");
  for (const Likeness& like : kLike) {
    check_alike(forced, like, 0.4);
    check_alike(struck, like, 0.4);
    check_alike(ball, like, 0.4);
  }
}

// Bricks on their side, too: every one of a layout lies on its right, also in a mirror.
TEST_CASE("rigid: a tower and a wall that are struck fall alike wherever and however they lie, and however large they are") {
  const std::string ram =
      "[[kind]]\nname = \"domino\"\n[[kind]]\nname = \"ram\"\nheight_mm = 60\nwidth_mm = 30\nthickness_mm = 12\nmass_g = 60\n"
      "[[push]]\nbrick = 0\nangular_speed_rad_s = 6\n[[brick]]\nat_mm = [-50, 4]\nkind = \"ram\"\n";
  const Layout tower = layout_of(ram + "[[tower]]\nat_mm = [0, 0]\nlayers = 3\ncount = 1\npose = \"standing\"\n");
  const Layout wall = layout_of(ram + "[[wall]]\nat_mm = [0, 0]\ncount = 2\ncourses = 2\n");
  const Layout on_side = layout_of(ram + "[[row]]\nfrom_mm = [0, 0]\ncount = 4\ngap_mm = 16.5\npose = \"on_side\"\n");
  for (const Likeness& like : kLike) {
    check_alike(tower, like, 0.25);
    check_alike(wall, like, 0.25);
    check_alike(on_side, like, 0.4);
  }
}

TEST_CASE("rigid: the two branches of a symmetric split arrive together within a percent") {
  for (const double restitution : {0.0, 0.3}) {
    const RigidRun run = run_rigid(split(restitution), 0.0, 1.5);
    for (std::size_t i = 6; i < 14; ++i) CHECK(std::abs(run.arrival[i + 8] / run.arrival[i] - 1.0) < 0.01);
  }
}

TEST_CASE("rigid: bricks of a straight row never turn about the vertical") {
  const Layout layout = moved(straight_row(20, 0.024), 0.6, {});
  const RigidRun run = run_rigid(layout, 0.0, 10.0);
  for (BrickId i = 0; i < layout.brick_count(); ++i) {
    // Where its width points: across the row, whatever its tilt.
    const Vec3 across = rotate(run.last[static_cast<std::size_t>(i)].orientation, Vec3{0.0, 1.0, 0.0});
    const SinCos heading = sin_cos(0.6);
    CHECK(std::abs(across.x * heading.cos + across.y * heading.sin) < 1e-6);
    CHECK(std::abs(across.z) < 1e-6);
  }
}

TEST_CASE("rigid: where every brick moves, a straight row that has fallen goes on with six degrees of freedom, and none rests") {
  const Layout layout = straight_row(20, 0.024, {});
  auto model = rigid::make_rigid_model(layout, {.every_brick_moves = true});
  REQUIRE(model.has_value());
  Frame frame;
  for (int step = 0; step < 600; ++step) REQUIRE((*model)->step().progress == Progress::running);
  (*model)->read(frame);
  CHECK(frame.free.size() == 20);
  for (const FreeMotion& brick : frame.free) CHECK(brick.phase == Phase::falling);
}

// The first brick falls in steps of a third where it moves alone: 0.1 percent between them. From the tenth brick on what bounces is no
// longer straight with six degrees of freedom (docs/rigid.md).
TEST_CASE("rigid: a straight row that bounces begins alike in its plane and with six degrees of freedom, within 0.2 percent") {
  for (const double restitution : {0.0, 0.3, 0.6}) {
    CAPTURE(restitution);
    const Layout layout = straight_row(8, 0.024, {.brick_restitution = restitution, .floor_restitution = restitution});
    const RigidRun in_plane = run_rigid(layout, 0.0, 1.5);
    auto model = rigid::make_rigid_model(layout, {.every_brick_moves = true});
    REQUIRE(model.has_value());
    std::vector<double> arrival(layout.bricks.size(), 0.0);
    while (arrival.back() == 0.0 && (*model)->step_count() < 300) {
      (*model)->step();
      for (const Event& event : (*model)->events()) {
        if (event.kind == EventKind::arrived) arrival[static_cast<std::size_t>(event.brick)] = event.time;
      }
    }
    for (std::size_t i = 0; i < arrival.size(); ++i) CHECK(std::abs(arrival[i] / in_plane.arrival[i] - 1.0) < 0.002);
  }
}
