#include "core/error.h"

#include <fmt/format.h>

namespace rondure::core {

std::string_view code_name(Code code) {
  switch (code) {
    case Code::kNoPoints:
      return "no-points";
    case Code::kNotFinite:
      return "not-finite";
    case Code::kTooFewPoints:
      return "too-few-points";
    case Code::kCollinear:
      return "collinear";
    case Code::kNotFullSection:
      return "not-full-section";
    case Code::kRank:
      return "rank";
    case Code::kNotConverged:
      return "not-converged";
    case Code::kUnits:
      return "units";
    case Code::kShortArc:
      return "short-arc";
    case Code::kTooFewCenters:
      return "too-few-centers";
    case Code::kOutliers:
      return "outliers";
    case Code::kSurface:
      return "surface";
    case Code::kTable:
      return "table";
    case Code::kGouge:
      return "gouge";
    case Code::kWheelArc:
      return "wheel-arc";
    case Code::kBadOption:
      return "bad-option";
    case Code::kSyntax:
      return "syntax";
    case Code::kUnknownKey:
      return "unknown-key";
    case Code::kRepeatedKey:
      return "repeated-key";
    case Code::kWrongUnit:
      return "wrong-unit";
    case Code::kMissingKey:
      return "missing-key";
    case Code::kWrongType:
      return "wrong-type";
    case Code::kOutOfRange:
      return "out-of-range";
    case Code::kPoseRange:
      return "pose-range";
    case Code::kStep:
      return "step";
    case Code::kSampling:
      return "sampling";
    case Code::kMeaning:
      return "meaning";
    case Code::kFile:
      return "file";
    case Code::kUnreachable:
      return "unreachable";
    case Code::kNoTouch:
      return "no-touch";
    case Code::kCollision:
      return "collision";
    case Code::kLocation:
      return "location";
    case Code::kCalibration:
      return "calibration";
    case Code::kMachine:
      return "machine";
    case Code::kStopped:
      return "stopped";
    case Code::kJournal:
      return "journal";
    case Code::kArchive:
      return "archive";
    case Code::kInternal:
      return "internal";
    case Code::kSparse:
      return "sparse";
    case Code::kNoCertificate:
      return "no-certificate";
    case Code::kExactFit:
      return "exact-fit";
    case Code::kNotLevel:
      return "not-level";
    case Code::kUndersampled:
      return "undersampled";
    case Code::kAngleOrder:
      return "angle-order";
    case Code::kReferenceAbsent:
      return "reference-absent";
    case Code::kSeveralOptima:
      return "several-optima";
    case Code::kFilteredTwice:
      return "filtered-twice";
    case Code::kUndercut:
      return "undercut";
    case Code::kSense:
      return "sense";
    case Code::kAlignment:
      return "alignment";
    case Code::kHarmonicLoss:
      return "harmonic-loss";
    case Code::kInconsistent:
      return "inconsistent";
    case Code::kCenterDisagrees:
      return "center-disagrees";
    case Code::kNoAxis:
      return "no-axis";
    case Code::kLocalForm:
      return "local-form";
    case Code::kCorrelated:
      return "correlated";
    case Code::kLowMargin:
      return "low-margin";
  }
  return "internal";
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
