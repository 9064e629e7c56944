#include "cmm/internal/place_text.h"

#include <fmt/format.h>

namespace rondure::cmm {

std::string in_words(const Eigen::Vector3d& p_mm) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", p_mm.x(), p_mm.y(), p_mm.z());
}

}  // namespace rondure::cmm
