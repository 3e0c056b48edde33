#include <algorithm>

#include "module.h"

namespace topple::python {
namespace {

BrickId brick_in(const Recording& recording, BrickId brick) {
  if (brick < 0 || brick >= recording.layout().brick_count()) throw py::index_error("there is no brick " + std::to_string(brick));
  return brick;
}

std::string hash_of(const Recording& recording) { return hash_digits(recording.end().hash); }

py::dict state(const Recording& recording, BrickId brick, double time) {
  const BrickState at = recording.at(brick_in(recording, brick), time);
  py::dict all;
  all["phase"] = name_of(at.phase);
  all["position"] = tuple_of(at.pose.position);
  all["orientation"] = tuple_of(at.pose.orientation);
  all["velocity"] = tuple_of(at.velocity);
  all["angular_velocity"] = tuple_of(at.angular_velocity);
  all["tilt"] = at.hinge.angle;
  all["tilt_rate"] = at.hinge.rate;
  all["tilt_acceleration"] = at.hinge.acceleration;
  return all;
}

py::tuple poses(const Recording& recording, double time) {
  const BrickId count = recording.layout().brick_count();
  py::array_t<double> positions({count, 3}), orientations({count, 4});
  auto place = positions.mutable_unchecked<2>();
  auto turn = orientations.mutable_unchecked<2>();
  for (BrickId brick = 0; brick < count; ++brick) {
    const Pose pose = recording.at(brick, time).pose;
    place(brick, 0) = pose.position.x;
    place(brick, 1) = pose.position.y;
    place(brick, 2) = pose.position.z;
    turn(brick, 0) = pose.orientation.w;
    turn(brick, 1) = pose.orientation.x;
    turn(brick, 2) = pose.orientation.y;
    turn(brick, 3) = pose.orientation.z;
  }
  return py::make_tuple(positions, orientations);
}

py::array_t<double> motion(const Recording& recording, BrickId brick,
                           const py::array_t<double, py::array::c_style | py::array::forcecast>& times) {
  brick_in(recording, brick);
  const auto at = times.unchecked<1>();
  py::array_t<double> array({times.shape(0), py::ssize_t{3}});
  auto out = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < times.shape(0); ++i) {
    const HingedState hinge = recording.at(brick, at(i)).hinge;
    out(i, 0) = hinge.angle;
    out(i, 1) = hinge.rate;
    out(i, 2) = hinge.acceleration;
  }
  return array;
}

py::dict events(const Recording& recording) {
  const auto count = static_cast<std::size_t>(recording.event_count());
  std::vector<double> time(count), force(count), impulse(count);
  std::vector<BrickId> brick(count), by(count);
  py::array_t<double> points({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  auto point = points.mutable_unchecked<2>();
  py::list kinds;
  for (std::size_t i = 0; i < count; ++i) {
    const Event event = recording.event(static_cast<std::int64_t>(i));
    time[i] = event.time;
    brick[i] = event.brick;
    by[i] = event.by;
    force[i] = event.force;
    impulse[i] = event.impulse;
    const auto row = static_cast<py::ssize_t>(i);
    point(row, 0) = event.point.x;
    point(row, 1) = event.point.y;
    point(row, 2) = event.point.z;
    kinds.append(name_of(event.kind));
  }
  py::dict all;
  all["time"] = array_of(time);
  all["kind"] = py::module_::import("numpy").attr("array")(kinds, "<U8");
  all["brick"] = array_of(brick);
  all["by"] = array_of(by);
  all["force"] = array_of(force);
  all["impulse"] = array_of(impulse);
  all["point"] = points;
  return all;
}

py::dict energy(const Recording& recording) {
  std::vector<double> time, kinetic, potential, push_work;
  for (const EnergySample& sample : recording.energy()) {
    time.push_back(sample.time);
    kinetic.push_back(sample.energy.kinetic);
    potential.push_back(sample.energy.potential);
    push_work.push_back(sample.energy.push_work);
  }
  py::dict all;
  all["time"] = array_of(time);
  all["kinetic"] = array_of(kinetic);
  all["potential"] = array_of(potential);
  all["push_work"] = array_of(push_work);
  return all;
}

py::dict summary(const Recording& recording) {
  const RunSummary summary = summarize(recording);
  py::dict all;
  all["bricks"] = summary.bricks;
  all["fallen"] = summary.fallen;
  all["standing"] = summary.standing;
  all["front_speed"] = summary.front_speed;
  all["duration"] = summary.duration;
  all["end"] = name_of(recording.end().reason);
  all["end_words"] = recording.end().words;
  all["hash"] = hash_of(recording);
  return all;
}

py::dict wave(const Recording& recording) {
  const Wave wave = measure_wave(recording);
  py::dict all;
  all["bricks"] = array_of(wave.bricks);
  all["distance"] = array_of(wave.distance);
  all["arrival"] = array_of(wave.arrival);
  all["front_speed"] = wave.front_speed;
  return all;
}

py::array_t<bool> fallen(const Recording& recording) {
  const std::vector<std::uint8_t> fell = fallen_bricks(recording);
  py::array_t<bool> array(static_cast<py::ssize_t>(fell.size()));
  auto at = array.mutable_unchecked<1>();
  for (std::size_t i = 0; i < fell.size(); ++i) at(static_cast<py::ssize_t>(i)) = fell[i] != 0;
  return array;
}

void export_to(const Recording& recording, const std::filesystem::path& path, bool events, double fps) {
  const std::string ending = path.extension().string();
  if (ending == ".topple") return value_of(save_recording(recording, path));
  if (ending == ".csv") return value_of(events ? export_events_csv(recording, path) : export_knots_csv(recording, path));
  if (ending == ".h5") return value_of(export_hdf5(recording, path));
  if (ending == ".glb") return value_of(export_gltf(recording, {.frames = fps}, path));
  throw Refusal(path.string() + ": the name must end in .topple, .csv, .h5 or .glb");
}

void plot_to(const Recording& recording, const std::filesystem::path& path, const std::string& figure, const std::vector<BrickId>& bricks) {
  const std::vector<std::string> names = {"motion", "arrival", "speed", "energy"};  // In the order of Figure.
  const auto at = std::find(names.begin(), names.end(), figure);
  if (at == names.end()) throw Refusal("'" + figure + "' is not motion, arrival, speed or energy");
  for (const BrickId brick : bricks) brick_in(recording, brick);
  value_of(plot(recording, {.figure = static_cast<Figure>(at - names.begin()), .bricks = bricks}, path));
}

}  // namespace

void define_recording(py::module_& module) {
  py::class_<Recording>(module, "Recording", "All that happened in a run.")
      .def_property_readonly("layout", &Recording::layout, py::return_value_policy::reference_internal)
      .def_property_readonly("model", [](const Recording& recording) { return recording.recipe().model; })
      .def_property_readonly(
          "time_step", [](const Recording& recording) { return recording.recipe().time_step; }, "Of the model [s].")
      .def_property_readonly("duration", &Recording::duration, "Time of the last thing recorded [s].")
      .def_property_readonly("hash", &hash_of, "16 hexadecimal digits: the same recipe gives the same on every machine.")
      .def("at", &state, py::arg("brick"), py::arg("time"),
           "A brick at a time [s]: phase, position of its centre of mass [m], orientation (w, x, y, z), velocity [m/s], angular velocity "
           "[rad/s], tilt [rad] and its two rates.")
      .def("poses", &poses, py::arg("time"), "All bricks at a time [s]: positions (n, 3) [m] and orientations (n, 4), w x y z.")
      .def("motion", &motion, py::arg("brick"), py::arg("times"),
           "Tilt, its rate and its acceleration at many times, (m, 3) [rad, rad/s, rad/s^2].")
      .def("events", &events,
           "What happened, in the order of time, as arrays: time [s], kind, brick, by (-1: nothing), force [N], impulse [N s], point (m, "
           "3) [m].")
      .def("energy", &energy, "time [s], kinetic, potential (against all bricks as put down) and push_work [J], as arrays.")
      .def("wave", &wave,
           "The trunk of the wave: bricks, distance along it [m], arrival at 10 degrees of tilt [s], front_speed from 20 to 80 % [m/s].")
      .def("summary", &summary, "Bricks, fallen, standing, front_speed [m/s], duration [s], how and why it ended, hash.")
      .def("fallen", &fallen, "Whether each brick rests past its tip angle, (n,).")
      .def(
          "first_strikers", [](const Recording& recording) { return array_of(first_strikers(recording)); },
          "Who struck each brick first, -1: nobody, (n,).")
      .def("export", &export_to, py::arg("path"), py::arg("events") = false, py::arg("fps") = 0.0,
           "Writes a file; its ending says as what: .topple, .csv (knots, or with `events` those), .h5, .glb (docs/gltf.md; fps > 0: "
           "straight keyframes).")
      .def("plot", &plot_to, py::arg("path"), py::arg("figure") = "motion", py::arg("bricks") = std::vector<BrickId>(),
           "Draws motion, arrival, speed or energy with gnuplot, as .svg, .png or .pdf.")
      .def("__repr__", [](const Recording& recording) {
        return "<topple.Recording of " + recording.layout().name + " by " + recording.recipe().model + ", " +
               std::to_string(recording.duration()) + " s>";
      });
  module.def(
      "load_recording", [](const std::filesystem::path& path) { return value_of(load_recording(path)); }, py::arg("path"),
      "Reads a .topple file.");
}

}  // namespace topple::python
