#include "module.h"

namespace topple::python {
namespace {

py::array_t<double> feet(const Layout& layout) {
  py::array_t<double> array({layout.brick_count(), 3});
  auto at = array.mutable_unchecked<2>();
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const Vec3& foot = layout.bricks[static_cast<std::size_t>(brick)].foot;
    at(brick, 0) = foot.x;
    at(brick, 1) = foot.y;
    at(brick, 2) = foot.z;
  }
  return array;
}

template <typename T, typename Get>
py::array_t<T> of_each(const Layout& layout, Get get) {
  std::vector<T> values;
  values.reserve(layout.bricks.size());
  for (const Brick& brick : layout.bricks) values.push_back(get(brick));
  return array_of(values);
}

py::array_t<std::uint8_t> colors(const Layout& layout) {
  py::array_t<std::uint8_t> array({layout.brick_count(), 3});
  auto at = array.mutable_unchecked<2>();
  for (BrickId brick = 0; brick < layout.brick_count(); ++brick) {
    const Color& color = layout.colors[layout.bricks[static_cast<std::size_t>(brick)].color];
    at(brick, 0) = color.red;
    at(brick, 1) = color.green;
    at(brick, 2) = color.blue;
  }
  return array;
}

py::dict summary(const Layout& layout) {
  const LayoutSummary summary = summarize(layout);
  const auto counts = [](const std::vector<LayoutSummary::Count>& all) {
    py::dict counted;
    for (const LayoutSummary::Count& one : all) counted[py::str(one.name)] = one.bricks;
    return counted;
  };
  py::dict all;
  all["bricks"] = summary.bricks;
  all["length"] = summary.length;
  all["low"] = tuple_of(summary.low);
  all["high"] = tuple_of(summary.high);
  all["kinds"] = counts(summary.kinds);
  all["colors"] = counts(summary.colors);
  return all;
}

py::list doubts(const Layout& layout) {
  py::list all;
  for (const Doubt& doubt : find_doubts(layout)) {
    py::dict one;
    one["kind"] = name_of(doubt.kind);
    one["brick"] = doubt.brick;
    one["other"] = doubt.other == kNoBrick ? py::object(py::none()) : py::object(py::int_(doubt.other));
    one["amount"] = doubt.amount;
    one["words"] = doubt.words;
    all.append(one);
  }
  return all;
}

Layout with_settings(const Layout& layout, const std::vector<std::string>& settings) {
  std::vector<std::string> overrides = layout.overrides;
  overrides.insert(overrides.end(), settings.begin(), settings.end());
  return value_of(read_layout(layout.text, layout.name, overrides));
}

}  // namespace

void define_layout(py::module_& module) {
  py::class_<BrickKind>(module, "Kind", "What many bricks share: sizes [m], mass [kg].")
      .def_readonly("name", &BrickKind::name)
      .def_readonly("height", &BrickKind::height)
      .def_readonly("width", &BrickKind::width)
      .def_readonly("thickness", &BrickKind::thickness, "In the direction it falls [m].")
      .def_readonly("mass", &BrickKind::mass)
      .def_property_readonly("is_ball", [](const BrickKind& kind) { return kind.shape == Shape::ball; })
      .def("__repr__", [](const BrickKind& kind) { return "<topple.Kind " + kind.name + ">"; });

  py::class_<Part>(module, "Part", "Consecutive bricks that one entry of the layout made.")
      .def_readonly("name", &Part::name)
      .def_readonly("first", &Part::first)
      .def_readonly("count", &Part::count)
      .def_readonly("line", &Part::line, "Whether they are in the order in which they should fall.")
      .def("__repr__", [](const Part& part) { return "<topple.Part " + part.name + ", " + std::to_string(part.count) + " bricks>"; });

  py::class_<Layout>(module, "Layout", "Every brick at its true size and place. It never changes; len() is the number of bricks.")
      .def_readonly("title", &Layout::title)
      .def_readonly("name", &Layout::name, "Of its file, or another name for messages.")
      .def_readonly("text", &Layout::text, "The TOML source.")
      .def_readonly("settings", &Layout::overrides, "'key=value' over what the text says.")
      .def_readonly("gravity", &Layout::gravity, "[m/s^2], downwards.")
      .def_readonly("kinds", &Layout::kinds)
      .def_readonly("parts", &Layout::parts)
      .def("__len__", &Layout::brick_count)
      .def_property_readonly("feet", &feet, "Centre of the face that each brick stands on, (n, 3) [m].")
      .def_property_readonly(
          "headings", [](const Layout& layout) { return of_each<double>(layout, [](const Brick& brick) { return brick.heading; }); },
          "The way each brick falls, from +x, counter-clockwise seen from above, (n,) [rad].")
      .def_property_readonly(
          "kind_of", [](const Layout& layout) { return of_each<std::uint16_t>(layout, [](const Brick& brick) { return brick.kind; }); },
          "Index into kinds, (n,).")
      .def_property_readonly("colors", &colors, "Red, green and blue of each brick, (n, 3), 0 to 255.")
      .def("summary", &summary, "Bricks, length along all lines [m], bounding box [m], bricks by kind and by colour.")
      .def("doubts", &doubts, "Where geometry says that the run may stop, the most serious first.")
      .def("with_settings", &with_settings, py::arg("settings"), "The same layout, 'key=value' of each setting over what it says.")
      .def("__repr__",
           [](const Layout& layout) { return "<topple.Layout " + layout.name + ", " + std::to_string(layout.brick_count()) + " bricks>"; });

  module.def(
      "read_layout",
      [](const std::string& text, const std::string& name, const std::vector<std::string>& settings) {
        return value_of(read_layout(text, name, settings));
      },
      py::arg("text"), py::arg("name") = "layout.toml", py::arg("settings") = std::vector<std::string>(),
      "Reads a layout (docs/layout.md). Each setting is 'key=value', as --set of the program takes it. Error names every problem.");
  module.def(
      "load_layout",
      [](const std::filesystem::path& path, const std::vector<std::string>& settings) { return value_of(load_layout(path, settings)); },
      py::arg("path"), py::arg("settings") = std::vector<std::string>(), "The same from a file.");
}

}  // namespace topple::python
