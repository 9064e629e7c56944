#pragma once

// For report.pdf and report.junit.xml alone; it goes with them.

#include "core/numbers.h"
#include "reports/columns.h"
#include "reports/escaping.h"
#include "reports/words/language.h"

namespace rondure::reports {

using core::fixed;
using core::um;

}  // namespace rondure::reports
