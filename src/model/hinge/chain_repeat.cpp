// Even rows: what a chain does not compute again.
//
// After some dozens of hits the train of an even row is, right after a hit, what it was right after the hit before, to the last bit: every
// disturbance has been forgotten. All that follows until the next hit then follows again: the same leg, the same hit, the same brick that
// goes to rest, one brick further and one leg later. So only the names of the bricks and the times are new, and a brick's whole motion is
// an echo of that of the one before.
#include "model/hinge/chain.h"

namespace topple::hinge {

void Chain::look_for_repeat(Happenings& out) {
  const bool alike = scene_->repeats && repeat_.legs == 1 && acting_ == 0 && state_.rate == repeat_.rate;
  repeat_.legs = 0;
  repeat_.rate = state_.rate;
  if (!alike) {
    repeat_.train.clear();
  } else if (train_.moves_as(repeat_.train)) {
    begin_repeat(out);
  } else {
    repeat_.train = train_;
  }
}

// What is kept is what the last leg and its hit told.
void Chain::begin_repeat(const Happenings& out) {
  const std::size_t size = train_.size();
  repeat_.on = true;
  const SinCos turned = sin_cos(repeat_.rested.angle);
  repeat_.settled = potential(repeat_.rested, turned.sin, turned.cos);
  repeat_.train.clear();
  repeat_.told.clear();
  for (std::size_t i = repeat_.kinks; i < out.kinks.size(); ++i) {
    const Kink& kink = out.kinks[i];
    Repeated told{.place = kink.brick == repeat_.rested.id ? 0 : size - index_of(kink.brick), .before = kink.before, .after = kink.after};
    for (const FrontState& node : leg_.nodes) {
      if (leg_start_ + node.time == kink.time) told.offset = node.time;
    }
    repeat_.told.push_back(told);
  }
  repeat_.arrived.resize(size);
  for (std::size_t k = 0; k < size; ++k) repeat_.arrived[k] = train_.at(k).arrived;
  repeat_.open = size;
  repeat_.like = front();
  repeat_.like_start = state_.time;
  repeat_.hits = 0;
  repeat_.times.assign(size + 1, state_.time);
}

// Whether the front strikes the next brick as it was struck itself.
bool Chain::next_is_alike() const {
  const auto same_kind = [this](BrickId a, BrickId b) {
    const std::vector<Brick>& bricks = scene_->layout->bricks;
    return bricks[static_cast<std::size_t>(a)].kind == bricks[static_cast<std::size_t>(b)].kind;
  };
  const BrickId last = front();
  const Link& link = scene_->link_of(last);
  if (link.next == kNoBrick || scene_->angle_of(link.next) != 0.0F || !same_kind(last, link.next)) return false;
  const Link& following = scene_->link_of(link.next);
  return following.next != kNoBrick && following.pitch == link.pitch && same_kind(link.next, following.next);
}

void Chain::repeat_hit(Happenings& out) {
  const std::size_t size = train_.size();
  const BrickId by = front();
  const BrickId id = scene_->link_of(by).next;
  state_.time = leg_start_ + leg_.end().time;
  leg_.count = 0;
  add_strike(id, by, repeat_.impulse, out);
  repeat_.rested.id = train_.at(size - 1).id;
  settle_with(repeat_.settled, repeat_.rested, train_.at(size - 2).id, true, out);
  for (const Repeated& told : repeat_.told) {
    const BrickId brick = told.place == size ? id : train_.at(size - 1 - told.place).id;
    if (told.place < repeat_.open) {
      out.tell({brick, leg_start_ + told.offset, told.before, told.after});
    } else {
      out.pass(brick, leg_start_ + told.offset, told.after);
    }
  }
  for (std::size_t k = size; k-- > 0;) {
    train_.at(k).id = k > 0 ? train_.at(k - 1).id : id;
    train_.at(k).arrived = repeat_.arrived[k];
  }
  scene_->angle_of(id) = HingeScene::kInTrain;
  repeat_.times[++repeat_.hits % repeat_.times.size()] = state_.time;
  if (repeat_.open > 0) {
    --repeat_.open;
  } else {  // Of the times one more is kept than there are bricks: the next is the oldest.
    const double start = repeat_.times[(repeat_.hits + 1) % repeat_.times.size()];
    out.echoes.push_back({repeat_.rested.id, repeat_.like, start, repeat_.like_start});
  }
}

// What was left to echoes is told, and everything is computed from here on.
void Chain::end_repeat(Happenings& out) {
  if (!repeat_.on) return;
  tell_silent(out.kinks);
  repeat_.on = false;
  repeat_.legs = 0;
}

void Chain::tell_silent(std::vector<Kink>& out) const {
  if (!repeat_.on) return;
  const std::size_t size = train_.size();
  const auto time_of = [this](std::size_t hit) { return repeat_.times[hit % repeat_.times.size()]; };
  for (std::size_t k = size - repeat_.open; k-- > 0;) {
    const std::size_t struck = repeat_.hits - k;
    for (std::size_t hit = struck; hit <= repeat_.hits; ++hit) {
      for (const Repeated& told : repeat_.told) {
        if (told.place + hit == size + struck) out.push_back({train_.at(k).id, time_of(hit - 1) + told.offset, told.before, told.after});
      }
    }
  }
}

}  // namespace topple::hinge
