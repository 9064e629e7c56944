#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation {}  // namespace rondure::evaluation
