#include "evaluation/uncertainty/kept_draws.h"

namespace rondure::evaluation {
namespace {

thread_local KeptDraws* in_use = nullptr;

}  // namespace

UseOfDraws::UseOfDraws(KeptDraws& draws) { in_use = &draws; }
UseOfDraws::~UseOfDraws() { in_use = nullptr; }
KeptDraws* UseOfDraws::current() { return in_use; }

}  // namespace rondure::evaluation
