#include "model/rigid/contact.h"

#include "model/rigid/ball.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace topple::rigid {

namespace {

// Axes of the separating axis test: 0-2 faces of a, 3-5 faces of b, 6-14 edges of a (slow) crossed with edges of b (fast).
constexpr int kFirstEdgeAxis = 6, kAxes = 15;

// Everything the axes share. [Gottschalk1996] section 5: T and R in a's axes, here with |R| beside R.
struct BoxPair {
  Vec3 apart;  // From a's centre to b's.
  std::array<Vec3, 3> a_axis, b_axis;
  std::array<double, 3> a_half{}, b_half{};
  std::array<double, 3> a_apart{}, b_apart{};   // `apart` along the axes of a and of b.
  std::array<std::array<double, 3>, 3> r{};     // a_axis[i] . b_axis[j]
  std::array<std::array<double, 3>, 3> size{};  // |r|
};

BoxPair pair_up(const Body& a, const Body& b) {
  BoxPair p;
  p.apart = b.position - a.position;
  p.a_half = {a.half.x, a.half.y, a.half.z};
  p.b_half = {b.half.x, b.half.y, b.half.z};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    p.a_axis[k] = column(a.axes, i);
    p.b_axis[k] = column(b.axes, i);
    p.a_apart[k] = dot(p.apart, p.a_axis[k]);
    p.b_apart[k] = dot(p.apart, p.b_axis[k]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      p.r[i][j] = dot(p.a_axis[i], p.b_axis[j]);
      p.size[i][j] = std::abs(p.r[i][j]);
    }
  }
  return p;
}

inline double face_separation(const BoxPair& p, std::size_t axis) {
  const std::size_t k = axis % 3;
  if (axis < 3)
    return std::abs(p.a_apart[k]) - p.a_half[k] - p.size[k][0] * p.b_half[0] - p.size[k][1] * p.b_half[1] - p.size[k][2] * p.b_half[2];
  return std::abs(p.b_apart[k]) - p.b_half[k] - p.size[0][k] * p.a_half[0] - p.size[1][k] * p.a_half[1] - p.size[2][k] * p.a_half[2];
}

// Minus infinity where the two edges are so nearly parallel that a face axis does as well, or where the boxes overlap along the axis by so
// much more than `needed` (at most zero) that it does not matter how much.
inline double edge_separation(const BoxPair& p, std::size_t axis, double needed) {
  const std::size_t i = (axis - kFirstEdgeAxis) / 3, j = (axis - kFirstEdgeAxis) % 3;
  const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  const double distance = std::abs(p.a_apart[i2] * p.r[i1][j] - p.a_apart[i1] * p.r[i2][j]);
  const double reach =
      p.a_half[i1] * p.size[i2][j] + p.a_half[i2] * p.size[i1][j] + p.b_half[j1] * p.size[i][j2] + p.b_half[j2] * p.size[i][j1];
  // The length of the axis, by which this is divided, is at most one.
  if (distance - reach < needed) return -std::numeric_limits<double>::infinity();
  const double sine_squared = 1.0 - p.r[i][j] * p.r[i][j];
  if (sine_squared < 1e-6) return -std::numeric_limits<double>::infinity();
  return (distance - reach) / std::sqrt(sine_squared);
}

// Along a face of one of them alone, as face_separation() has it.
double face_separation(const Body& a, const Body& b, int axis) {
  const Body &own = axis < 3 ? a : b, &other = axis < 3 ? b : a;
  const Vec3 normal = column(own.axes, axis % 3);
  return std::abs(dot(b.position - a.position, normal)) - component(own.half, axis % 3) -
         std::abs(dot(normal, column(other.axes, 0))) * other.half.x - std::abs(dot(normal, column(other.axes, 1))) * other.half.y -
         std::abs(dot(normal, column(other.axes, 2))) * other.half.z;
}

inline double separation_on(const BoxPair& p, std::size_t axis, double needed) {
  return axis < kFirstEdgeAxis ? face_separation(p, axis) : edge_separation(p, axis, needed);
}

// A corner of the polygon that is left of a face: its place in the axes of the other face, and how far in front of that it is.
struct ClipVertex {
  double u, v, separation;
  std::uint32_t tag;
};

struct Polygon {
  int count = 0;
  std::array<ClipVertex, 12> vertices;  // Only `count` of them have been written.
  void add(const ClipVertex& v) { vertices[static_cast<std::size_t>(count++)] = v; }
};

// Sutherland and Hodgman: keeps what lies on the inner side, sign * coordinate <= limit. Returns whether there was anything to cut off;
// else `out` is not written.
template <double ClipVertex::* kCoordinate>
bool clip(const Polygon& in, double sign, double limit, std::uint32_t plane, Polygon& out) {
  const auto beyond = [&](const ClipVertex& vertex) { return sign * vertex.*kCoordinate - limit; };
  const auto begin = in.vertices.begin(), end = begin + in.count;
  if (std::all_of(begin, end, [&](const ClipVertex& vertex) { return beyond(vertex) <= 0.0; })) return false;
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const ClipVertex& from = in.vertices[static_cast<std::size_t>(i)];
    const ClipVertex& to = in.vertices[static_cast<std::size_t>(i + 1 < in.count ? i + 1 : 0)];
    const double d0 = beyond(from), d1 = beyond(to);
    if (d0 <= 0.0) out.add(from);
    if ((d0 <= 0.0) != (d1 <= 0.0)) {
      const double share = d0 / (d0 - d1);
      // A plane cuts a convex polygon twice: on the way out and on the way in.
      out.add({from.u + share * (to.u - from.u), from.v + share * (to.v - from.v),
               from.separation + share * (to.separation - from.separation), 4U + 2U * plane + (d0 <= 0.0 ? 0U : 1U)});
    }
  }
  return true;
}

// The face of `body` that looks most against `direction`: its middle, and from there half its length and half its width.
struct Face {
  Vec3 middle, half_u, half_v;
  std::uint32_t number = 0;
};

Face facing(const Body& body, const Vec3& direction) {
  const Vec3 local = transposed_times(body.axes, direction);
  const double ax = std::abs(local.x), ay = std::abs(local.y), az = std::abs(local.z);
  const int axis = (ax >= ay && ax >= az) ? 0 : (ay >= az ? 1 : 2);
  const double side = component(local, axis) > 0.0 ? -1.0 : 1.0;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return {body.position + (side * component(body.half, axis)) * column(body.axes, axis), component(body.half, u) * column(body.axes, u),
          component(body.half, v) * column(body.axes, v), static_cast<std::uint32_t>(2 * axis + (side > 0.0 ? 1 : 0))};
}

// Clips the face of `other` that looks at the reference face by the sides of that face.
void face_points(const Body& base, const Body& other, int face_axis, const Vec3& outward, double margin, Manifold& out) {
  const Face face = facing(other, outward);
  const int u = (face_axis + 1) % 3, v = (face_axis + 2) % 3;
  const Vec3 along_u = column(base.axes, u), along_v = column(base.axes, v);
  const auto in_face = [&](const Vec3& way) { return ClipVertex{dot(along_u, way), dot(along_v, way), dot(outward, way)}; };
  const ClipVertex middle = in_face(face.middle - base.position), to_u = in_face(face.half_u), to_v = in_face(face.half_v);
  const double depth = component(base.half, face_axis);
  Polygon front, back;
  const auto add_corner = [&](double s, double t, std::uint32_t tag) {
    front.add({middle.u + s * to_u.u + t * to_v.u, middle.v + s * to_u.v + t * to_v.v,
               middle.separation + s * to_u.separation + t * to_v.separation - depth, tag});
  };
  add_corner(1.0, 1.0, 0);
  add_corner(-1.0, 1.0, 1);
  add_corner(-1.0, -1.0, 2);
  add_corner(1.0, -1.0, 3);
  Polygon* in = &front;
  Polygon* result = &back;
  // A hair's breadth wider, so that bricks of one width keep their corners instead of cutting them at random.
  const double hair = 1e-7 * base.radius;
  const double limit_u = component(base.half, u) + hair, limit_v = component(base.half, v) + hair;
  if (clip<&ClipVertex::u>(*in, 1.0, limit_u, 1, *result)) std::swap(in, result);
  if (clip<&ClipVertex::u>(*in, -1.0, limit_u, 2, *result)) std::swap(in, result);
  if (clip<&ClipVertex::v>(*in, 1.0, limit_v, 3, *result)) std::swap(in, result);
  if (clip<&ClipVertex::v>(*in, -1.0, limit_v, 4, *result)) std::swap(in, result);
  const std::uint32_t code = (out.reference == Reference::a ? 1U << 16 : 2U << 16) + (face.number << 8);
  out.count = 0;
  for (int i = 0; i < in->count && out.count < 8; ++i) {
    const ClipVertex& vertex = in->vertices[static_cast<std::size_t>(i)];
    if (vertex.separation > margin) continue;
    const Vec3 place = base.position + vertex.u * along_u + vertex.v * along_v + (depth + vertex.separation) * outward;
    out.points[static_cast<std::size_t>(out.count++)] = {place, vertex.separation, code + vertex.tag};
  }
}

// The closest points of the two edges whose cross product is the axis.
void edge_point(const BoxPair& p, const Body& a, const Body& b, int axis, double separation, Manifold& out) {
  const auto i = static_cast<std::size_t>((axis - kFirstEdgeAxis) / 3);
  const auto j = static_cast<std::size_t>((axis - kFirstEdgeAxis) % 3);
  Vec3 normal = cross(p.a_axis[i], p.b_axis[j]);
  normal = (1.0 / norm(normal)) * normal;
  if (dot(normal, p.apart) > 0.0) normal = -normal;  // From b to a.
  Vec3 on_a = a.position, on_b = b.position;
  std::uint32_t corner = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k != i) {
      const double side = dot(p.a_axis[k], normal) > 0.0 ? -1.0 : 1.0;
      on_a = on_a + (side * p.a_half[k]) * p.a_axis[k];
      corner = 2 * corner + (side > 0.0 ? 1U : 0U);
    }
    if (k != j) {
      const double side = dot(p.b_axis[k], normal) > 0.0 ? 1.0 : -1.0;
      on_b = on_b + (side * p.b_half[k]) * p.b_axis[k];
      corner = 2 * corner + (side > 0.0 ? 1U : 0U);
    }
  }
  // Closest points of two lines, [Ericson2005] section 5.1.8.
  const Vec3 between = on_a - on_b;
  const double c = p.r[i][j];
  const double along_a = dot(p.a_axis[i], between), along_b = dot(p.b_axis[j], between);
  const double s = (c * along_b - along_a) / (1.0 - c * c);
  const double t = (along_b - c * along_a) / (1.0 - c * c);
  const Vec3 pa = on_a + s * p.a_axis[i];
  const Vec3 pb = on_b + t * p.b_axis[j];
  out.normal = normal;
  out.reference = Reference::edges;
  out.count = 1;
  out.points[0] = {0.5 * (pa + pb), separation, (4U << 16) + (static_cast<std::uint32_t>(axis) << 8) + corner};
}

// The axis along which two boxes are farthest apart, or overlap least. A face is kept, and preferred to an edge, unless another axis is
// clearly better: flips of the normal cost warm starts.
struct AxisSearch {
  const BoxPair& pair;
  double margin = 0.0;
  int kept = -1;  // The axis of the last time.
  double kept_bonus = 0.0, edge_malus = 0.0;
  int axis = -1;
  double separation = -std::numeric_limits<double>::infinity();
  double score = separation;

  // Whether it parts them.
  template <std::size_t kAxis>
  bool look() {
    const double found = separation_on(pair, kAxis, std::min(score, 0.0));
    const double rated = found + (static_cast<int>(kAxis) == kept ? kept_bonus : 0.0) - (kAxis >= kFirstEdgeAxis ? edge_malus : 0.0);
    const bool parts = found > margin;
    if (!parts && rated <= score) return false;
    score = rated;
    axis = static_cast<int>(kAxis);
    separation = found;
    return parts;
  }
  template <std::size_t... kEach>
  bool look_along(std::index_sequence<kEach...> /*axes*/) {
    return (look<kEach>() || ...);
  }
};

}  // namespace

void Manifold::take(const Manifold& from) {
  normal = from.normal;
  reference = from.reference;
  axis = from.axis;
  parted = from.parted;
  count = from.count;
  std::copy_n(from.points.begin(), count, points.begin());
}

void touch_floor(const Body& a, double margin, Manifold& out) {
  if (a.round) return touch_floor_with_ball(a, margin, out);
  out.normal = {0.0, 0.0, 1.0};
  out.reference = Reference::b;
  out.count = 0;
  const Vec3 up = a.axes.r2;  // Height of each of the brick's axes.
  const double reach = std::abs(up.x) * a.half.x + std::abs(up.y) * a.half.y + std::abs(up.z) * a.half.z;
  out.parted = a.position.z - reach;
  if (out.parted > margin) return;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const Vec3 local{(corner & 1U) != 0 ? a.half.x : -a.half.x, (corner & 2U) != 0 ? a.half.y : -a.half.y,
                     (corner & 4U) != 0 ? a.half.z : -a.half.z};
    const double height = a.position.z + dot(up, local);
    if (height > margin) continue;
    const Vec3 arm = a.axes * local;
    out.points[static_cast<std::size_t>(out.count++)] = {a.position + arm, height, corner};
  }
}

void touch_boxes(const Body& a, const Body& b, double margin, Manifold& out) {
  if (a.round || b.round) return touch_ball(a, b, margin, out);
  out.count = 0;
  int& axis = out.axis;
  if (axis >= 0 && axis < kFirstEdgeAxis) {
    out.parted = face_separation(a, b, axis);
    if (out.parted > margin) return;
  }
  const BoxPair p = pair_up(a, b);
  if (axis >= kFirstEdgeAxis) {
    out.parted = separation_on(p, static_cast<std::size_t>(axis), -std::numeric_limits<double>::infinity());
    if (out.parted > margin) return;
  }
  const double thinnest = 2.0 * std::min(std::min({a.half.x, a.half.y, a.half.z}), std::min({b.half.x, b.half.y, b.half.z}));
  AxisSearch best{.pair = p, .margin = margin, .kept = axis, .kept_bonus = 1e-3 * thinnest, .edge_malus = 3e-3 * thinnest};
  const bool parted = best.look_along(std::make_index_sequence<kAxes>());
  axis = best.axis;
  out.parted = best.separation;
  if (parted) return;
  if (axis >= kFirstEdgeAxis) {
    edge_point(p, a, b, axis, best.separation, out);
  } else if (axis < 3) {
    const Vec3 face = p.a_axis[static_cast<std::size_t>(axis)];
    const Vec3 outward = dot(face, p.apart) > 0.0 ? face : -face;
    out.normal = -outward;
    out.reference = Reference::a;
    face_points(a, b, axis, outward, margin, out);
  } else {
    const Vec3 face = p.b_axis[static_cast<std::size_t>(axis - 3)];
    const Vec3 outward = dot(face, p.apart) > 0.0 ? -face : face;
    out.normal = outward;
    out.reference = Reference::b;
    face_points(b, a, axis - 3, outward, margin, out);
  }
}

}  // namespace topple::rigid
