#include "model/rigid/rigid_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "base/hash.h"
#include "model/rigid/wavefront.h"

namespace topple::rigid {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class RigidModel final : public Model {
 public:
  RigidModel(const Layout& layout, const RigidConfig& config)
      : world_(layout), step_(config.time_step > 0.0 ? config.time_step : default_time_step(layout)) {
    world_.step = step_;
    plan_pushes();
  }

  Status step() override;
  std::int64_t step_count() const override { return count_; }
  double time_step() const override { return step_; }
  void read(Frame& out) const override;
  std::span<const Event> events() const override { return events_; }
  std::span<const Contact> contacts() const override { return contacts_; }
  std::uint64_t hash() const override { return hash_.value(); }

 private:
  void plan_pushes();
  void begin_pushes(double end);
  Front& front_of(BrickId brick);
  void join_fronts();
  void advance_fronts(double begin);
  void gather();
  Status check() const;

  World world_;
  double step_ = 0.0;
  std::int64_t count_ = 0;
  std::vector<PushMoment> moments_;  // All of the run, in the order of time.
  std::size_t next_moment_ = 0;
  std::size_t last_moment_ = 0;
  std::vector<PushMoment> now_;
  std::vector<std::unique_ptr<Front>> fronts_;  // By number; null where a front has been taken over.
  std::vector<Event> events_;
  std::vector<Contact> contacts_;
  struct Mover {
    BrickId brick = kNoBrick;
    const Body* body = nullptr;
  };
  std::vector<Mover> movers_;
  Hash hash_;
};

void RigidModel::plan_pushes() {
  for (const Push& push : world_.layout.pushes) {
    moments_.push_back({push.at, &push, push.brick});
    if (const auto* force = std::get_if<ForcePush>(&push.how)) moments_.push_back({push.at + force->duration, nullptr, push.brick});
  }
  std::stable_sort(moments_.begin(), moments_.end(), [](const PushMoment& l, const PushMoment& r) { return l.time < r.time; });
}

Front& RigidModel::front_of(BrickId brick) {
  std::int32_t& number = world_.front[static_cast<std::size_t>(brick)];
  if (number == kNoFront) {
    const auto free = std::find(fronts_.begin(), fronts_.end(), nullptr);
    const auto at = static_cast<std::int32_t>(free - fronts_.begin());
    if (free == fronts_.end()) fronts_.emplace_back();
    fronts_[static_cast<std::size_t>(at)] = std::make_unique<Front>(world_, at);
    fronts_[static_cast<std::size_t>(at)]->wake(brick, 0.0);
    return *fronts_[static_cast<std::size_t>(at)];
  }
  return *fronts_[static_cast<std::size_t>(number)];
}

// Bricks that are pushed in this step belong to a front from its beginning.
void RigidModel::begin_pushes(double end) {
  last_moment_ = next_moment_;
  while (last_moment_ < moments_.size() && moments_[last_moment_].time < end) {
    const PushMoment& moment = moments_[last_moment_++];
    if (moment.push != nullptr) front_of(moment.brick).wake(moment.brick, moment.time);
  }
}

// Fronts within each other's reach become one.
void RigidModel::join_fronts() {
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    bool again = fronts_[i] != nullptr;
    while (again) {
      again = false;
      for (const std::int32_t met : fronts_[i]->met()) {
        const auto other = static_cast<std::size_t>(met);
        if (other == i || fronts_[other] == nullptr) continue;
        fronts_[i]->absorb(*fronts_[other]);
        fronts_[other].reset();
        again = true;
        break;
      }
    }
    if (fronts_[i] != nullptr) fronts_[i]->clear_met();
  }
}

void RigidModel::advance_fronts(double begin) {
  for (const auto& front : fronts_) {
    if (front == nullptr) continue;
    now_.clear();
    for (std::size_t i = next_moment_; i < last_moment_; ++i) {
      const auto brick = static_cast<std::size_t>(moments_[i].brick);
      if (world_.front[brick] >= 0 && fronts_[static_cast<std::size_t>(world_.front[brick])] == front) now_.push_back(moments_[i]);
    }
    front->advance(begin, now_);
    front->retire(begin + step_);
  }
  next_moment_ = last_moment_;
}

// One step: begin the pushes, join what has met, advance every front, gather what happened, check that it is finite.
Status RigidModel::step() {
  const double begin = static_cast<double>(count_) * step_;
  begin_pushes(begin + step_);
  join_fronts();
  advance_fronts(begin);
  ++count_;
  gather();
  return check();
}

void RigidModel::gather() {
  events_.clear();
  contacts_.clear();
  movers_.clear();
  for (auto& front : fronts_) {
    if (front == nullptr) continue;
    events_.insert(events_.end(), front->events().begin(), front->events().end());
    contacts_.insert(contacts_.end(), front->contacts().begin(), front->contacts().end());
    for (std::size_t i = 0; i < front->bodies().size(); ++i) {
      if (front->members()[i].moving || front->members()[i].just_rested) movers_.push_back({front->bodies()[i].id, &front->bodies()[i]});
    }
  }
  std::stable_sort(events_.begin(), events_.end(),
                   [](const Event& l, const Event& r) { return l.time != r.time ? l.time < r.time : l.brick < r.brick; });
  std::sort(movers_.begin(), movers_.end(), [](const Mover& l, const Mover& r) { return l.brick < r.brick; });
  for (const Mover& mover : movers_) {
    const Body& body = *mover.body;
    hash_.add(static_cast<std::uint64_t>(mover.brick));
    for (const Vec3* v : {&body.position, &body.velocity, &body.angular_velocity}) {
      hash_.add(v->x);
      hash_.add(v->y);
      hash_.add(v->z);
    }
    hash_.add(body.orientation.w);
    hash_.add(body.orientation.x);
    hash_.add(body.orientation.y);
    hash_.add(body.orientation.z);
  }
}

Status RigidModel::check() const {
  bool moving = false;
  for (const Mover& mover : movers_) {
    const Body& body = *mover.body;
    const double w = body.orientation.w + body.orientation.x + body.orientation.y + body.orientation.z;
    if (!finite(body.position) || !finite(body.velocity) || !finite(body.angular_velocity) || !std::isfinite(w)) {
      return {Progress::not_finite, mover.brick};
    }
    moving = moving || body.inverse_mass > 0.0;
  }
  if (!moving && next_moment_ == moments_.size()) return {Progress::at_rest, kNoBrick};
  return {};
}

void RigidModel::read(Frame& out) const {
  out.time = static_cast<double>(count_) * step_;
  out.hinged.clear();
  out.free.clear();
  out.kinks.clear();
  Energy energy;
  energy.potential = world_.resting_energy;
  energy.push_work = world_.push_work;
  for (const Mover& mover : movers_) {
    const Body& body = *mover.body;
    out.free.push_back({mover.brick,
                        world_.phase[static_cast<std::size_t>(mover.brick)],
                        {body.position, body.orientation},
                        body.velocity,
                        body.angular_velocity});
    if (body.inverse_mass <= 0.0) continue;
    energy.kinetic += kinetic_energy(body);
    const double mass = world_.layout.kinds[body.kind].mass;
    energy.potential += mass * world_.gravity * (body.position.z - standing_pose(world_.layout, mover.brick).position.z);
  }
  out.energy = energy;
}

}  // namespace

double default_time_step(const Layout& layout) {
  double longest = std::numeric_limits<double>::infinity();
  for (const BrickKind& kind : layout.kinds) longest = std::min(longest, std::max({kind.height, kind.width, kind.thickness}));
  return 0.05 * std::sqrt(longest / layout.gravity);
}

Result<std::unique_ptr<Model>> make_rigid_model(const Layout& layout, const RigidConfig& config) {
  for (const BrickKind& kind : layout.kinds) {
    if (kind.shape == Shape::ball) return failure(layout.name + ": model rigid: \"" + kind.name + "\" is a ball; no model rolls one yet.");
  }
  const double most = 4.0 * default_time_step(layout);
  if (config.time_step > most) {
    std::array<char, 160> words{};
    std::snprintf(words.data(), words.size(),
                  "time_step_s: %.6g s is too long for these bricks with the model rigid; it must be more than 0 and at most %.6g s.",
                  config.time_step, most);
    return failure(words.data());
  }
  return std::make_unique<RigidModel>(layout, config);
}

}  // namespace topple::rigid
