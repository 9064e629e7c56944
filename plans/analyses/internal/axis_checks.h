#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "plans/analyses/analysis.h"

// Checks that plans of rotary axes share, of a fixture and of a head.

namespace rondure::plans {

/// Checks that no station stands twice, and that there are enough beside 0.
/// @param zero  What the pose at 0 is called.
void check_axis_stations(const std::vector<double>& stations_deg, std::string_view zero,
                         const std::string& where, Findings& findings);

/// Checks that no ball before had this name.
void check_ball_id(const std::string& id, std::set<std::string>& seen, const std::string& where,
                   Findings& findings);

}  // namespace rondure::plans
