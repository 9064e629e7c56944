#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"height / mm", "高度 / mm"},
};

}  // namespace

std::span<const Translation> chinese_drawings() { return kTexts; }

}  // namespace rondure::reports
