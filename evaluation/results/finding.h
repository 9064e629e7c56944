#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/phrase.h"
#include "evaluation/decision/decision.h"
#include "fit/geometry/axis.h"
#include "fit/proof/certificate.h"
#include "record/indication.h"

namespace rondure::evaluation {

/// Of a finding, kNone leaves out the notes for a verdict, too.
using fit::Proof;

/// A value with the limits that it is held against. Most characteristics have one; the envelope
/// requirement and two-point sizes without a rank have two, one for each limit.
struct JudgedValue {
  std::string symbol;  ///< "d GN", "STRt".
  double value_mm = 0.0;
  Limits limits;  ///< None: reported only.
};

/// The value of one section, generatrix or circle of a characteristic that is the worst of several.
struct LocalValue {
  enum class Place { kLayer, kAngle, kRadius };
  Place place = Place::kLayer;
  int layer = 0;          ///< For kLayer; 0-based.
  double position = 0.0;  ///< Height of the layer, angle as in the cloud, or radius [mm or rad].
  double value_mm = 0.0;  ///< Greatest; meaningless with `none`.
  std::optional<double> least_mm = {};   ///< Of a section with a greatest and a least size.
  std::optional<core::Error> none = {};  ///< Why there is no value here.
};

/// A profile for the picture: deviations along a generatrix.
struct ProfileLine {
  double angle_rad = 0.0;            ///< About the axis of the feature, as in the cloud.
  std::vector<double> position_mm;   ///< Along the axis.
  std::vector<double> deviation_mm;  ///< From its least-squares line.
};

/// A number that explains a value, e.g. "SA" of two-point sizes.
struct NamedNumber {
  std::string name;  ///< With its unit where it is no length in mm: "pairs", "angle_deg".
  double value = 0.0;
  bool length = true;  ///< In mm; written in um or mm as the value is.
};

/// A datum as associated for a characteristic.
struct DatumResult {
  std::string name;  ///< "A", "A-B".
  record::Indication::Association association = record::Indication::Association::kOneSided;
  bool plane = false;  ///< A plane through the point, its normal out of the material; else an axis.
  fit::Axis place;     ///< Machine frame.
  std::vector<double> radii_mm;        ///< Of the tip-centre cylinders, one for each feature.
  std::vector<std::size_t> features;   ///< Index of each feature.
  double length_mm = 0.0;              ///< Over which the datum is supported.
  double play_mm = 0.0;                ///< How far its ends can rock; 0 of a plane.
  std::optional<fit::Axis> equalised;  ///< Beside a one-sided one.
};

/// Why a row of the cloud takes no part.
struct LeftOut {
  std::size_t row = 0;      ///< Of FeatureResult::cloud.
  std::string window = {};  ///< Name of the window; empty: the outlier rule took it out.
};

/// How the value of a characteristic came about.
struct Finding {
  std::vector<JudgedValue> judged;  ///< Not empty. The first is the value of the characteristic.
  std::vector<LocalValue> local;    ///< All sections, generatrices or circles; may be empty.
  std::size_t worst = 0;            ///< Of `local`.
  std::vector<NamedNumber> numbers;
  std::vector<ProfileLine> lines;
  std::vector<Eigen::Vector3d> centers_mm;  ///< Median line, where the value is made of it.
  std::vector<std::size_t> rows;            ///< Rows of the cloud that carry the value.
  std::vector<DatumResult> datums;          ///< In the order of the indication.
  /// The values about the equalised datum, in the order of `judged`; where datums are one-sided.
  std::vector<double> about_equalised_mm;
  std::vector<LeftOut> left_out;
  std::vector<core::Error> warnings;
  /// Why no verdict may rest on the value: no certificate, a part of the turn unseen, several
  /// equally good circles with the limit between their deviations.
  std::optional<core::Phrase> no_verdict;
  int pivots = 0;          ///< Of searches without proof: the measure of their time.
  bool unique = true;      ///< False: an interval would be that of one of several equal circles.
  core::Phrase reference;  ///< Words of the operator: "GN, as felt by the tip", "about A-B".
  core::Phrase filter;     ///< "unfiltered", "gaussian 50 UPR".
};

}  // namespace rondure::evaluation
