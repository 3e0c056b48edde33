#include <string>

#include "export/figures.h"
#include "topple/export.h"

namespace topple {

Result<void> plot(const Recording& recording, const PlotConfig& config, const std::filesystem::path& path) {
  switch (config.figure) {
    case Figure::motion:
      return plot_motion(recording, config.bricks, path);
    case Figure::arrival:
      return plot_arrival(recording, path);
    case Figure::speed:
      return plot_speed(recording, path);
    case Figure::energy:
      return plot_energy(recording, path);
  }
  return failure("There is no such figure.");
}

}  // namespace topple
