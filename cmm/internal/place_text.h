#pragma once

#include <string>

#include <Eigen/Core>

namespace rondure::cmm {

/// "(1.000, -2.500, 30.000) mm", for messages.
[[nodiscard]] std::string in_words(const Eigen::Vector3d& p_mm);

}  // namespace rondure::cmm
