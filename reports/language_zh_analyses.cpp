#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"Radius R", "半径 R"},
};

}  // namespace

std::span<const Translation> chinese_analyses() { return kTexts; }

}  // namespace rondure::reports
