// Push limits over the direction of the push, seen from above.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/campaign/limits.h"
#include "server/report/svg_plot.h"

namespace stagger::server {

/// One direction; all in Fr = delta_v / sqrt(g h).
struct PolarLimit {
  double direction_deg = 0.0;
  std::optional<double> pass;  ///< 0 when the lowest level fails; nothing: not known
  std::optional<double> fail;
  std::optional<double> ceiling;
  bool monotone = true;
};

struct PolarSeries {
  std::string name;
  std::vector<PolarLimit> limits;  ///< by direction
};

/// The limits at one moment of the gait.
struct PolarPanel {
  std::string title;
  std::optional<engine::Side> stance;  ///< foot that stands, when there is one
  std::vector<PolarSeries> series;
};

/// A panel for each trigger. None when the campaign is no bisection of a push over directions.
std::vector<PolarPanel> polar_panels(const campaign::Plan& plan,
                                     const std::vector<campaign::CellLimit>& limits);

/// Greatest Fr that is drawn, so that all panels may have one scale.
double polar_reach(const std::vector<PolarPanel>& panels);

Plot polar_plot(const PolarPanel& panel, double reach, double width, std::string id);

}  // namespace stagger::server
