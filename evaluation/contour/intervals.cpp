#include "evaluation/contour/internal/trials.h"
#include "evaluation/contour/result.h"

namespace rondure::evaluation {

std::vector<UncertaintyStatus> intervals_of(const ContourResult& result,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  auto out = total_intervals(result, characteristics, options);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (characteristics[i].form == record::Form::kFollowingDeviation) {
      out[i] = following_interval(result, options);
    }
  }
  return out;
}

std::string ContourNumber::name() const {
  const auto of = [&]() -> std::string {
    switch (curve) {
      case Curve::kTotal:
        return "total";
      case Curve::kFollowing:
        return "following";
      case Curve::kRest:
        return "rest";
      case Curve::kIndirect:
        return "indirect";
      case Curve::kMain:
        return "main";
    }
    return {};
  };
  const std::string_view what = kind == Kind::kPeakToValley ? "-pv"
                                : kind == Kind::kRms        ? "-rms"
                                                            : "-index";
  return of().append(what);
}

}  // namespace rondure::evaluation
