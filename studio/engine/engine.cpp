/// The engine as the page sees it: a few functions over one layout and one run, text and bytes through memory. The worker that calls it
/// is studio/src/engine/worker.ts, its typed side studio/src/engine/engine.ts.
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "desk.h"

namespace topple {
namespace {

void add_counts(std::string& json, const char* name, const std::vector<LayoutSummary::Count>& counts) {
  json += std::string(",\"") + name + "\":[";
  for (std::size_t i = 0; i < counts.size(); ++i) {
    json += i == 0 ? "{\"name\":" : ",{\"name\":";
    add_text(json, counts[i].name);
    json += ",\"bricks\":" + std::to_string(counts[i].bricks) + "}";
  }
  json += "]";
}

void add_doubts(std::string& json, const std::vector<Doubt>& doubts) {
  json += ",\"doubts\":[";
  for (std::size_t i = 0; i < doubts.size(); ++i) {
    const Doubt& doubt = doubts[i];
    json += i == 0 ? "" : ",";
    json += std::string("{\"kind\":\"") + std::string(name_of(doubt.kind)) + "\",\"brick\":" + std::to_string(doubt.brick) +
            ",\"other\":" + std::to_string(doubt.other) + ",\"amount\":";
    add_number(json, doubt.amount);
    json += ",\"words\":";
    add_text(json, doubt.words);
    json += "}";
  }
  json += "]";
}

std::string describe(const Layout& layout) {
  const LayoutSummary summary = summarize(layout);
  std::string json = "{\"bricks\":" + std::to_string(summary.bricks) + ",\"length\":";
  add_number(json, summary.length);
  add_counts(json, "kinds", summary.kinds);
  add_counts(json, "colors", summary.colors);
  add_doubts(json, find_doubts(layout));
  return json + "}";
}

/// Everything written since the last call: whole pieces of docs/format.md.
void collect(bool over) {
  Desk& all = desk();
  all.bytes.clear();
  if (over) {
    all.bytes = all.writer->end();
    return;
  }
  for (std::vector<std::uint8_t> more = all.writer->more(); !more.empty(); more = all.writer->more()) {
    all.bytes.insert(all.bytes.end(), more.begin(), more.end());
  }
}

/// A step's contacts: time [s], as f64, how many, as u32, four bytes of nothing; then of each a, b as u32, the point from a's foot [m] and
/// the force on a [N], each three f32.
void add_contacts(std::vector<std::uint8_t>& bytes, const Model& model, const Layout& layout) {
  const std::span<const Contact> contacts = model.contacts();
  add_bytes(bytes, static_cast<double>(model.step_count()) * model.time_step());
  add_bytes(bytes, static_cast<std::uint32_t>(contacts.size()));
  add_bytes(bytes, std::uint32_t{0});
  for (const Contact& contact : contacts) {
    const Vec3 point = contact.point - layout.bricks[static_cast<std::size_t>(contact.a)].foot;
    add_bytes(bytes, static_cast<std::uint32_t>(contact.a));
    add_bytes(bytes, static_cast<std::uint32_t>(contact.b));
    for (const Vec3& v : {point, contact.force}) {
      for (const double number : {v.x, v.y, v.z}) add_bytes(bytes, static_cast<float>(number));
    }
  }
}

/// What the page asks of a picture: pitch and row pitch [m], bricks, whether it is dithered (0 or 1); then of each colour its code 0xrrggbb
/// and its stock, below 0 without limit. No colours: the usual ones.
Result<Picture> picture_as_asked(const Image& image, std::span<const double> asked) {
  PictureConfig config;
  config.size = fit_picture(image, asked[0], asked[1], {}, static_cast<std::int64_t>(asked[2]));
  config.dither = asked[3] != 0.0;
  for (std::size_t i = 4; i + 1 < asked.size(); i += 2) {
    const auto code = static_cast<std::uint32_t>(asked[i]);
    const auto part = [code](unsigned shift) { return static_cast<std::uint8_t>(code >> shift); };
    config.colors.push_back(
        {{part(16), part(8), part(0)}, asked[i + 1] < 0.0 ? StockColor::kAny : static_cast<std::int64_t>(asked[i + 1])});
  }
  if (config.colors.empty()) {
    for (const NamedColor& usual : usual_colors()) config.colors.push_back({usual.color});
  }
  return make_picture(image, config);
}

std::string describe(const Picture& picture) {
  std::string json = "{\"rows\":" + std::to_string(picture.size.rows) + ",\"count\":" + std::to_string(picture.size.count) + ",\"used\":[";
  for (std::size_t i = 0; i < picture.used.size(); ++i) json += (i == 0 ? "" : ",") + std::to_string(picture.used[i]);
  json += "],\"text\":";
  add_text(json, picture_text(picture));
  return json + "}";
}

}  // namespace
}  // namespace topple

using topple::desk;

extern "C" {

/// Room for `size` bytes that the page fills: text that it hands over. It is given back with topple_release.
TOPPLE_EXPORT(topple_reserve) void* topple_reserve(std::size_t size) { return ::operator new(size); }
TOPPLE_EXPORT(topple_release) void topple_release(void* room) { ::operator delete(room); }

TOPPLE_EXPORT(topple_bytes) const std::uint8_t* topple_bytes() { return desk().bytes.data(); }
TOPPLE_EXPORT(topple_byte_count) std::size_t topple_byte_count() { return desk().bytes.size(); }
TOPPLE_EXPORT(topple_answer) const char* topple_answer() { return desk().answer.data(); }
TOPPLE_EXPORT(topple_answer_size) std::size_t topple_answer_size() { return desk().answer.size(); }

/// Reads a layout that may still have overlaps. Overrides are `key=value`, a line each. True: the answer is JSON (counts, length, doubts)
/// and the bytes are its scene and bricks as the beginning of a recording. False: the answer is every problem, a line each.
TOPPLE_EXPORT(topple_read)
bool topple_read(const char* text, std::size_t size, const char* name, std::size_t name_size, const char* overrides,
                 std::size_t overrides_size) {
  topple::Desk& all = desk();
  const std::vector<std::string> settings = topple::lines_of({overrides, overrides_size});
  topple::Result<topple::Layout> layout = topple::read_draft({text, size}, {name, name_size}, settings);
  if (!layout) return topple::fail(layout.error());
  all.layout = std::move(*layout);
  all.answer = topple::describe(*all.layout);
  topple::Recording scene(*all.layout, {.version = TOPPLE_VERSION, .model = "", .time_step = 0.0});
  all.bytes = topple::RecordingWriter(scene).begin();
  return true;
}

/// Begins a run of a layout, overlaps refused. False: the answer says why not. True: the bytes begin its recording.
TOPPLE_EXPORT(topple_start)
bool topple_start(const char* text, std::size_t size, const char* name, std::size_t name_size, const char* overrides,
                  std::size_t overrides_size) {
  topple::Desk& all = desk();
  all.writer.reset();
  all.simulation.reset();
  const std::vector<std::string> settings = topple::lines_of({overrides, overrides_size});
  topple::Result<topple::Layout> layout = topple::read_layout({text, size}, {name, name_size}, settings);
  if (!layout) return topple::fail(layout.error());
  const topple::Result<topple::ModelConfig> config = topple::model_config(*layout);
  if (!config) return topple::fail(config.error());
  topple::Result<topple::Simulation> simulation = topple::Simulation::start(std::move(*layout), *config);
  if (!simulation) return topple::fail(simulation.error());
  all.simulation = std::move(*simulation);
  all.writer.emplace(all.simulation->recording());
  all.bytes = all.writer->begin();
  return true;
}

/// Runs on by so many steps; false when the run is over.
TOPPLE_EXPORT(topple_advance) bool topple_advance(int steps) { return desk().simulation->advance(steps); }
TOPPLE_EXPORT(topple_stop) void topple_stop() { desk().simulation->stop(); }

/// The bytes become what was recorded since the last call; with `over` the rest and the end.
TOPPLE_EXPORT(topple_collect) void topple_collect(bool over) { topple::collect(over); }

/// Begins to watch the forces of a layout's run, beside any other. False: the answer says why not.
TOPPLE_EXPORT(topple_watch)
bool topple_watch(const char* text, std::size_t size, const char* name, std::size_t name_size, const char* overrides,
                  std::size_t overrides_size) {
  topple::Desk& all = desk();
  all.watched.reset();
  const std::vector<std::string> settings = topple::lines_of({overrides, overrides_size});
  topple::Result<topple::Layout> layout = topple::read_layout({text, size}, {name, name_size}, settings);
  if (!layout) return topple::fail(layout.error());
  all.watched_layout = std::move(*layout);
  topple::Result<topple::ModelConfig> config = topple::model_config(*all.watched_layout);
  if (!config) return topple::fail(config.error());
  // What is not computed again has no forces; the bits are the same.
  if (auto* rigid = std::get_if<topple::RigidConfig>(&*config)) rigid->repeats = false;
  if (auto* hinge = std::get_if<topple::HingeConfig>(&*config)) hinge->repeats = false;
  auto model = topple::make_model(*all.watched_layout, *config);
  if (!model) return topple::fail(model.error());
  all.watched = std::move(*model);
  return true;
}

/// So many steps of it, or fewer at its end; the bytes are their contacts. False when it is over.
TOPPLE_EXPORT(topple_watch_steps) bool topple_watch_steps(int steps) {
  topple::Desk& all = desk();
  all.bytes.clear();
  bool goes_on = true;
  for (int i = 0; i < steps && goes_on; ++i) {
    goes_on = all.watched->step().progress == topple::Progress::running;
    topple::add_contacts(all.bytes, *all.watched, *all.watched_layout);
  }
  return goes_on;
}

/// Makes a picture of an image, 4 * width * height bytes, in an order of so many numbers (picture_as_asked). True: the answer is JSON
/// (rows, count, how many of each colour, its text for a layout file) and the bytes are its cells. False: the answer says why not.
TOPPLE_EXPORT(topple_picture)
bool topple_picture(const std::uint8_t* pixels, int width, int height, const double* asked, std::size_t numbers) {
  topple::Desk& all = desk();
  const topple::Image image{
      width, height, {pixels, pixels + std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)}};
  topple::Result<topple::Picture> picture = topple::picture_as_asked(image, {asked, numbers});
  if (!picture) return topple::fail(picture.error());
  all.answer = topple::describe(*picture);
  all.bytes = std::move(picture->cells);
  return true;
}

TOPPLE_EXPORT(topple_time) double topple_time() { return desk().simulation->progress().time; }
TOPPLE_EXPORT(topple_arrived) double topple_arrived() { return static_cast<double>(desk().simulation->progress().arrived); }
TOPPLE_EXPORT(topple_steps) double topple_steps() { return static_cast<double>(desk().simulation->progress().step); }

/// After the end: the answer is the hash, 16 hexadecimal digits.
TOPPLE_EXPORT(topple_hash) void topple_hash() { desk().answer = topple::hash_digits(desk().simulation->recording().end().hash); }
}
