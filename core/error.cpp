#include "core/error.h"

#include <array>

#include <fmt/format.h>

namespace rondure::core {
namespace {

struct NamedCode {
  Code code;
  std::string_view name;
};

constexpr std::array kCodes = {
    NamedCode{Code::kNoPoints, "no-points"},
    NamedCode{Code::kNotFinite, "not-finite"},
    NamedCode{Code::kTooFewPoints, "too-few-points"},
    NamedCode{Code::kCollinear, "collinear"},
    NamedCode{Code::kNotFullSection, "not-full-section"},
    NamedCode{Code::kRank, "rank"},
    NamedCode{Code::kNotConverged, "not-converged"},
    NamedCode{Code::kUnits, "units"},
    NamedCode{Code::kShortArc, "short-arc"},
    NamedCode{Code::kTooFewCenters, "too-few-centers"},
    NamedCode{Code::kOutliers, "outliers"},
    NamedCode{Code::kSurface, "surface"},
    NamedCode{Code::kTable, "table"},
    NamedCode{Code::kGouge, "gouge"},
    NamedCode{Code::kWheelArc, "wheel-arc"},
    NamedCode{Code::kBadOption, "bad-option"},
    NamedCode{Code::kSyntax, "syntax"},
    NamedCode{Code::kUnknownKey, "unknown-key"},
    NamedCode{Code::kRepeatedKey, "repeated-key"},
    NamedCode{Code::kWrongUnit, "wrong-unit"},
    NamedCode{Code::kMissingKey, "missing-key"},
    NamedCode{Code::kWrongType, "wrong-type"},
    NamedCode{Code::kOutOfRange, "out-of-range"},
    NamedCode{Code::kPoseRange, "pose-range"},
    NamedCode{Code::kStep, "step"},
    NamedCode{Code::kSampling, "sampling"},
    NamedCode{Code::kMeaning, "meaning"},
    NamedCode{Code::kFile, "file"},
    NamedCode{Code::kUnreachable, "unreachable"},
    NamedCode{Code::kNoTouch, "no-touch"},
    NamedCode{Code::kCollision, "collision"},
    NamedCode{Code::kLocation, "location"},
    NamedCode{Code::kCalibration, "calibration"},
    NamedCode{Code::kMachine, "machine"},
    NamedCode{Code::kStopped, "stopped"},
    NamedCode{Code::kJournal, "journal"},
    NamedCode{Code::kArchive, "archive"},
    NamedCode{Code::kInternal, "internal"},
    NamedCode{Code::kSparse, "sparse"},
    NamedCode{Code::kNoCertificate, "no-certificate"},
    NamedCode{Code::kExactFit, "exact-fit"},
    NamedCode{Code::kNotLevel, "not-level"},
    NamedCode{Code::kUndersampled, "undersampled"},
    NamedCode{Code::kFilteredTwice, "filtered-twice"},
    NamedCode{Code::kUndercut, "undercut"},
    NamedCode{Code::kSense, "sense"},
    NamedCode{Code::kAlignment, "alignment"},
    NamedCode{Code::kAngleOrder, "angle-order"},
    NamedCode{Code::kReferenceAbsent, "reference-absent"},
    NamedCode{Code::kCenterDisagrees, "center-disagrees"},
    NamedCode{Code::kNoAxis, "no-axis"},
    NamedCode{Code::kLocalForm, "local-form"},
    NamedCode{Code::kCorrelated, "correlated"},
    NamedCode{Code::kLowMargin, "low-margin"},
    NamedCode{Code::kSeveralOptima, "several-optima"},
    NamedCode{Code::kHarmonicLoss, "harmonic-loss"},
    NamedCode{Code::kInconsistent, "inconsistent"},
    NamedCode{Code::kUnfiltered, "unfiltered"},
    NamedCode{Code::kRepeatedRows, "repeated-rows"},
};

constexpr bool codes_stand_in_order() {
  for (std::size_t i = 0; i < kCodes.size(); ++i) {
    if (kCodes[i].code != static_cast<Code>(i)) return false;
  }
  return kCodes.back().code == kLastCode;
}
static_assert(codes_stand_in_order());

}  // namespace

std::string_view code_name(Code code) {
  const auto at = static_cast<std::size_t>(code);
  return at < kCodes.size() ? kCodes[at].name : "internal";
}

Error error_of(Code code, Phrase said, std::string where) {
  std::string what = said.english();
  return {code, std::move(what), std::move(where), std::move(said)};
}

std::string to_line(const Error& error) {
  if (error.where.empty()) return fmt::format("{} [{}]", error.what, code_name(error.code));
  return fmt::format("{}: {} [{}]", error.where, error.what, code_name(error.code));
}

}  // namespace rondure::core
