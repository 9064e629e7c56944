#include "record/archive/internal/postgresql.h"

#include <dlfcn.h>

namespace rondure::record {
namespace {

/// Finds a function in the library or in one that it needs.
template <class Function>
bool find_function(void* library, const char* name, Function& out) {
  out = reinterpret_cast<Function>(dlsym(library, name));
  return out != nullptr;
}

}  // namespace

core::Result<PostgresqlLibrary> load_postgresql(const char* name) {
  PostgresqlLibrary out;
  void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  const bool whole = library != nullptr &&
                     find_function(library, "factory_postgresql", out.factory) &&
                     find_function(library, "PQconninfoParse", out.parse) &&
                     find_function(library, "PQconninfoFree", out.free_settings) &&
                     find_function(library, "PQfreemem", out.free_words);
  if (whole) return out;
  return core::fail_with(core::Code::kFile,
                         "an archive on a server needs a library that cannot be loaded: {}; "
                         "install libsoci-postgresql4.0, or name a file as archive",
                         dlerror());
}

const core::Result<PostgresqlLibrary>& postgresql() {
  static const core::Result<PostgresqlLibrary> kLibrary = load_postgresql(RONDURE_POSTGRESQL);
  return kLibrary;
}

}  // namespace rondure::record
