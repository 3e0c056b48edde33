// Images by stb_image, which sees only PNG and JPEG: its other formats are not even compiled.
#include <memory>

#include "export/image_turn.h"
#include "export/input_file.h"
#include "topple/export.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace topple {
namespace {

struct Free {
  void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

Result<Image> load_image(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20U;
  constexpr std::int64_t kMostPixels = 100'000'000;
  const Result<std::string> bytes = read_bytes(path, kMostBytes, "an image");
  if (!bytes) return std::unexpected(bytes.error());
  const std::string name = path.string();
  if (bytes->size() > kMostBytes) return failure(name + ": is larger than the 256 MiB that are read of an image");
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes->data());
  const int size = static_cast<int>(bytes->size());
  int width = 0, height = 0, channels = 0;
  // Its size first: a few bytes can claim a picture that fills the memory.
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) return failure(name + ": is no PNG or JPEG image");
  if (std::int64_t{width} * height > kMostPixels) {
    return failure(name + ": is " + std::to_string(width) + " by " + std::to_string(height) + " pixels; at most 100 million are read");
  }
  constexpr int kRedGreenBlueOpacity = 4;
  const std::unique_ptr<stbi_uc, Free> pixels(stbi_load_from_memory(data, size, &width, &height, &channels, kRedGreenBlueOpacity));
  if (!pixels) return failure(name + ": is damaged, or a kind of PNG or JPEG that is not read");
  const std::size_t count = std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return turned({width, height, std::vector<std::uint8_t>(pixels.get(), pixels.get() + count)}, orientation_of(*bytes));
}

}  // namespace topple
