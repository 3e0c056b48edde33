/// Pages to draw on in millimetres, as PDF or SVG: the only place that knows cairo.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "topple/base.h"
#include "topple/layout.h"

namespace topple::plan {

/// A place on a page, from its upper left corner [mm].
struct Point {
  double x = 0.0;
  double y = 0.0;
};
inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, const Point& a) { return {s * a.x, s * a.y}; }
inline double length(const Point& a) { return std::sqrt(a.x * a.x + a.y * a.y); }

struct Size {
  double width = 0.0;   ///< [mm]
  double height = 0.0;  ///< [mm]
};

struct Rect {
  double x = 0.0, y = 0.0;           ///< Upper left corner [mm].
  double width = 0.0, height = 0.0;  ///< [mm]

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  Point middle() const { return {x + width / 2.0, y + height / 2.0}; }
  bool has(const Point& point) const { return point.x >= x && point.x <= right() && point.y >= y && point.y <= bottom(); }
  bool has(const Rect& other) const { return other.x >= x && other.right() <= right() && other.y >= y && other.bottom() <= bottom(); }
  Rect grown(double by) const { return {x - by, y - by, width + 2.0 * by, height + 2.0 * by}; }
};

/// Inks, each readable on white paper.
inline constexpr Color kBlack{20, 20, 24};
inline constexpr Color kGrey{96, 100, 108};     ///< Of what explains.
inline constexpr Color kPale{222, 225, 229};    ///< Of the grid.
inline constexpr Color kOutline{92, 94, 98};    ///< Around bricks: also white ones are seen.
inline constexpr Color kPushInk{24, 78, 160};   ///< Of pushes.
inline constexpr Color kDoubtInk{190, 22, 40};  ///< Of places with doubts.
inline constexpr Color kWhite{255, 255, 255};

inline constexpr double kSmall = 2.5;   ///< Size of the smallest letters: 7.1 pt [mm].
inline constexpr double kNormal = 2.9;  ///< 8.2 pt [mm].

enum class Align : std::uint8_t { left, middle, right };

struct Letters {
  double size = kNormal;  ///< [mm]
  Color ink = kBlack;
  bool bold = false;
  Align align = Align::left;
  double turn = 0.0;  ///< Counter-clockwise [rad].
};

class Canvas {
 public:
  enum class Format : std::uint8_t { pdf, svg };
  Canvas(Format format, Size page, const std::string& title);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void page(Size size);  ///< Ends the page and begins another one; PDF alone has several.
  Result<std::string> finish();

  void clip(const Rect& rect);  ///< Until unclip().
  void unclip();

  void move(const Point& to);
  void line(const Point& to);
  void close();
  void quad(const Point& a, const Point& b, const Point& c, const Point& d);
  void circle(const Point& middle, double radius);
  void rect(const Rect& rect);
  void fill(const Color& ink);
  void fill_and_stroke(const Color& ink, const Color& edge, double width);
  void stroke(const Color& ink, double width, std::span<const double> dashes = {});

  void segment(const Point& from, const Point& to, const Color& ink, double width);
  void arrow_head(const Point& tip, const Point& from, double size, const Color& ink);  ///< Filled, its point at `tip`.

  double width_of(const std::string& text, double size, bool bold = false);  ///< [mm]
  /// The baseline begins, has its middle or ends at `at`.
  void text(const Point& at, const std::string& text, const Letters& letters = {});
  /// As much of the text as there is room for, an ellipsis behind it where that is not all.
  std::string fitted(const std::string& text, double width, double size, bool bold = false);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::plan
