#include "plans/schema/findings.h"

#include <algorithm>
#include <utility>

namespace rondure::plans {
namespace {

bool inside(std::string_view pointer, std::string_view outer) {
  return pointer.starts_with(outer) &&
         (pointer.size() == outer.size() || pointer[outer.size()] == '/');
}

}  // namespace

void Findings::structure(std::size_t order, core::Error problem) {
  structure_.push_back({order, std::move(problem)});
}

void Findings::meaning(core::Code code, std::string where, std::string what) {
  meaning_.push_back({code, std::move(what), std::move(where)});
}

std::vector<std::string> Findings::given_in(const std::string& pointer) const {
  std::vector<std::string> out;
  for (const std::string& given : given_) {
    const bool below = given.size() > pointer.size() && inside(given, pointer);
    if (below && given.rfind('/') == pointer.size()) out.push_back(given);
  }
  return out;
}

bool Findings::sound(std::string_view pointer) const {
  return std::none_of(structure_.begin(), structure_.end(), [&](const Placed& placed) {
    const std::string& where = placed.problem.where;
    return inside(where, pointer) || inside(pointer, where);
  });
}

std::vector<core::Error> Findings::take() {
  std::stable_sort(structure_.begin(), structure_.end(),
                   [](const Placed& a, const Placed& b) { return a.order < b.order; });
  std::vector<core::Error> all;
  all.reserve(structure_.size() + meaning_.size());
  for (Placed& placed : structure_) all.push_back(std::move(placed.problem));
  for (core::Error& problem : meaning_) all.push_back(std::move(problem));
  structure_.clear();
  meaning_.clear();
  return all;
}

}  // namespace rondure::plans
