#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"Feature {}", "要素 {}"},
};

}  // namespace

std::span<const Translation> chinese_page() { return kTexts; }

}  // namespace rondure::reports
