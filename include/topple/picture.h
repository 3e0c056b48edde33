/// Pictures made of bricks: an image's pixels become the rows of a field, each brick in the nearest colour there is, never more bricks of a
/// colour than there are. Nothing of an image but its pixels: files are read by topple/export.h, and by the page's browser.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "topple/layout.h"

namespace topple {

/// Pixels line by line from the upper left: red, green, blue (sRGB) and opacity, a byte each. What is not opaque lies on white.
struct Image {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<std::uint8_t> pixels;  ///< 4 * width * height.
};

/// A colour that bricks come in.
struct StockColor {
  static constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();
  Color color;
  std::int64_t stock = kAny;  ///< How many bricks of it there are.
};

/// Real dominoes' colours, for who says none.
struct NamedColor {
  const char* name;
  char letter;  ///< What stands for it in a layout file.
  Color color;
};
std::span<const NamedColor> usual_colors();
/// "#f0821e orange"; of a colour without a name "#c0392b".
std::string name_of(const Color& color);

/// How many bricks: `rows` side by side, `count` in each.
struct PictureSize {
  std::int64_t rows = 0;
  std::int64_t count = 0;
};
/// The size at which a field with these pitches [m] shows an image in its true proportions, as nearly as whole bricks can. Of `wanted`
/// what is 0 follows from the other; where both are, from `bricks`, about so many in all. At least 1 by 1.
PictureSize fit_picture(const Image& image, double pitch, double row_pitch, PictureSize wanted, std::int64_t bricks);

struct PictureConfig {
  PictureSize size;
  std::vector<StockColor> colors;  ///< 1 to 62.
  bool dither = false;             ///< Mixes colours over neighbouring bricks where none is near.
};

/// A picture as it is seen from above with the rows falling to the right.
struct Picture {
  PictureSize size;
  std::vector<StockColor> colors;
  std::vector<std::uint8_t> cells;  ///< Which colour, line by line from the upper left; the first line is the field's last row.
  std::vector<std::int64_t> used;   ///< Bricks by colour, never more than its stock.
};

/// Each brick gets the mean light of its cell of the image and the colour that looks most like it (OKLab). Where a colour's stock is short,
/// the bricks that another colour suits best go without, so that what is lost is least in all. The same bits on every machine.
/// Fails in words: no colours or pixels, more than 10,000,000 bricks, or fewer bricks in stock than the picture takes.
Result<Picture> make_picture(const Image& image, const PictureConfig& config);

/// `palette` and `picture` as a [[field]] of a layout file has them (docs/layout.md), a line of text for each row.
std::string picture_text(const Picture& picture);

}  // namespace topple
