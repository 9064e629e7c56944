#include "record/run_record.h"

namespace rondure::record {

std::string_view name_of(Shape shape) {
  switch (shape) {
    case Shape::kCylinder:
      return "cylinder";
    case Shape::kCircle:
      return "circle";
  }
  return "";
}

std::string_view name_of(Side side) {
  switch (side) {
    case Side::kOutside:
      return "outside";
    case Side::kInside:
      return "inside";
  }
  return "";
}

std::string_view name_of(Form form) {
  switch (form) {
    case Form::kCylindricity:
      return "cylindricity";
    case Form::kRoundness:
      return "roundness";
  }
  return "";
}

std::string_view name_of(Reference reference) {
  switch (reference) {
    case Reference::kLeastSquares:
      return "ls";
    case Reference::kMinimumZone:
      return "mz";
    case Reference::kMinimumCircumscribed:
      return "mc";
    case Reference::kMaximumInscribed:
      return "mi";
  }
  return "";
}

std::string_view name_of(Strategy strategy) {
  switch (strategy) {
    case Strategy::kGuided:
      return "guided";
    case Strategy::kRefined:
      return "refined";
    case Strategy::kAsPublished:
      return "as-published";
    case Strategy::kVirtual:
      return "virtual";
    case Strategy::kPointsFile:
      return "points-file";
  }
  return "";
}

std::string_view name_of(Touch::Purpose purpose) {
  switch (purpose) {
    case Touch::Purpose::kQualification:
      return "qualification";
    case Touch::Purpose::kLocate:
      return "locate";
    case Touch::Purpose::kMeasure:
      return "measure";
    case Touch::Purpose::kCheck:
      return "check";
  }
  return "measure";
}

}  // namespace rondure::record
