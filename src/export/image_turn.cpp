#include "export/image_turn.h"

#include <cstring>
#include <utility>

namespace topple {
namespace {

/// Numbers of a file by their place, in its order of bytes; 0 beyond its end.
struct Bytes {
  std::string_view bytes;
  bool big_first = true;

  unsigned byte(std::size_t at) const { return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0U; }
  unsigned two(std::size_t at) const { return big_first ? byte(at) << 8U | byte(at + 1) : byte(at + 1) << 8U | byte(at); }
  unsigned four(std::size_t at) const { return big_first ? two(at) << 16U | two(at + 2) : two(at + 2) << 16U | two(at); }
};

/// Of a TIFF header and its first directory: entries of 12 bytes, tag, type, count, value.
int orientation_of_tiff(std::string_view bytes) {
  const Bytes tiff{bytes, bytes.starts_with("MM")};
  const std::size_t directory = tiff.four(4);
  const unsigned entries = tiff.two(directory);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + 12 * i;
    if (at >= bytes.size()) break;
    constexpr unsigned kOrientation = 0x0112;
    if (tiff.two(at) != kOrientation) continue;
    const unsigned value = tiff.two(at + 8);
    return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
  }
  return 1;
}

}  // namespace

int orientation_of(std::string_view jpeg) {
  using namespace std::string_view_literals;
  constexpr std::string_view kExif = "Exif\0\0"sv;
  constexpr unsigned kApplication = 0xFFE1, kFirst = 0xFFC0, kLast = 0xFFFE, kScan = 0xFFDA;
  const Bytes file{jpeg};
  if (!jpeg.starts_with("\xFF\xD8")) return 1;
  for (std::size_t at = 2; at + 4 < jpeg.size();) {
    const unsigned marker = file.two(at);
    const std::size_t length = file.two(at + 2);
    if (marker < kFirst || marker > kLast || marker == kScan || length < 2) break;
    const std::string_view content = jpeg.substr(at + 4, length - 2);
    if (marker == kApplication && content.starts_with(kExif)) return orientation_of_tiff(content.substr(kExif.size()));
    at += 2 + length;
  }
  return 1;
}

Image turned(const Image& image, int orientation) {
  if (orientation == 1) return image;
  const bool across = orientation >= 5, from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8,
             from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  Image out{image.width, image.height, std::vector<std::uint8_t>(image.pixels.size())};
  if (across) std::swap(out.width, out.height);
  for (std::int64_t y = 0; y < out.height; ++y) {
    for (std::int64_t x = 0; x < out.width; ++x) {
      const std::int64_t along = across ? y : x, down = across ? x : y;
      const std::int64_t column = from_right ? image.width - 1 - along : along, line = from_below ? image.height - 1 - down : down;
      std::memcpy(&out.pixels[static_cast<std::size_t>(4 * (y * out.width + x))],
                  &image.pixels[static_cast<std::size_t>(4 * (line * image.width + column))], 4);
    }
  }
  return out;
}

}  // namespace topple
