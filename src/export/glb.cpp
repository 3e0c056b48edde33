// The format: the glTF 2.0 specification of the Khronos Group, sections 3.6 (buffers, accessors) and 4 (GLB).
#include "export/glb.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/hash.h"
#include "export/output_file.h"

namespace topple {
namespace {

constexpr int kUnsignedShort = 5123, kFloat = 5126;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::uint64_t kHeads = 12 + 8 + 8;  // Of the file and of its two chunks [bytes].

constexpr std::uint64_t round_up(std::uint64_t size) { return (size + 3) / 4 * 4; }

std::string text_of(const GltfJson& json) { return json.dump(-1, ' ', false, GltfJson::error_handler_t::replace); }

template <typename T>
std::span<const std::uint8_t> bytes_of_numbers(std::span<const T> numbers) {
  return {reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size_bytes()};
}

std::string list(const char* name, const GltfList& items) {
  return items.size() == 0 ? std::string() : ",\"" + std::string(name) + "\":[" + items.text() + "]";
}

std::uint64_t hash_of(std::span<const float> numbers) {
  Hash hash;
  for (const float number : numbers) hash.add(std::uint64_t{std::bit_cast<std::uint32_t>(number)});
  return hash.value();
}

}  // namespace

int GltfList::add(const GltfJson& item) {
  if (size_ > 0) text_ += ',';
  text_ += text_of(item);
  return size_++;
}

int Glb::add_accessor(View view, std::span<const std::uint8_t> bytes, GltfJson accessor) {
  std::vector<std::uint8_t>& all = bytes_of(view);
  accessor["bufferView"] = static_cast<int>(view);
  accessor["byteOffset"] = all.size();
  all.insert(all.end(), bytes.begin(), bytes.end());
  return accessors_.add(accessor);
}

int Glb::add_corners(std::span<const std::uint16_t> corners) {
  return add_accessor(View::corners, bytes_of_numbers(corners),
                      {{"componentType", kUnsignedShort}, {"count", corners.size()}, {"type", "SCALAR"}});
}

int Glb::add_vertices(std::span<const float> numbers, bool bounds) {
  GltfJson accessor = {{"componentType", kFloat}, {"count", numbers.size() / 3}, {"type", "VEC3"}};
  if (bounds) {
    std::array<float, 3> low{numbers[0], numbers[1], numbers[2]}, high = low;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      low[i % 3] = std::min(low[i % 3], numbers[i]);
      high[i % 3] = std::max(high[i % 3], numbers[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }
  return add_accessor(View::vertices, bytes_of_numbers(numbers), std::move(accessor));
}

int Glb::add_times(std::span<const float> times) {
  return add_accessor(View::motion, bytes_of_numbers(times),
                      {{"componentType", kFloat},
                       {"count", times.size()},
                       {"type", "SCALAR"},
                       {"min", GltfJson::array({times.front()})},
                       {"max", GltfJson::array({times.back()})}});
}

int Glb::add_keys(const char* type, int components, std::span<const float> numbers) {
  const std::span<const std::uint8_t> bytes = bytes_of_numbers(numbers);
  const std::uint64_t hash = hash_of(numbers);
  const std::vector<std::uint8_t>& all = bytes_of(View::motion);
  for (auto [it, end] = known_.equal_range(hash); it != end; ++it) {
    const Known& known = it->second;
    if (known.size == bytes.size() && std::memcmp(all.data() + known.begin, bytes.data(), bytes.size()) == 0) return known.accessor;
  }
  const std::size_t begin = all.size();
  const int accessor = add_accessor(
      View::motion, bytes, {{"componentType", kFloat}, {"count", numbers.size() / static_cast<std::size_t>(components)}, {"type", type}});
  known_.emplace(hash, Known{begin, bytes.size(), accessor});
  return accessor;
}

std::uint64_t Glb::buffer_size() const {
  std::uint64_t size = 0;
  for (const auto& view : views_) size += round_up(view.size());
  return size;
}

bool Glb::is_full() const {
  std::uint64_t text = 0;
  for (const GltfList* items : {&nodes, &meshes, &materials, &channels, &samplers, &accessors_}) text += items->text().size();
  return kHeads + text + buffer_size() > most_;
}

std::string Glb::json(const Frame& frame) const {
  GltfList views;
  std::uint64_t begin = 0;
  for (std::size_t i = 0; i < kViews; ++i) {
    if (views_[i].empty()) break;  // The last one alone may be: a run in which nothing moves.
    GltfJson view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", views_[i].size()}};
    if (static_cast<View>(i) == View::corners) view["target"] = kIndexBuffer;
    if (static_cast<View>(i) == View::vertices) view.update({{"target", kVertexBuffer}, {"byteStride", 3 * sizeof(float)}});
    views.add(view);
    begin += round_up(views_[i].size());
  }
  const GltfJson asset = {{"version", "2.0"}, {"generator", "Topple " TOPPLE_VERSION}, {"extras", frame.extras}};
  const GltfJson scene = {{"nodes", GltfJson::array({frame.root})}};
  std::string text = "{\"asset\":" + text_of(asset) + ",\"scene\":0,\"scenes\":[" + text_of(scene) + "]";
  text += list("nodes", nodes) + list("meshes", meshes) + list("materials", materials);
  if (channels.size() > 0) {
    const std::string name = text_of(frame.animation);
    text += ",\"animations\":[{\"name\":" + name + list("channels", channels) + list("samplers", samplers) + "}]";
  }
  text += list("accessors", accessors_) + list("bufferViews", views);
  text += ",\"buffers\":[{\"byteLength\":" + std::to_string(buffer_size()) + "}]}";
  text.resize(round_up(text.size()), ' ');
  return text;
}

Result<void> Glb::write(const Frame& frame, const std::filesystem::path& path) const {
  const std::string text = json(frame);
  const std::uint64_t size = kHeads + text.size() + buffer_size();
  if (size > most_)
    return failure(path.string() + ": a .glb holds at most 4 GiB, and this run takes more; fewer bricks or a shorter run fit");
  auto file = OutputFile::create(path, OutputFile::Unfinished::removed);
  if (!file) return std::unexpected(file.error());
  Result<void> written;
  const auto put = [&](std::span<const std::uint8_t> bytes) {
    if (written && !bytes.empty()) written = file->write(bytes);
  };
  const auto put_words = [&](std::initializer_list<std::uint64_t> words) {
    for (const std::uint64_t word : words) {
      const auto half = static_cast<std::uint32_t>(word);
      put(bytes_of_numbers(std::span(&half, 1)));
    }
  };
  put_words({kMagic, kVersion, size, text.size(), kJsonChunk});
  put({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  put_words({buffer_size(), kBinaryChunk});
  constexpr std::array<std::uint8_t, 4> kPadding{};
  for (const auto& view : views_) {
    put(view);
    put(std::span(kPadding).first(round_up(view.size()) - view.size()));
  }
  return written ? file->finish() : written;
}

}  // namespace topple
