/// The second half of a bounce.
#pragma once

#include <algorithm>

namespace topple::rigid {

/// Every point has its share of impulse more, at least. Where points share a blow or rub, that could make energy; then all shares are
/// lowered until no more comes back than restitution squared of what the first half took, as Stronge has it. `energy()` is kinetic: now
/// that after the first half, where it was `before` the blow [J], and after `bounce_by(share)` that with this share of what should come
/// back. `restitution` is the largest of all points.
template <typename BounceBy, typename Energy>
void give_back_within(double before, double restitution, const BounceBy& bounce_by, const Energy& energy) {
  const double left = energy(), taken = before - left;
  const double allowed = left + std::max(taken, 0.0) * restitution * restitution * (1.0 + 1e-3);
  bounce_by(1.0);
  if (!(energy() > allowed)) return;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 6; ++i) {
    const double share = 0.5 * (low + high);
    bounce_by(share);
    (energy() > allowed ? high : low) = share;
  }
  bounce_by(low);
}

}  // namespace topple::rigid
