#include "recording/hermite.h"

#include <algorithm>

namespace topple {
namespace {

// The last knot at or before `time`: of two at one time the second, so that a jump shows what came after it.
template <typename Knot>
std::size_t knot_before(std::span<const Knot> knots, double time) {
  const auto next = std::upper_bound(knots.begin(), knots.end(), time, [](double t, const Knot& knot) { return t < double{knot.time}; });
  return next == knots.begin() ? 0 : static_cast<std::size_t>(next - knots.begin()) - 1;
}

HingedState state_of(const HingedKnot& knot) { return {double{knot.angle}, double{knot.rate}, double{knot.acceleration}}; }

Vec3 position_of(const FreeKnot& k) { return {k.x, k.y, k.z}; }
Vec3 velocity_of(const FreeKnot& k) { return {k.vx, k.vy, k.vz}; }
Vec3 spin_of(const FreeKnot& k) { return {k.wx, k.wy, k.wz}; }
Quat quat_of(const FreeKnot& k) { return {k.qw, k.qx, k.qy, k.qz}; }

Quat operator+(const Quat& a, const Quat& b) { return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z}; }
Quat operator*(double s, const Quat& a) { return {s * a.w, s * a.x, s * a.y, s * a.z}; }
double norm2(const Quat& a) { return a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z; }
Quat derivative(const Quat& q, const Vec3& spin) { return 0.5 * (Quat{0.0, spin.x, spin.y, spin.z} * q); }

Quat normalised(const Quat& q) {
  const double square = norm2(q);
  return square > 0.0 ? (1.0 / std::sqrt(square)) * q : Quat{};
}

FreeState state_of(const FreeKnot& k) { return {position_of(k), normalised(quat_of(k)), velocity_of(k), spin_of(k)}; }

// The cubic Hermite polynomial and its derivative by time; T is anything with + and a product by a number.
template <typename T>
struct Cubic {
  T value;
  T rate;
};
template <typename T>
Cubic<T> cubic(const T& from, const T& from_rate, const T& to, const T& to_rate, double span, double u) {
  const double v = 1.0 - u;
  const double lead = 6.0 * u * v / span;
  return {v * v * (1.0 + 2.0 * u) * from + span * u * v * v * from_rate + u * u * (3.0 - 2.0 * u) * to + -span * u * u * v * to_rate,
          -lead * from + v * (1.0 - 3.0 * u) * from_rate + lead * to + u * (3.0 * u - 2.0) * to_rate};
}

}  // namespace

HingedState state_at(std::span<const HingedKnot> knots, double time) {
  const std::size_t i = knot_before(knots, time);
  const HingedKnot& knot = knots[i];
  if (i + 1 == knots.size() || time <= double{knot.time}) return state_of(knot);
  const double span = double{knots[i + 1].time} - double{knot.time};
  const double u = (time - double{knot.time}) / span;
  const Quintic curve = quintic(knot, knots[i + 1], span);
  return {double{knot.angle} + curve.at(u), curve.slope(u) / span, curve.bend(u) / (span * span)};
}

FreeState between(const FreeKnot& first, const FreeKnot& last, double span, double u) {
  const auto place = cubic(position_of(first), velocity_of(first), position_of(last), velocity_of(last), span, u);
  const Quat from = quat_of(first);
  // q and -q are one orientation: the shorter way is meant.
  Quat to = quat_of(last);
  if (from.w * to.w + from.x * to.x + from.y * to.y + from.z * to.z < 0.0) to = -1.0 * to;
  const auto turn = cubic(from, derivative(from, spin_of(first)), to, derivative(to, spin_of(last)), span, u);
  const double square = norm2(turn.value);
  // The rotation's rate is the vector part of 2 q' conj(q) / |q|^2; normalising q changes only the scalar part.
  const Quat spin = turn.rate * conjugate(turn.value);
  const double scale = square > 0.0 ? 2.0 / square : 0.0;
  return {place.value, normalised(turn.value), place.rate, {scale * spin.x, scale * spin.y, scale * spin.z}};
}

FreeState state_at(std::span<const FreeKnot> knots, double time) {
  const std::size_t i = knot_before(knots, time);
  if (i + 1 == knots.size() || time <= double{knots[i].time}) return state_of(knots[i]);
  const double span = double{knots[i + 1].time} - double{knots[i].time};
  return between(knots[i], knots[i + 1], span, (time - double{knots[i].time}) / span);
}

}  // namespace topple
