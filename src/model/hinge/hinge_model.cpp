#include "model/hinge/hinge_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "model/hinge/chain.h"

namespace topple::hinge {

namespace {

class HingeModel final : public Model {
 public:
  HingeModel(HingeScene scene, double time_step) : scene_(std::move(scene)), time_step_(time_step) {}

  void add_chain(std::vector<Push> pushes) { chains_.emplace_back(scene_, std::move(pushes)); }

  Status step() override;
  std::int64_t step_count() const override { return step_count_; }
  double time_step() const override { return time_step_; }
  void read(Frame& out) const override;
  std::span<const Event> events() const override { return now_.events; }
  std::span<const Contact> contacts() const override;
  std::uint64_t hash() const override { return now_.hash.value(); }

 private:
  HingeScene scene_;
  double time_step_;
  std::vector<Chain> chains_;
  std::int64_t step_count_ = 0;
  Happenings now_;
  mutable std::vector<Contact> contacts_;  // Filled when somebody asks.
  double settled_ = 0.0;
  double work_ = 0.0;
};

Status HingeModel::step() {
  const double until = static_cast<double>(++step_count_) * time_step_;
  now_.clear();
  bool running = false;
  for (Chain& chain : chains_) {
    if (chain.done()) continue;
    chain.advance(until, now_);
    if (!chain.finite()) return {Progress::not_finite, chain.front()};
    running = running || !chain.done();
  }
  settled_ += now_.settled;
  work_ += now_.work;
  if (!std::is_sorted(now_.events.begin(), now_.events.end(), [](const Event& a, const Event& b) { return a.time < b.time; })) {
    std::stable_sort(now_.events.begin(), now_.events.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  }
  return {running ? Progress::running : Progress::at_rest, kNoBrick};
}

void HingeModel::read(Frame& out) const {
  out.time = static_cast<double>(step_count_) * time_step_;
  out.hinged.assign(now_.stopped.begin(), now_.stopped.end());
  if (out.states_wanted) {
    for (const Chain& chain : chains_) chain.read(out.hinged);
  }
  out.curved = true;
  out.free.clear();
  out.kinks.clear();
  out.echoes.clear();
  if (out.last) {
    for (const Chain& chain : chains_) chain.tell_silent(out.kinks);
  } else {
    out.kinks.assign(now_.kinks.begin(), now_.kinks.end());
    out.echoes.assign(now_.echoes.begin(), now_.echoes.end());
  }
  if (!out.energy_wanted) return;
  out.energy = {0.0, settled_, work_};
  for (const Chain& chain : chains_) {
    const Energy energy = chain.energy();
    out.energy.kinetic += energy.kinetic;
    out.energy.potential += energy.potential;
  }
}

std::span<const Contact> HingeModel::contacts() const {
  contacts_.clear();
  for (const Chain& chain : chains_) chain.read(contacts_);
  return contacts_;
}

void add_line(std::string& lines, const std::string& line) {
  if (!lines.empty()) lines += '\n';
  lines += line;
}

void check_push(const Push& push, std::string& problems) {
  double strength = 0.0;
  if (const auto* speed = std::get_if<AngularSpeedPush>(&push.how)) strength = speed->angular_speed;
  if (const auto* force = std::get_if<ForcePush>(&push.how)) strength = force->force;
  if (const auto* blow = std::get_if<ImpulsePush>(&push.how)) strength = blow->impulse;
  if (strength >= 0.0) return;
  add_line(problems, std::string("hinge: the push on brick ") + std::to_string(push.brick) +
                         " is backwards; hinge turns bricks about their toes only; rigid can");
}

// The time in which a brick's tilt from balance grows e times [s].
double growth_time(double height, double thickness, double gravity) {
  return std::sqrt(2.0 * std::sqrt(height * height + thickness * thickness) / (3.0 * gravity));
}
double least_growth_time(const Layout& layout) {
  double least = std::numeric_limits<double>::infinity();
  for (const BrickKind& kind : layout.kinds) least = std::min(least, growth_time(kind.height, kind.thickness, layout.gravity));
  return least;
}

// The time step where a train is slow, as a fraction of that: there the fourth-order step errs by 1e-9 (tests/model/hinge_leg_test.cpp).
constexpr double kSlowStep = 0.02;

// How often the motion is read: bricks of 48 x 7.5 mm every 16 ms. Measured there: with the kinks between, the Hermite polynomial is as
// good as at 4 ms, within 0.05 % of the thickness at a corner.
constexpr double kReadStep = 0.016;

// Two pitches that differ by less are one: far from the origin a place is no better known.
constexpr double kSamePitch = 1e-9;

// Along each row, pitches that differ by rounding only become the same number.
void even_out(std::vector<Link>& links, const std::vector<BrickId>& pushed) {
  for (const BrickId start : pushed) {
    const Link* last = &links[static_cast<std::size_t>(start)];
    for (std::size_t n = 0; n < links.size() && last->next != kNoBrick; ++n) {
      Link& link = links[static_cast<std::size_t>(last->next)];
      if (std::fabs(link.pitch - last->pitch) <= kSamePitch * last->pitch) link.pitch = last->pitch;
      last = &link;
    }
  }
}

// Two pushed bricks in one row would make two waves that meet.
void check_rows(const std::vector<Link>& links, const std::vector<BrickId>& pushed, std::string& problems) {
  std::vector<BrickId> wave_of(links.size(), kNoBrick);
  for (const BrickId start : pushed) {
    BrickId id = start;
    while (id != kNoBrick && wave_of[static_cast<std::size_t>(id)] == kNoBrick) {
      wave_of[static_cast<std::size_t>(id)] = start;
      id = links[static_cast<std::size_t>(id)].next;
    }
    if (id == kNoBrick || wave_of[static_cast<std::size_t>(id)] == start) continue;
    add_line(problems, std::string("hinge: the waves from bricks ") + std::to_string(wave_of[static_cast<std::size_t>(id)]) + " and " +
                           std::to_string(start) + " run in one row; hinge follows one pushed brick a row; rigid can");
  }
}

}  // namespace

double default_time_step(const Layout& layout) {
  return std::min(kReadStep * (least_growth_time(layout) / growth_time(0.048, 0.0075, 9.81)), 1.0);
}

Result<std::unique_ptr<Model>> make_hinge_model(const Layout& layout, const HingeConfig& config) {
  std::string problems;
  if (!(config.time_step > 0.0 && config.time_step <= 1.0)) {
    add_line(problems, std::string("hinge: time_step_s = ") + std::to_string(config.time_step) + " is outside 0 to 1");
  }
  if (!(config.rest_tolerance > 0.0 && config.rest_tolerance <= 0.1)) {
    add_line(problems, std::string("hinge: rest_tolerance = ") + std::to_string(config.rest_tolerance) + " is outside 0 to 0.1");
  }
  for (const Push& push : layout.pushes) check_push(push, problems);
  HingeScene scene;
  scene.layout = &layout;
  Result<std::vector<Link>> links = find_links(layout);
  if (!links) add_line(problems, links.error().message);
  if (!problems.empty()) return failure(problems);
  scene.links = std::move(*links);

  std::vector<BrickId> pushed;
  pushed.reserve(layout.pushes.size());
  for (const Push& push : layout.pushes) pushed.push_back(push.brick);
  std::sort(pushed.begin(), pushed.end());
  pushed.erase(std::unique(pushed.begin(), pushed.end()), pushed.end());
  check_rows(scene.links, pushed, problems);
  if (!problems.empty()) return failure(problems);

  even_out(scene.links, pushed);
  scene.rest_tolerance = config.rest_tolerance;
  scene.repeats = config.repeats;
  scene.slow_step = kSlowStep * least_growth_time(layout);
  scene.angles.resize(layout.bricks.size(), 0.0F);
  auto model = std::make_unique<HingeModel>(std::move(scene), config.time_step);
  for (const BrickId brick : pushed) {
    std::vector<Push> pushes;
    std::copy_if(layout.pushes.begin(), layout.pushes.end(), std::back_inserter(pushes), [&](const Push& p) { return p.brick == brick; });
    std::stable_sort(pushes.begin(), pushes.end(), [](const Push& a, const Push& b) { return a.at < b.at; });
    model->add_chain(std::move(pushes));
  }
  return model;
}

}  // namespace topple::hinge
