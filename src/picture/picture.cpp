#include "topple/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "layout/text.h"
#include "picture/choice.h"
#include "picture/mean.h"

namespace topple {
namespace {

constexpr std::int64_t kMostBricks = 10'000'000;  // as many as a layout may have
constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

std::string words_for(std::int64_t bricks) { return count_text(bricks) + (bricks == 1 ? " brick" : " bricks"); }

/// The stock of all colours; as much as is ever needed where one of them is without limit.
std::int64_t whole_stock(std::span<const StockColor> colors) {
  std::int64_t sum = 0;
  for (const StockColor& one : colors) sum += std::min(one.stock, kMostBricks);
  return sum;
}

/// A letter for each colour: a usual one's own, and what is left for the others.
std::string letters_for(std::span<const StockColor> colors) {
  std::string letters(colors.size(), '\0');
  const auto take = [&](std::size_t i, char letter) {
    if (letters.find(letter) == std::string::npos) letters[i] = letter;
  };
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (const NamedColor& usual : usual_colors()) {
      if (usual.color == colors[i].color) take(i, usual.letter);
    }
  }
  std::string_view left = kLetters;
  for (char& letter : letters) {
    while (letter == '\0') {
      if (letters.find(left.front()) == std::string::npos) letter = left.front();
      left.remove_prefix(1);
    }
  }
  return letters;
}

/// A letter as a key of TOML: a sign stands in quotes.
std::string key_of(char letter) {
  const std::string key(1, letter);
  return kLetters.find(letter) == std::string_view::npos ? '"' + key + '"' : key;
}

}  // namespace

std::span<const NamedColor> usual_colors() {
  static constexpr std::array<NamedColor, 12> kUsual{{{"red", 'r', {0xd9, 0x2b, 0x2b}},
                                                      {"orange", 'o', {0xf0, 0x82, 0x1e}},
                                                      {"yellow", 'y', {0xf2, 0xb9, 0x28}},
                                                      {"green", 'g', {0x3f, 0xaa, 0x46}},
                                                      {"teal", 't', {0x17, 0xa3, 0x98}},
                                                      {"blue", 'b', {0x14, 0x78, 0xc8}},
                                                      {"royal blue", 'B', {0x2b, 0x5b, 0xd9}},
                                                      {"violet", 'v', {0x78, 0x32, 0xbe}},
                                                      {"crimson", 'c', {0xc2, 0x18, 0x5b}},
                                                      {"ivory", '.', {0xf4, 0xf1, 0xe8}},
                                                      {"slate", 's', {0x5d, 0x6d, 0x7e}},
                                                      {"black", '#', {0x23, 0x26, 0x2b}}}};
  return kUsual;
}

std::string name_of(const Color& color) {
  for (const NamedColor& usual : usual_colors()) {
    if (usual.color == color) return color_text(color) + " " + usual.name;
  }
  return color_text(color);
}

PictureSize fit_picture(const Image& image, double pitch, double row_pitch, PictureSize wanted, std::int64_t bricks) {
  if (wanted.rows > 0 && wanted.count > 0) return wanted;
  const double shape =
      static_cast<double>(std::max<std::int64_t>(image.width, 1)) / static_cast<double>(std::max<std::int64_t>(image.height, 1));
  const double count_per_row = shape * row_pitch / pitch;  // of a picture with a single row
  const auto whole = [](double number) { return static_cast<std::int64_t>(std::floor(std::min(std::max(number, 1.0), 1e9) + 0.5)); };
  if (wanted.count > 0) return {whole(static_cast<double>(wanted.count) / count_per_row), wanted.count};
  const std::int64_t rows = wanted.rows > 0 ? wanted.rows : whole(std::sqrt(static_cast<double>(bricks) / count_per_row));
  return {rows, whole(static_cast<double>(rows) * count_per_row)};
}

Result<Picture> make_picture(const Image& image, const PictureConfig& config) {
  const auto [rows, count] = config.size;
  if (image.width < 1 || image.height < 1 || std::ssize(image.pixels) != 4 * image.width * image.height)
    return failure("The image has no pixels.");
  if (rows < 1 || count < 1 || count > kMostBricks / rows) {
    return failure(std::to_string(rows) + " rows of " + words_for(count) + " cannot be a picture: 1 to 10,000,000 in all are allowed.");
  }
  if (config.colors.empty() || config.colors.size() > kLetters.size())
    return failure("There are " + std::to_string(config.colors.size()) + " colours; 1 to " + std::to_string(kLetters.size()) +
                   " are allowed.");
  const std::int64_t missing = rows * count - whole_stock(config.colors);
  if (missing > 0) {
    return failure("The picture takes " + words_for(rows * count) + ", and of these colours there are " +
                   words_for(whole_stock(config.colors)) + ": " + std::to_string(missing) +
                   (missing == 1 ? " is missing." : " are missing."));
  }
  Picture picture{config.size, config.colors, {}, {}};
  choose_colors(mean_light(image, config.size), config.dither, picture);
  return picture;
}

std::string picture_text(const Picture& picture) {
  const std::string letters = letters_for(picture.colors);
  std::string text = "palette = {";
  for (std::size_t i = 0; i < picture.colors.size(); ++i) {
    if (picture.used[i] == 0) continue;
    text += text.back() == '{' ? " " : ", ";
    text += key_of(letters[i]) + " = \"" + color_text(picture.colors[i].color) + '"';
  }
  text += " }\npicture = [\n";
  const auto count = static_cast<std::size_t>(picture.size.count);
  for (std::size_t first = 0; first < picture.cells.size(); first += count) {
    text += "  \"";
    for (std::size_t i = first; i < first + count; ++i) text += letters[picture.cells[i]];
    text += "\",\n";
  }
  return text + "]\n";
}

}  // namespace topple
