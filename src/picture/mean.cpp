#include "picture/mean.h"

#include <algorithm>

namespace topple {
namespace {

/// Calls `share` with every cell that a pixel lies in, and how much of the cell it fills. In whole numbers: no edge is missed by rounding.
template <typename Share>
void share_out(std::int64_t pixel, std::int64_t pixels, std::int64_t cells, const Share& share) {
  const std::int64_t from = pixel * cells, to = from + cells;  // the line is pixels * cells long, a cell `pixels`
  for (std::int64_t cell = from / pixels; cell < cells && cell * pixels < to; ++cell) {
    const std::int64_t both = std::min(to, (cell + 1) * pixels) - std::max(from, cell * pixels);
    share(static_cast<std::size_t>(cell), static_cast<double>(both) / static_cast<double>(pixels));
  }
}

Light light_at(const Image& image, std::size_t pixel) {
  const std::uint8_t* p = &image.pixels[4 * pixel];
  const double opaque = static_cast<double>(p[3]) / 255.0;
  return opaque * light_of({p[0], p[1], p[2]}) + (1.0 - opaque) * Light{1.0, 1.0, 1.0};
}

}  // namespace

std::vector<Light> mean_light(const Image& image, const PictureSize& size) {
  const auto count = static_cast<std::size_t>(size.count), width = static_cast<std::size_t>(image.width);
  std::vector<Light> cells(static_cast<std::size_t>(size.rows) * count);
  std::vector<Light> line(count);
  for (std::int64_t y = 0; y < image.height; ++y) {
    std::fill(line.begin(), line.end(), Light{});
    for (std::size_t x = 0; x < width; ++x) {
      const Light light = light_at(image, static_cast<std::size_t>(y) * width + x);
      share_out(static_cast<std::int64_t>(x), image.width, size.count,
                [&](std::size_t cell, double part) { line[cell] = line[cell] + part * light; });
    }
    share_out(y, image.height, size.rows, [&](std::size_t row, double part) {
      for (std::size_t i = 0; i < count; ++i) cells[row * count + i] = cells[row * count + i] + part * line[i];
    });
  }
  return cells;
}

}  // namespace topple
