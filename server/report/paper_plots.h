// The paper's figures as plots.
#pragma once

#include <string>
#include <vector>

#include "server/report/svg_plot.h"
#include "sim/experiment/paper/paper.h"

namespace stagger::server {

/// Which of the two horizontal axes.
enum class GroundAxis : unsigned char { x, y };

/// Footprints from above, swing feet from the side, references along x and along y.
std::vector<Plot> plan_plots(const sim::PlanResult& plan);

/// Along x and then y: trajectories, ZMP, errors.
std::vector<Plot> tracking_plots(const sim::TrackingResult& tracking);

/// References and what happened, along one axis; `id` is unique in the page.
Plot trajectory_plot(const sim::Trace& trace, GroundAxis axis, std::string id, std::string title);
/// ZMP between the edges of what it stands on.
Plot zmp_plot(const sim::Trace& trace, GroundAxis axis, std::string id, std::string title);

/// One of the paper's pushes along x, from half a second before it.
Plot push_plot(const sim::PushComparison& push, double width, std::string id);
std::string strategy_text(sim::SteppingStrategy strategy);

/// The 441 states with what became of them.
Plot standing_map(const sim::StandingResult& result, double width, std::string id,
                  std::string title);
Plot standing_example_plot(const sim::StandingExample& example, std::string id, std::string title);

/// First fall beside the ceiling, in groups of three bars.
Plot stepping_bars(const std::vector<sim::SteppingLimits>& limits);
/// First fall all around for one timing, seen from above.
Plot direction_plot(const std::vector<sim::SteppingLimits>& around, double width, std::string id);

}  // namespace stagger::server
