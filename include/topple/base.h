/// The words every chapter uses: results, errors, vectors, quaternions and the identity of a brick.
#pragma once

#include <cmath>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace topple {

/// Threads that share the work of one run: made where the run is (RunConfig::threads), handed on to who can use them.
class Crew;
/// Where the time of a run goes (topple/profile.h): asked for by RunConfig::profile.
class Profile;

/// Why something that a person asked for cannot be done, in sentences. May hold several lines, one a problem.
struct Error {
  std::string message;
};

template <typename T>
using Result = std::expected<T, Error>;

[[nodiscard]] inline std::unexpected<Error> failure(std::string message) { return std::unexpected(Error{std::move(message)}); }

/// 16 hexadecimal digits.
std::string hash_digits(std::uint64_t hash);

/// A brick's place in layout order, from 0; what messages and files call a brick.
using BrickId = std::int32_t;
inline constexpr BrickId kNoBrick = -1;

/// A vector; in the world right-handed with z up, in a brick x along its heading, y to its left, z along its height.
struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

/// A unit quaternion: the rotation that takes a brick's axes to the world's.
struct Quat {
  double w = 1.0;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

constexpr Quat operator*(const Quat& a, const Quat& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quat conjugate(const Quat& q) { return {q.w, -q.x, -q.y, -q.z}; }
constexpr Vec3 rotate(const Quat& q, const Vec3& v) {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}

/// Where a brick is: its centre of mass [m] and its orientation.
struct Pose {
  Vec3 position;
  Quat orientation;
};

}  // namespace topple
