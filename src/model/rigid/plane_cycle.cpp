#include "model/rigid/plane_cycle.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

PlaneCycle::Marks marks_of(const Ledger& ledger, std::span<const PlaneBrick> rested) {
  return {ledger.taken.size(), ledger.left.size(), ledger.woken.size(), ledger.rested.size(), ledger.events.size(), rested.size()};
}

void PlaneCycle::begin(BrickId struck) {
  first_ = struck;
  count_ = 0;
  whole_ = true;
}

void PlaneCycle::begin_drift(const PlaneDrift& drift, const PlaneChain& chain) {
  if (count_ == drifts_.size()) drifts_.emplace_back();
  Drift& out = drifts_[count_++];
  out.whole = drift.whole();
  out.cut = drift.cut();
  out.places.clear();
  out.arrivals.clear();
  out.moves.clear();
  for (const PlaneBrick& brick : chain.bricks) {
    if (!brick.moving) continue;
    out.places.push_back(
        {brick.id - first_, brick.landed, brick.quiet, brick.stand, brick.box.place, brick.velocity, brick.middle, brick.listed_at});
  }
}

void PlaneCycle::end_drift(const Marks& before, const Ledger& ledger, std::span<const PlaneBrick> rested, const RowPlane& plane) {
  const Marks now = marks_of(ledger, rested);
  whole_ = whole_ && now.taken >= before.taken && now.left >= before.left && now.rested >= before.rested &&
           now.rested - before.rested == now.still - before.still;
  if (!whole_) return;
  const auto numbered = [this](const std::vector<BrickId>& from, std::size_t begin, std::vector<int>& out) {
    out.clear();
    for (std::size_t i = begin; i < from.size(); ++i) out.push_back(from[i] - first_);
  };
  Drift& drift = current();
  numbered(ledger.taken, before.taken, drift.taken);
  numbered(ledger.left, before.left, drift.left);
  numbered(ledger.woken, before.woken, drift.woken);
  drift.rested.assign(rested.begin() + static_cast<std::ptrdiff_t>(before.still), rested.end());
  for (PlaneBrick& brick : drift.rested) brick.id -= first_;
  drift.events.clear();
  for (const Event& event : std::span(ledger.events).subspan(before.events)) {
    if (event.kind == EventKind::arrived) continue;  // Amid the drift.
    Happening& happening = drift.events.emplace_back(event, event.by == kNoBrick, std::isfinite(event.point.x));
    happening.event.brick -= first_;
    happening.event.by -= first_;
    happening.event.point.x = dot(event.point - plane.origin, plane.along) - plane.zero;
  }
}

void PlaneCycle::close() {
  for (Drift& drift : std::span(drifts_).first(count_)) {
    std::sort(drift.arrivals.begin(), drift.arrivals.end(), [](const Arrival& l, const Arrival& r) { return l.time < r.time; });
  }
}

}  // namespace topple::rigid
