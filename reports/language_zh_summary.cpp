#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"rule", "规则"},
};

}  // namespace

std::span<const Translation> chinese_summary() { return kTexts; }

}  // namespace rondure::reports
