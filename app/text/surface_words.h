#pragma once

#include <string>

#include "core/result.h"
#include "fit/wheel/surface.h"

namespace rondure::app {

/// Parses a surface from one word of the command line:
///   polynomial:a0,a1,a2,...          z = a0 + a1 x + a2 x^2 + ... [mm^(1-j)]
///   asphere:R=120,K=-1,A4=2e-8,...   vertex radius [mm] (or c=1/mm), conic, even terms A2 to A20
///   table:FILE.csv                   columns x,z (mm)
/// @return kBadOption with the word; the errors of the file and of WheelSurface.
[[nodiscard]] core::Result<fit::WheelSurface> read_surface(const std::string& word);

/// The surface minus the removal in a file with the columns x,depth_um (mm, um).
[[nodiscard]] core::Result<fit::WheelSurface> take_removal(const fit::WheelSurface& surface,
                                                           const std::string& file);

}  // namespace rondure::app
