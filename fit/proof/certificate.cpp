#include "fit/proof/certificate.h"

namespace rondure::fit {

std::string_view name_of(Certificate::Kind kind) {
  switch (kind) {
    case Certificate::Kind::kNone:
      return "none";
    case Certificate::Kind::kLocal:
      return "local";
    case Certificate::Kind::kGlobal:
      return "global";
  }
  return "none";
}

}  // namespace rondure::fit
