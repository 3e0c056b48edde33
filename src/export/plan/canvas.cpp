#include "export/plan/canvas.h"

#include <cairo/cairo-pdf.h>
#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>

#include <array>

namespace topple::plan {
namespace {

constexpr double kPoint = 72.0 / 25.4;  // [1/mm]

cairo_status_t append(void* bytes, const unsigned char* more, unsigned int count) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(more), count);
  return CAIRO_STATUS_SUCCESS;
}

/// cairo counts the surfaces of a process in the names of an SVG's groups; the same drawing has the same bytes.
void number_no_surfaces(std::string& svg) {
  constexpr std::string_view kName = "\"surface";
  for (std::size_t at = svg.find(kName); at != std::string::npos; at = svg.find(kName, at + kName.size())) {
    const std::size_t digits = at + kName.size();
    std::size_t end = digits;
    while (end < svg.size() && svg[end] >= '0' && svg[end] <= '9') ++end;
    svg.erase(digits, end - digits);
  }
}

}  // namespace

struct Canvas::State {
  Format format = Format::pdf;
  std::string bytes;
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;

  void ink(const Color& color) const { cairo_set_source_rgb(cairo, color.red / 255.0, color.green / 255.0, color.blue / 255.0); }
  void font(double size, bool bold) const {
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, size);
  }
};

Canvas::Canvas(Format format, Size page, const std::string& title) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.format = format;
  const double width = page.width * kPoint, height = page.height * kPoint;
  if (format == Format::pdf) {
    state.surface = cairo_pdf_surface_create_for_stream(append, &state.bytes, width, height);
    cairo_pdf_surface_restrict_to_version(state.surface, CAIRO_PDF_VERSION_1_5);
    cairo_pdf_surface_set_metadata(state.surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
    // No time of making: the same layout gives the same bytes.
    cairo_pdf_surface_set_metadata(state.surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
  } else {
    state.surface = cairo_svg_surface_create_for_stream(append, &state.bytes, width, height);
    cairo_svg_surface_set_document_unit(state.surface, CAIRO_SVG_UNIT_PT);
  }
  state.cairo = cairo_create(state.surface);
  if (format == Format::svg) {
    // Paper is white; a page that shows the drawing may be dark.
    cairo_set_source_rgb(state.cairo, 1.0, 1.0, 1.0);
    cairo_paint(state.cairo);
  }
  cairo_scale(state.cairo, kPoint, kPoint);
  cairo_set_line_cap(state.cairo, CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(state.cairo, CAIRO_LINE_JOIN_MITER);
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(state.cairo, options);
  cairo_font_options_destroy(options);
}

Canvas::~Canvas() {
  cairo_destroy(state_->cairo);
  cairo_surface_destroy(state_->surface);
}

void Canvas::page(Size size) {
  cairo_show_page(state_->cairo);
  if (state_->format == Format::pdf) cairo_pdf_surface_set_size(state_->surface, size.width * kPoint, size.height * kPoint);
}

Result<std::string> Canvas::finish() {
  cairo_show_page(state_->cairo);
  const cairo_status_t drawn = cairo_status(state_->cairo);
  cairo_surface_finish(state_->surface);
  const cairo_status_t written = cairo_surface_status(state_->surface);
  const cairo_status_t problem = drawn != CAIRO_STATUS_SUCCESS ? drawn : written;
  if (problem != CAIRO_STATUS_SUCCESS) return failure(std::string("The plan cannot be drawn: ") + cairo_status_to_string(problem));
  if (state_->format == Format::svg) number_no_surfaces(state_->bytes);
  return std::move(state_->bytes);
}

void Canvas::clip(const Rect& rect) {
  cairo_save(state_->cairo);
  cairo_new_path(state_->cairo);
  cairo_rectangle(state_->cairo, rect.x, rect.y, rect.width, rect.height);
  cairo_clip(state_->cairo);
}

void Canvas::unclip() { cairo_restore(state_->cairo); }

void Canvas::move(const Point& to) { cairo_move_to(state_->cairo, to.x, to.y); }
void Canvas::line(const Point& to) { cairo_line_to(state_->cairo, to.x, to.y); }
void Canvas::close() { cairo_close_path(state_->cairo); }

void Canvas::quad(const Point& a, const Point& b, const Point& c, const Point& d) {
  move(a);
  line(b);
  line(c);
  line(d);
  close();
}

void Canvas::circle(const Point& middle, double radius) {
  constexpr double kTurn = 6.283185307179586;
  cairo_new_sub_path(state_->cairo);
  cairo_arc(state_->cairo, middle.x, middle.y, radius, 0.0, kTurn);
  cairo_close_path(state_->cairo);
}

void Canvas::rect(const Rect& rect) { cairo_rectangle(state_->cairo, rect.x, rect.y, rect.width, rect.height); }

void Canvas::fill(const Color& ink) {
  state_->ink(ink);
  cairo_fill(state_->cairo);
}

void Canvas::fill_and_stroke(const Color& ink, const Color& edge, double width) {
  state_->ink(ink);
  cairo_fill_preserve(state_->cairo);
  stroke(edge, width);
}

void Canvas::stroke(const Color& ink, double width, std::span<const double> dashes) {
  state_->ink(ink);
  cairo_set_line_width(state_->cairo, width);
  cairo_set_dash(state_->cairo, dashes.data(), static_cast<int>(dashes.size()), 0.0);
  cairo_stroke(state_->cairo);
}

void Canvas::segment(const Point& from, const Point& to, const Color& ink, double width) {
  move(from);
  line(to);
  stroke(ink, width);
}

void Canvas::arrow_head(const Point& tip, const Point& from, double size, const Color& ink) {
  const Point way = tip - from;
  const double far = length(way);
  if (!(far > 0.0)) return;
  const Point along = (size / far) * way, across{-0.32 * along.y, 0.32 * along.x};
  move(tip);
  line(tip - along + across);
  line(tip - along - across);
  close();
  fill(ink);
}

double Canvas::width_of(const std::string& text, double size, bool bold) {
  state_->font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(state_->cairo, text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const Point& at, const std::string& text, const Letters& letters) {
  const double width = letters.align == Align::left ? 0.0 : width_of(text, letters.size, letters.bold);
  cairo_save(state_->cairo);
  cairo_translate(state_->cairo, at.x, at.y);
  cairo_rotate(state_->cairo, -letters.turn);
  state_->font(letters.size, letters.bold);
  state_->ink(letters.ink);
  cairo_move_to(state_->cairo, letters.align == Align::left ? 0.0 : letters.align == Align::middle ? -width / 2.0 : -width, 0.0);
  cairo_show_text(state_->cairo, text.c_str());
  cairo_new_path(state_->cairo);
  cairo_restore(state_->cairo);
}

std::string Canvas::fitted(const std::string& text, double width, double size, bool bold) {
  if (width_of(text, size, bold) <= width) return text;
  std::string cut = text;
  while (!cut.empty()) {
    // A letter, not a byte of one.
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U) cut.pop_back();
    if (!cut.empty()) cut.pop_back();
    if (width_of(cut + "\u2026", size, bold) <= width) break;
  }
  return cut + "\u2026";
}

}  // namespace topple::plan
