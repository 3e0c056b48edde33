#include "model/rigid/rigid_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "base/crew.h"
#include "base/hash.h"
#include "model/rigid/free_front.h"
#include "model/rigid/plane_front.h"

namespace topple::rigid {

namespace {

/// A front in the step that is being done: what it is given, and what is asked of it in the same go.
struct Turn {
  Wave* front = nullptr;
  std::span<const PushMoment> moments;
  std::uint64_t hash = 0;
  BrickId not_finite = kNoBrick;
  std::size_t first = 0, count = 0;  // Its bricks in the frame.
  Energy energy;
};

class RigidModel final : public Model {
 public:
  RigidModel(const Layout& layout, const RigidConfig& config)
      : world_(layout),
        seconds_(config.time_step > 0.0 ? config.time_step : default_time_step(layout)),
        step_(world_.units.time(seconds_)),
        clock_(seconds_ / step_),
        crew_(config.crew != nullptr ? *config.crew : alone_) {
    world_.step = step_;
    world_.every_brick_moves = config.every_brick_moves;
    world_.repeats = config.repeats;
    world_.kernels = lane_kernels(config.lanes);
    world_.profile = config.profile;
    if (config.profile != nullptr) config.profile->name_lanes(world_.kernels->lanes);
    plan_pushes();
    if (config.every_brick_moves) wake_all();
  }

  Status step() override;
  std::int64_t step_count() const override { return count_; }
  double time_step() const override { return seconds_; }
  void read(Frame& out) const override;
  std::span<const Event> events() const override { return events_; }
  std::span<const Contact> contacts() const override;
  std::uint64_t hash() const override { return hash_.value(); }

 private:
  void plan_pushes();
  void wake_all();
  void begin_pushes(double end);
  std::size_t free_number();
  Wave& front_of(BrickId brick);
  void join(std::size_t number);
  FreeFront& general(std::size_t number);
  void join_fronts();
  void part_fronts();
  void straighten(std::size_t number, BrickId row);
  void dismiss_those_at_rest();
  void plan_turns();
  void advance_fronts(double begin);
  void settle();
  void gather();
  Status check() const;

  // From the run to the world.
  void tell(Event& event) const;
  void tell(UnseenMotion& unseen) const;

  World world_;
  double seconds_ = 0.0;  // A step in the world [s],
  double step_ = 0.0;     // and in the run;
  double clock_ = 1.0;    // the one over the other.
  std::int64_t count_ = 0;
  std::vector<PushMoment> moments_;  // All of the run, in the order of time.
  std::size_t next_moment_ = 0;
  std::size_t last_moment_ = 0;
  std::vector<PushMoment> now_;                // Of this step, by front.
  std::vector<std::unique_ptr<Wave>> fronts_;  // By number; null where a front has been taken over.
  mutable std::vector<Turn> turns_;            // One a front, by number.
  std::vector<std::size_t> order_;             // In which turns are given out: long ones first.
  Crew alone_{1};
  Crew& crew_;
  std::vector<Event> events_;
  std::vector<Echo> echoes_;
  std::vector<BrickId> echoed_;
  std::vector<UnseenMotion> unseen_;
  mutable std::vector<Contact> contacts_;  // Filled when somebody asks.
  Hash hash_;
};

void RigidModel::plan_pushes() {
  for (const Push& push : world_.pushes) {
    moments_.push_back({push.at, &push, push.brick});
    if (const auto* force = std::get_if<ForcePush>(&push.how)) moments_.push_back({push.at + force->duration, nullptr, push.brick});
  }
  std::stable_sort(moments_.begin(), moments_.end(), [](const PushMoment& l, const PushMoment& r) { return l.time < r.time; });
}

void RigidModel::wake_all() {
  for (BrickId brick = 0; brick < world_.layout.brick_count(); ++brick) {
    if (brick == 0) fronts_.push_back(std::make_unique<FreeFront>(world_, 0));
    fronts_[0]->wake(brick, 0.0);
    fronts_[0]->enter_all();
  }
}

std::size_t RigidModel::free_number() {
  const auto free = std::find(fronts_.begin(), fronts_.end(), nullptr);
  const auto number = static_cast<std::size_t>(free - fronts_.begin());
  if (free == fronts_.end()) fronts_.emplace_back();
  return number;
}

Wave& RigidModel::front_of(BrickId brick) {
  const std::int32_t number = world_.front[static_cast<std::size_t>(brick)];
  if (number != kNoFront) return *fronts_[static_cast<std::size_t>(number)];
  const std::size_t at = free_number();
  if (!put_down_in(plane_of_row(world_, brick), world_, brick)) {
    fronts_[at] = std::make_unique<FreeFront>(world_, static_cast<std::int32_t>(at));
  } else {
    fronts_[at] = std::make_unique<PlaneFront>(world_, static_cast<std::int32_t>(at), brick);
  }
  return *fronts_[at];
}

// Bricks that are pushed in this step belong to a front from its beginning.
void RigidModel::begin_pushes(double end) {
  const Timed timed(world_.profile, Stage::pushes);
  last_moment_ = next_moment_;
  while (last_moment_ < moments_.size() && moments_[last_moment_].time < end) {
    const PushMoment& moment = moments_[last_moment_++];
    if (moment.push == nullptr) continue;
    Wave& front = front_of(moment.brick);
    front.wake(moment.brick, moment.time);
    front.enter_all();
  }
}

// A front that can no longer stay in its plane goes on with six degrees of freedom.
FreeFront& RigidModel::general(std::size_t number) {
  if (auto* plane = dynamic_cast<PlaneFront*>(fronts_[number].get())) {
    std::vector<HandedBrick> bricks;
    std::vector<ActiveForce> forces;
    plane->hand_over(bricks, forces);
    auto front = std::make_unique<FreeFront>(world_, static_cast<std::int32_t>(number));
    front->adopt(bricks, forces);
    front->enter_all();
    plane->hand_out(echoes_, echoed_, unseen_);
    fronts_[number] = std::move(front);
  }
  return static_cast<FreeFront&>(*fronts_[number]);
}

// Takes over every front within reach of this one, and of those in turn.
void RigidModel::join(std::size_t number) {
  std::vector<std::int32_t> met(fronts_[number]->met().begin(), fronts_[number]->met().end());
  FreeFront& front = general(number);
  for (std::size_t i = 0; i < met.size(); ++i) {
    const auto other = static_cast<std::size_t>(met[i]);
    if (other == number || fronts_[other] == nullptr) continue;
    front.absorb(general(other));
    front.enter_all();
    fronts_[other].reset();
    met.insert(met.end(), front.met().begin(), front.met().end());
  }
  front.clear_met();
}

// Fronts within each other's reach become one.
void RigidModel::join_fronts() {
  const Timed timed(world_.profile, Stage::join);
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    if (fronts_[i] != nullptr && fronts_[i]->must_join()) join(i);
  }
}

// Parts of a front that no longer reach each other become fronts of their own, and straight rows go on in their plane, where bricks rest.
void RigidModel::part_fronts() {
  if (world_.every_brick_moves) return;
  const Timed timed(world_.profile, Stage::part);
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    if (fronts_[i] == nullptr || !fronts_[i]->general()) continue;
    auto* front = static_cast<FreeFront*>(fronts_[i].get());
    if (!front->may_part()) continue;
    for (int parts = front->find_parts(); parts > 1; --parts) {
      const std::size_t number = free_number();
      auto part = std::make_unique<FreeFront>(world_, static_cast<std::int32_t>(number));
      front->give_part(parts - 1, *part);
      fronts_[number] = std::move(part);
    }
    const BrickId row = front->row_brick();
    if (row != kNoBrick) straighten(i, row);
  }
}

void RigidModel::straighten(std::size_t number, BrickId row) {
  std::vector<HandedBrick> bricks;
  static_cast<FreeFront&>(*fronts_[number]).hand_over(bricks);
  auto plane = std::make_unique<PlaneFront>(world_, static_cast<std::int32_t>(number), row);
  plane->adopt(bricks);
  plane->enter_all();
  fronts_[number] = std::move(plane);
}

void RigidModel::dismiss_those_at_rest() {
  for (auto& front : fronts_) {
    if (front == nullptr || !front->at_rest()) continue;
    front->disband();
    front.reset();
  }
}

// Gives every front its pushes of this step.
void RigidModel::plan_turns() {
  turns_.clear();
  order_.clear();
  now_.clear();
  now_.reserve(last_moment_ - next_moment_);
  for (const auto& front : fronts_) {
    if (front == nullptr) continue;
    const std::size_t first = now_.size();
    for (std::size_t i = next_moment_; i < last_moment_; ++i) {
      if (world_.front[static_cast<std::size_t>(moments_[i].brick)] == front->number()) now_.push_back(moments_[i]);
    }
    turns_.push_back({.front = front.get(), .moments = std::span(now_).subspan(first)});
    if (front->general()) order_.push_back(turns_.size() - 1);
  }
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    if (!turns_[i].front->general()) order_.push_back(i);
  }
}

void RigidModel::advance_fronts(double begin) {
  const Timed all(world_.profile, Stage::advance);
  crew_.each(order_.size(), [&](std::size_t i) {
    Turn& turn = turns_[order_[i]];
    const Timed timed(world_.profile, turn.front->general() ? Stage::free_fronts : Stage::plane_fronts);
    turn.front->advance(begin, turn.moments);
    Hash hash;
    turn.front->add_to(hash);
    turn.hash = hash.value();
    turn.not_finite = turn.front->not_finite();
  });
  next_moment_ = last_moment_;
}

// What the fronts did becomes known to all, in the order of their numbers.
void RigidModel::settle() {
  const Timed timed(world_.profile, Stage::enter);
  for (const Turn& turn : turns_) turn.front->enter_leavings();
  for (Turn& turn : turns_) {
    turn.front->enter_takings(true);
    turn.count = turn.front->motion_count();
  }
  for (const Turn& turn : turns_) turn.front->enter_takings(false);
  for (const Turn& turn : turns_) turn.front->enter_changes();
}

// One step: begin the pushes, join what has met, part what no longer reaches each other, dismiss what rests, advance every front, let all
// know what each did, gather what happened, check that it is finite.
Status RigidModel::step() {
  const double begin = static_cast<double>(count_) * step_;
  echoes_.clear();
  echoed_.clear();
  unseen_.clear();
  begin_pushes(begin + step_);
  join_fronts();
  part_fronts();
  dismiss_those_at_rest();
  plan_turns();
  advance_fronts(begin);
  settle();
  ++count_;
  gather();
  return check();
}

void RigidModel::gather() {
  const Timed timed(world_.profile, Stage::gather);
  events_.clear();
  for (const Turn& turn : turns_) {
    events_.insert(events_.end(), turn.front->events().begin(), turn.front->events().end());
    hash_.add(turn.hash);
    turn.front->hand_out(echoes_, echoed_, unseen_);
  }
  std::stable_sort(events_.begin(), events_.end(),
                   [](const Event& l, const Event& r) { return l.time != r.time ? l.time < r.time : l.brick < r.brick; });
  for (Event& event : events_) tell(event);
  for (Echo& echo : echoes_) {
    echo.start = clock_ * echo.start;
    echo.like_start = clock_ * echo.like_start;
  }
  for (UnseenMotion& unseen : unseen_) tell(unseen);
}

void RigidModel::tell(Event& event) const {
  event.time = clock_ * event.time;
  event.force = world_.units.force(event.force);
  event.impulse = world_.units.impulse(event.impulse);
  event.point = world_.units.place(event.point);
}

void RigidModel::tell(UnseenMotion& unseen) const {
  unseen.time = clock_ * unseen.time;
  world_.units.tell({&unseen.motion, 1}, world_.layout.bricks);
}

Status RigidModel::check() const {
  bool moving = false;
  for (const Turn& turn : turns_) {
    if (turn.not_finite != kNoBrick) return {Progress::not_finite, turn.not_finite};
    moving = moving || !turn.front->at_rest();
  }
  if (!moving && next_moment_ == moments_.size()) return {Progress::at_rest, kNoBrick};
  return {};
}

void RigidModel::read(Frame& out) const {
  out.time = static_cast<double>(count_) * seconds_;
  out.hinged.clear();
  out.kinks.clear();
  out.echoes = echoes_;
  out.echoed = echoed_;
  out.unseen = unseen_;
  out.energy = {.kinetic = 0.0, .potential = world_.resting_energy, .push_work = world_.push_work};
  std::size_t count = 0;
  for (Turn& turn : turns_) {
    turn.first = count;
    turn.energy = {};
    count += turn.count;
  }
  out.free.resize(count);
  crew_.each(turns_.size(), [&](std::size_t i) {
    Turn& turn = turns_[i];
    const std::span motions = std::span(out.free).subspan(turn.first, turn.count);
    turn.front->read(motions, out.energy_wanted ? &turn.energy : nullptr);
    world_.units.tell(motions, world_.layout.bricks);
  });
  if (out.last) {
    const std::size_t told = out.unseen.size();
    for (const Turn& turn : turns_) turn.front->tell_unseen(out.unseen);
    for (UnseenMotion& unseen : std::span(out.unseen).subspan(told)) tell(unseen);
  }
  for (const Turn& turn : turns_) {
    out.energy.kinetic += turn.energy.kinetic;
    out.energy.potential += turn.energy.potential;
  }
  for (double* part : {&out.energy.kinetic, &out.energy.potential, &out.energy.push_work}) *part = world_.units.energy(*part);
}

std::span<const Contact> RigidModel::contacts() const {
  contacts_.clear();
  for (const Turn& turn : turns_) turn.front->read(contacts_);
  for (Contact& contact : contacts_) {
    contact.point = world_.units.place(contact.point);
    contact.force = world_.units.force(contact.force);
  }
  return contacts_;
}

}  // namespace

double default_time_step(const Layout& layout) {
  double longest = std::numeric_limits<double>::infinity();
  // A ball has no fall of its own; only where there is nothing else it gives the measure.
  const bool only_balls =
      std::all_of(layout.kinds.begin(), layout.kinds.end(), [](const BrickKind& kind) { return kind.shape == Shape::ball; });
  for (const BrickKind& kind : layout.kinds) {
    if (kind.shape == Shape::box || only_balls) longest = std::min(longest, std::max({kind.height, kind.width, kind.thickness}));
  }
  return 0.06 * std::sqrt(longest / layout.gravity);
}

Result<std::unique_ptr<Model>> make_rigid_model(const Layout& layout, const RigidConfig& config) {
  const double most = 4.0 * default_time_step(layout);
  if (config.time_step > most) {
    std::array<char, 160> words{};
    std::snprintf(words.data(), words.size(),
                  "time_step_s: %.6g s is too long for these bricks with the model rigid; it must be more than 0 and at most %.6g s.",
                  config.time_step, most);
    return failure(words.data());
  }
  if (lane_kernels(config.lanes) == nullptr) return failure(no_such_lanes(config.lanes));
  return std::make_unique<RigidModel>(layout, config);
}

}  // namespace topple::rigid
