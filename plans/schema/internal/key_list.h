#pragma once

#include <string>

namespace rondure::plans {

/// All keys of a plan as Markdown tables, one per object, from plan_table.h: key, value, default,
/// meaning. docs/plan.md ends with it.
[[nodiscard]] std::string key_list_markdown();

}  // namespace rondure::plans
