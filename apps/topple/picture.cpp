/// `topple picture`: an image as the field of a layout.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "output.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

constexpr int kMostBricks = 10'000'000;
constexpr double kLeastLineRowPitch = 76.0;  // [mm]; three widths of a domino, and 4 mm for what turns off the line

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// "#rrggbb" with its leading '#', or the name of a usual colour.
std::optional<Color> color_named(const std::string& text) {
  for (const NamedColor& usual : usual_colors()) {
    if (usual.name == lower(text)) return usual.color;
  }
  unsigned code = 0;
  const auto [stop, problem] = std::from_chars(text.data() + 1, text.data() + text.size(), code, 16);
  if (text.size() != 7 || text[0] != '#' || problem != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return Color{static_cast<std::uint8_t>(code >> 16U), static_cast<std::uint8_t>(code >> 8U), static_cast<std::uint8_t>(code)};
}

/// "red=500", "#f4f1e8".
Result<StockColor> stock_color(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::optional<Color> color = equals == 0 || text.empty() ? std::nullopt : color_named(text.substr(0, equals));
  if (!color) {
    std::string names;
    for (const NamedColor& usual : usual_colors()) names += (names.empty() ? "" : ", ") + std::string(usual.name);
    return failure("--colors: '" + text + "' is no colour; it is written #rrggbb, or is one of " + names + ".");
  }
  if (equals == std::string::npos) return StockColor{*color};
  const std::string number = text.substr(equals + 1);
  StockColor one{*color, 0};
  const auto [stop, problem] = std::from_chars(number.data(), number.data() + number.size(), one.stock);
  if (problem != std::errc() || stop != number.data() + number.size() || one.stock < 0 || one.stock > kMostBricks)
    return failure("--colors: '" + text + "': the stock must be a whole number from 0 to 10,000,000.");
  return one;
}

void print_picture(const Picture& picture, double width, double height) {
  std::printf("%s of %s, %s in all, %.4g m x %.4g m\n", count_of(picture.size.rows, "row").c_str(),
              count_of(picture.size.count, "brick").c_str(), grouped(std::ssize(picture.cells)).c_str(), width, height);
  for (std::size_t i = 0; i < picture.colors.size(); ++i) {
    const StockColor& one = picture.colors[i];
    const std::string of = one.stock == StockColor::kAny ? "" : " of " + grouped(one.stock);
    if (picture.used[i] > 0) std::printf("  %-18s %s%s\n", name_of(one.color).c_str(), grouped(picture.used[i]).c_str(), of.c_str());
  }
}

class PictureVerb final : public Verb {
 public:
  const char* name() const override { return "picture"; }
  const char* purpose() const override { return "Make a layout of an image: a field whose bricks show it from above"; }
  const char* example() const override {
    return "topple picture scenes/picture.png -o picture.toml --rows 18 --gap 16.5 --colors "
           "yellow,orange,red,crimson,violet,blue=400,ivory,black --start line";
  }

  void declare(Options& app) override {
    app.add_option("IMAGE", image_, "An image (PNG or JPEG)").required().type_name("");
    app.add_option("-o,--out", output_, "The layout to write").required().type_name("FILE.toml");
    app.add_option("--bricks", bricks_, "About how many bricks in all (default 2000)").type_name("N").check(whole_number(1, kMostBricks));
    app.add_option("--rows", size_.rows, "How many rows, in place of --bricks; with --count the image is stretched")
        .type_name("N")
        .check(whole_number(1, kMostBricks));
    app.add_option("--count", size_.count, "How many bricks a row, in place of --bricks")
        .type_name("N")
        .check(whole_number(1, kMostBricks));
    app.add_option("--width", width_, "How long the rows are [mm], in place of --count").type_name("MM").check(number(1.0, 1e8));
    app.add_option("--gap", gap_, "Face to face in a row [mm] (default 8.5)").type_name("MM").check(number(0.0, 20000.0));
    app.add_option("--row-gap", row_gap_, "Between the rows [mm] (default 8, with --start line 52)")
        .type_name("MM")
        .check(number(0.0, 20000.0));
    app.add_option("--colors", colors_,
                   "The colours there are, by name or as #rrggbb, and how many bricks of each: red=500,ivory (default: twelve usual ones)")
        .type_name("LIST")
        .delimiter(',');
    app.add_flag("--dither", dither_, "Mix colours over neighbouring bricks where none is near");
    app.add_option("--start", start_,
                   "How the rows start: pushes, a push for each; line, a line of bricks along their heads; none (default pushes)")
        .type_name("NAME")
        .check(one_of({"pushes", "line", "none"}));
  }

  int run() override {
    if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    if (width_ > 0.0 && size_.count > 0) return complain("--width and --count both say how long the rows are; one of them can.", kBadInput);
    PictureConfig config{.colors = {}, .dither = dither_};
    for (const std::string& text : colors_) {
      const Result<StockColor> one = stock_color(text);
      if (!one) return complain(one.error(), kBadInput);
      config.colors.push_back(*one);
    }
    if (colors_.empty()) {
      for (const NamedColor& usual : usual_colors()) config.colors.push_back({usual.color});
    }
    const Result<Image> image = load_image(image_);
    if (!image) return complain(image.error(), kBadInput);
    const BrickKind domino;
    const double pitch = domino.thickness + gap_ / 1000.0, row_pitch = domino.width + row_gap() / 1000.0;
    if (width_ > 0.0) size_.count = std::max<std::int64_t>(1, std::llround(width_ / 1000.0 / pitch));
    config.size = fit_picture(*image, pitch, row_pitch, size_, bricks_);
    const Result<Picture> picture = make_picture(*image, config);
    if (!picture) return complain(picture.error(), kBadInput);
    const std::string text = layout_text(*picture);
    // What cannot start (rows too close for a line) is said in the file's own words, before it is written.
    if (const Result<Layout> layout = read_layout(text, output_.string()); !layout) return complain(layout.error(), kBadInput);
    if (const Result<void> saved = save_bytes(text, output_); !saved) return complain(saved.error(), kFailed);
    print_picture(*picture, static_cast<double>(picture->size.count) * pitch, static_cast<double>(picture->size.rows) * row_pitch);
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  double row_gap() const {
    const double width = BrickKind{}.width * 1000.0;
    return row_gap_ >= 0.0 ? row_gap_ : start_ == "line" ? kLeastLineRowPitch - width : 8.0;
  }

  std::string layout_text(const Picture& picture) const {
    std::string title;
    for (const char c : image_.stem().string()) title += c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ' ? '_' : c;
    std::string text = "title = \"" + title + "\"\n\n";
    if (start_ == "line") text += "[[push]]\nbrick = 0\nangular_speed_rad_s = 10\n\n";
    text += formatted("[[field]]\ngap_mm = %.10g\nrow_pitch_mm = %.10g\nstarter = \"%s\"\n", gap_, 1000.0 * BrickKind{}.width + row_gap(),
                      start_.c_str());
    if (start_ == "pushes") text += "angular_speed_rad_s = 10\n";
    if (start_ == "line") text += "color = \"#5d6d7e\"\n";
    return text + picture_text(picture);
  }

  std::filesystem::path image_, output_;
  std::vector<std::string> colors_;
  PictureSize size_;
  std::int64_t bricks_ = 2000;
  double width_ = 0.0, gap_ = 8.5, row_gap_ = -1.0;  // [mm]
  bool dither_ = false;
  std::string start_ = "pushes";
};

}  // namespace

std::unique_ptr<Verb> picture_verb() { return std::make_unique<PictureVerb>(); }

}  // namespace topple::app
