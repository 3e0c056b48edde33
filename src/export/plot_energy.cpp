#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "export/figures.h"
#include "export/gnuplot.h"

namespace topple {
namespace {

struct EnergyUnit {
  double scale = 1.0;
  const char* name = "J";
};

EnergyUnit unit_for(double largest) {
  if (largest >= 1.0) {
    return {};
  }
  return largest >= 1e-3 ? EnergyUnit{1e3, "mJ"} : EnergyUnit{1e6, "µJ"};
}

}  // namespace

Result<void> plot_energy(const Recording& recording, const std::filesystem::path& path) {
  const std::span<const EnergySample> samples = recording.energy();
  if (samples.size() < 2) {
    return failure("The recording holds fewer than two samples of the energy, so there is nothing to draw.");
  }
  double largest = 0.0;
  for (const EnergySample& sample : samples) {
    largest = std::max({largest, std::abs(sample.energy.kinetic), std::abs(sample.energy.potential), std::abs(sample.energy.push_work)});
  }
  const EnergyUnit unit = unit_for(largest);
  std::array<std::vector<Point>, 4> curves;
  for (const EnergySample& sample : samples) {
    const Energy& energy = sample.energy;
    const std::array<double, 4> values = {energy.kinetic, energy.potential, energy.push_work, energy.kinetic + energy.potential};
    for (std::size_t i = 0; i < curves.size(); ++i) {
      curves[i].push_back({sample.time, values[i] * unit.scale});
    }
  }
  Result<GnuplotScript> script = GnuplotScript::begin(path, 560, 380);
  if (!script) {
    return std::unexpected(script.error());
  }
  constexpr std::array<const char*, 4> kNames = {"kinetic", "potential", "work of the pushes", "kinetic + potential"};
  std::string command = "plot ";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    script->data("$energy" + std::to_string(i), curves[i]);
    command += (i == 0 ? "$energy" : ", $energy") + std::to_string(i) + " with lines " + curve_style(i) + " title '" + kNames[i] + "'";
  }
  script->line(std::string("set xlabel 'Time [s]'\nset ylabel 'Energy [") + unit.name + "]'");
  script->line("set xrange [0:*]\nset key outside top center horizontal\nset xzeroaxis lc rgb '#888888' lw 0.8 lt 1");
  script->line(command);
  return draw(*script, path);
}

}  // namespace topple
