#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/fit.h"
#include "app/text/terminal.h"
#include "app/verbs/fit_shapes.h"
#include "app/verbs/verbs.h"
#include "record/csv/points.h"

namespace rondure::app {
namespace {

core::Result<record::PointTable> load_points(const FitArguments& arguments) {
  const auto bytes = record::read_file(arguments.file);
  if (!bytes) return core::fail(bytes.error());
  const std::string name = std::filesystem::path(arguments.file).filename().string();
  auto table = record::parse_points_csv(*bytes, name);
  if (!table) return table;
  const int needed = arguments.shape == "circle" ? 2 : 3;
  if (table->dimensions != needed) {
    return core::fail(core::Code::kSyntax,
                      fmt::format("a {} needs the columns {}, the file has {}", arguments.shape,
                                  needed == 2 ? "x,y" : "x,y,z", needed == 2 ? "x,y,z" : "x,y"),
                      name + ":1");
  }
  return table;
}

}  // namespace

int fit(const FitArguments& arguments) {
  const auto table = load_points(arguments);
  if (!table) {
    print_error(table.error());
    return kBadInput;
  }
  const auto outcome = fit_shape(arguments.shape, arguments.reference, table->points_mm);
  if (!outcome) {
    const core::Error& error = outcome.error();
    print_error(error.at(error.where.empty() ? arguments.file : error.where));
    return kBadInput;
  }
  return answer(fit_json(*outcome), arguments.json, [&] { return fit_table(*outcome); });
}

}  // namespace rondure::app
