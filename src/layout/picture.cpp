// A field's picture: a letter a brick, drawn in the layout file as it is seen from above.
#include <string>

#include "layout/style.h"
#include "layout/text.h"

namespace topple {
namespace {

constexpr std::size_t kLetters = 128;

/// Letters that everybody can type and tell apart; a blank is one of them.
bool is_letter(char c) { return c >= ' ' && c <= '~'; }

bool read_palette(Section& section, FieldPicture& picture) {
  picture.palette.resize(kLetters);
  const Node* node = section.find("palette");
  const auto* table = node ? std::get_if<Table>(&node->value) : nullptr;
  if (!table) {
    const std::string what = "a table of a colour for each letter of the picture, { a = \"#rrggbb\" }";
    node ? section.problem("palette", "must be " + what + ", is " + value_text(*node)) : section.missing("palette must be there: " + what);
    return false;
  }
  std::size_t good = 0;
  for (const KeyedNode& member : *table) {
    const auto* text = std::get_if<std::string>(&member.node.value);
    const std::optional<Color> color = text ? color_of(*text) : std::nullopt;
    if (member.key.size() != 1 || !is_letter(member.key[0])) {
      section.problem_in("palette", member, "must be a single letter, digit or sign of ASCII");
    } else if (!color) {
      section.problem_in("palette", member, "must be a colour written \"#rrggbb\" with hexadecimal digits, is " + value_text(member.node));
    } else {
      picture.palette[static_cast<std::size_t>(member.key[0])] = color;
      ++good;
    }
  }
  return good == table->size();
}

std::optional<Color> color_at(const FieldPicture& picture, char letter) {
  return is_letter(letter) ? picture.palette[static_cast<std::size_t>(letter)] : std::nullopt;
}

/// One line: as long as the first one, of the palette's letters.
void check_line(Section& section, const FieldPicture& picture, std::size_t number) {
  const std::string_view line = picture.lines[number];
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (color_at(picture, line[i])) continue;
    std::size_t end = i + 1;  // of a sign that may have several bytes
    while (end < line.size() && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80) ++end;
    section.problem_at("picture", number, "the palette has no \"" + printable(line.substr(i, end - i)) + "\"", i);
    return;
  }
  if (line.size() == picture.lines[0].size()) return;
  section.problem_at(
      "picture", number,
      "must have the " + count_text(std::ssize(picture.lines[0])) + " letters of the first line, has " + count_text(std::ssize(line)));
}

}  // namespace

std::optional<FieldPicture> read_picture(Section& section) {
  if (!section.has("picture")) {
    if (section.has("palette")) section.problem("palette", "goes with a picture alone");
    return std::nullopt;
  }
  FieldPicture picture;
  bool readable = read_palette(section, picture);
  const std::span<const Node> lines = section.list("picture", static_cast<std::size_t>(kMaxBricks), "lines");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto* text = std::get_if<std::string>(&lines[i].value);
    if (text && !text->empty()) {
      picture.lines.push_back(*text);
    } else {
      section.problem_at("picture", i, "must be text, a letter for each brick of a row; is " + value_text(lines[i]));
      readable = false;
    }
  }
  if (lines.empty() && section.good()) section.problem("picture", "must have a line for each row; is a list of 0");
  for (std::size_t i = 0; i < lines.size() && readable; ++i) check_line(section, picture, i);
  if (!section.good() || !readable) return std::nullopt;
  picture.rows = std::ssize(picture.lines);
  picture.count = std::ssize(picture.lines[0]);
  return picture;
}

void paint_row(const FieldPicture& picture, std::int64_t row, std::int64_t first, std::vector<PaintStroke>& paint) {
  const std::string_view line = picture.lines[static_cast<std::size_t>(picture.rows - 1 - row)];
  for (std::size_t from = 0; from < line.size();) {
    const std::size_t to = std::min(line.find_first_not_of(line[from], from), line.size());
    paint.push_back({first + static_cast<std::int64_t>(from), first + static_cast<std::int64_t>(to) - 1, *color_at(picture, line[from])});
    from = to;
  }
}

}  // namespace topple
