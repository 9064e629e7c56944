#pragma once

#include <string>

#include "record/key_spec.h"

namespace rondure::record {

/// A value that a feature takes from an earlier feature of the same plan: { "feature": "ID" }.
/// Nothing of the value itself is kept: it is computed again whenever the run is evaluated.
struct FeatureReference {
  std::string feature;  ///< Its id.
};

template <class Visitor>
void describe(Visitor& v, FeatureReference& p) {
  v.text("feature", p.feature,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Id of an earlier feature of the plan."});
}

}  // namespace rondure::record
