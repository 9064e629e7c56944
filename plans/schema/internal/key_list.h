#pragma once

#include <map>
#include <string>

namespace rondure::plans {

/// All keys of a plan as Markdown tables, one per object, from plan_table.h: key, value with its
/// default, meaning. By page of docs/, which ends with its tables; equal objects have one table.
[[nodiscard]] std::map<std::string, std::string> key_list_pages();

}  // namespace rondure::plans
