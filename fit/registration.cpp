#include "fit/registration.h"

#include <algorithm>

#include <fmt/format.h>
#include <Eigen/SVD>

namespace rondure::fit {
namespace {

/// One column a point.
Eigen::Matrix3Xd columns(std::span<const Eigen::Vector3d> points_mm) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(points_mm.size()));
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    out.col(static_cast<Eigen::Index>(i)) = points_mm[i];
  }
  return out;
}

bool on_one_line(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d spread = Eigen::JacobiSVD<Eigen::Matrix3Xd>(centred).singularValues();
  return spread(1) <= 1e-6 * spread(0);
}

}  // namespace

core::Result<Registration> rigid_registration(std::span<const Eigen::Vector3d> from_mm,
                                              std::span<const Eigen::Vector3d> to_mm) {
  if (from_mm.size() < 3 || from_mm.size() != to_mm.size()) {
    return core::fail(
        core::Code::kTooFewPoints,
        fmt::format("{} and {} points do not determine a motion; at least 3 pairs are "
                    "needed",
                    from_mm.size(), to_mm.size()));
  }
  const Eigen::Matrix3Xd from = columns(from_mm);
  const Eigen::Matrix3Xd to = columns(to_mm);
  if (!from.allFinite() || !to.allFinite()) {
    return core::fail(core::Code::kNotFinite, "a point to be registered is not a finite number");
  }
  if (on_one_line(from)) {
    return core::fail(core::Code::kCollinear,
                      "the points lie on one line, so the turn about it is not determined");
  }
  Registration out;
  out.motion.matrix() = Eigen::umeyama(from, to, false);
  for (std::size_t i = 0; i < from_mm.size(); ++i) {
    out.largest_residual_mm =
        std::max(out.largest_residual_mm, (out.motion * from_mm[i] - to_mm[i]).norm());
  }
  return out;
}

}  // namespace rondure::fit
