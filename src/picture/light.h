/// Colours as light and as they are seen.
#pragma once

#include "topple/layout.h"

namespace topple {

/// Linear light of sRGB's primaries, 0 to 1: what adds up where colours mix.
struct Light {
  double red = 0.0, green = 0.0, blue = 0.0;
};
constexpr Light operator+(const Light& a, const Light& b) { return {a.red + b.red, a.green + b.green, a.blue + b.blue}; }
constexpr Light operator-(const Light& a, const Light& b) { return {a.red - b.red, a.green - b.green, a.blue - b.blue}; }
constexpr Light operator*(double s, const Light& a) { return {s * a.red, s * a.green, s * a.blue}; }

/// OKLab [Ottosson2020]: lightness from 0 to 1, and two axes of colour. Equal distances look about equally large.
struct Seen {
  double lightness = 0.0, green_red = 0.0, blue_yellow = 0.0;
};

Light light_of(const Color& color);
/// Also of light below 0 or above 1, which is where errors of dithering lead.
Seen seen(const Light& light);
double squared_distance(const Seen& a, const Seen& b);

}  // namespace topple
