#pragma once

#include "app/verbs/verbs.h"

namespace CLI {
class App;
}

// The command line of the sister analyses: one function per verb, called by main.cpp.

namespace rondure::app {

void add_spindle(CLI::App& fit_verb, SpindleArguments& arguments);
void add_design_probes(CLI::App& app, DesignArguments& arguments);

}  // namespace rondure::app
