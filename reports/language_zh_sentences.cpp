#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"reported only", "仅报告，不判定"},
};

}  // namespace

std::span<const Translation> chinese_sentences() { return kTexts; }

}  // namespace rondure::reports
