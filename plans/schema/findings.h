#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace rondure::plans {

/// All problems of a plan, and the pointers of the values that it gives. Problems of structure come
/// first, in the order of the document, then those of meaning, in the order of their detection.
class Findings {
 public:
  /// Adds a problem of structure; `order` is that of the value (JsonValue::order).
  void structure(std::size_t order, core::Error problem);
  /// Adds a problem of meaning.
  void meaning(core::Code code, std::string where, std::string what);

  /// Notes that the plan gives the value at this pointer.
  void note_given(std::string pointer) { given_.insert(std::move(pointer)); }
  [[nodiscard]] bool is_given(const std::string& pointer) const { return given_.contains(pointer); }
  /// The pointers of the members that the plan gives the object at this pointer.
  [[nodiscard]] std::vector<std::string> given_in(const std::string& pointer) const;

  /// Whether there is no problem of structure at that pointer, inside it or around it, so that its
  /// values can be checked.
  [[nodiscard]] bool sound(std::string_view pointer) const;

  /// Moves all problems out, in order.
  [[nodiscard]] std::vector<core::Error> take();

 private:
  struct Placed {
    std::size_t order = 0;
    core::Error problem;
  };
  std::vector<Placed> structure_;
  std::vector<core::Error> meaning_;
  std::set<std::string> given_;
};

}  // namespace rondure::plans
