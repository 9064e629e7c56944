#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

/// Simulated inspections whose truth is known, made without any code of the program that is judged.
/// Deviations in um.
namespace rondure::coverage {

/// Random numbers of one name and trial.
class Random {
 public:
  Random(const std::string& name, int trial);
  double uniform(double low, double high);
  double normal();
  Eigen::Index below(Eigen::Index count);  ///< 0..count - 1

 private:
  std::mt19937_64 bits_;
};

struct Layout {
  std::string name;
  int layers = 1;  ///< 1: a circle
  int per_layer = 0;
  int batch = 0;  ///< Trials in a fiftieth of a cell.

  [[nodiscard]] bool circle() const { return layers == 1; }
  [[nodiscard]] Eigen::Index points() const { return layers * per_layer; }
};
inline constexpr double kRadius_mm = 15.0;
inline constexpr double kHalfLength_mm = 18.0;
inline constexpr double kForm_um = 4.0;  ///< Range of a surface before its feature is added.
[[nodiscard]] const std::vector<Layout>& layouts();

/// Where the points are: layer after layer, each turned against the one before.
struct Places {
  explicit Places(const Layout& layout);
  Eigen::VectorXd angle_rad;
  Eigen::VectorXd q;  ///< Height in parts of the half length; 0 in a circle.
};

/// What size, place and tilt do to the deviations, to first order.
[[nodiscard]] Eigen::MatrixXd rigid_columns(const Places& at, bool circle);
/// The residual of least squares.
[[nodiscard]] Eigen::VectorXd free_of(const Eigen::MatrixXd& rigid, const Eigen::VectorXd& y);

struct Zone {
  double width = 0.0;  ///< There is a zone of this width, NaN where none was found;
  double gap = 0.0;    ///< and none is narrower by more than this.
};
/// The least range of f - R x over all x.
[[nodiscard]] Zone minimum_zone(const Eigen::MatrixXd& rigid, const Eigen::VectorXd& f);

/// "smooth", "1/k", "chatter", "barrel", "burr", "flat", "scratch"
[[nodiscard]] const std::vector<std::string>& surfaces();
/// The surface without its burr, flat or scratch.
[[nodiscard]] Eigen::VectorXd ground(const Layout& layout, const Places& at,
                                     const std::string& surface, Random& random);
[[nodiscard]] Eigen::VectorXd with_feature(const Layout& layout, const Places& at,
                                           const std::string& surface, Eigen::VectorXd form,
                                           Random& random);

struct Noise {
  enum class Kind { kNormal, kStudent, kCorrelated, kSpike };
  std::string name;
  double sigma_um = 0.0;  ///< Its standard deviation, and what is declared, as normal.
  Kind kind = Kind::kNormal;
};
[[nodiscard]] const std::vector<Noise>& noises();
[[nodiscard]] Eigen::VectorXd errors(const Layout& layout, const Noise& noise, Random& random);

/// Checks all of the above against worked numbers and by force; prints what it finds.
/// @return  How many checks failed.
[[nodiscard]] int failed_checks();

}  // namespace rondure::coverage
