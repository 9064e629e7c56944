#include "app/text/surface_words.h"

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "record/files.h"
#include "record/csv/series.h"

namespace rondure::app {
namespace {

constexpr std::size_t kMostEvenTerms = 10;

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t comma = text.find(',');
    out.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return out;
    text.remove_prefix(comma + 1);
  }
}

core::Result<double> number(std::string_view text, std::string_view of) {
  if (const auto value = core::parse_number(text)) return *value;
  return core::fail(
      core::Code::kBadOption,
      fmt::format("--surface: {} is \"{}\"; a number such as 12.5 is expected", of, text));
}

core::Result<fit::WheelSurface> read_polynomial(std::string_view words) {
  fit::Polynomial out;
  for (const std::string_view word : split(words)) {
    const auto value = number(word, fmt::format("a{}", out.coefficients.size()));
    if (!value) return core::fail(value.error());
    out.coefficients.push_back(*value);
  }
  return fit::WheelSurface::polynomial(std::move(out));
}

/// 0 for A2, 1 for A4, ...; nothing for another name.
std::optional<std::size_t> even_term(std::string_view name) {
  for (std::size_t i = 0; i < kMostEvenTerms; ++i) {
    if (name == fmt::format("A{}", 2 * (i + 1))) return i;
  }
  return std::nullopt;
}

core::Result<void> set_term(std::string_view name, double value, fit::Asphere& out) {
  if (name == "R" && value != 0.0) {
    out.curvature_per_mm = 1.0 / value;
  } else if (name == "c") {
    out.curvature_per_mm = value;
  } else if (name == "K") {
    out.conic = value;
  } else if (const auto term = even_term(name)) {
    out.even_terms.resize(std::max(out.even_terms.size(), *term + 1));
    out.even_terms[*term] = value;
  } else {
    return core::fail(core::Code::kBadOption,
                      fmt::format("--surface: an asphere has R (not 0) or c, K, A2, A4, ... A{}; "
                                  "there is \"{}={}\"",
                                  2 * kMostEvenTerms, name, core::shortest(value)));
  }
  return {};
}

core::Result<fit::WheelSurface> read_asphere(std::string_view words) {
  fit::Asphere out;
  for (const std::string_view word : split(words)) {
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) {
      return core::fail(
          core::Code::kBadOption,
          fmt::format("--surface: \"{}\" has no =; write asphere:R=120,K=-1,A4=2e-8", word));
    }
    const auto value = number(word.substr(equals + 1), word.substr(0, equals));
    if (!value) return core::fail(value.error());
    if (auto set = set_term(word.substr(0, equals), *value, out); !set) {
      return core::fail(set.error());
    }
  }
  return fit::WheelSurface::asphere(std::move(out));
}

core::Result<record::Series> read_table(const std::string& file,
                                        const std::array<record::WantedColumn, 2>& columns) {
  const auto bytes = record::read_file(file);
  if (!bytes) return core::fail(bytes.error());
  return record::parse_series_csv(*bytes, std::filesystem::path(file).filename().string(), columns);
}

core::Error in_file(const core::Error& error, const std::string& file) {
  return error.at(std::filesystem::path(file).filename().string());
}

}  // namespace

core::Result<fit::WheelSurface> read_surface(const std::string& word) {
  const std::string_view text = word;
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  if (kind == "polynomial") return read_polynomial(rest);
  if (kind == "asphere") return read_asphere(rest);
  if (kind != "table") {
    return core::fail(core::Code::kBadOption,
                      fmt::format("--surface is \"{}\"; polynomial:a0,a1,..., asphere:R=..,K=..,"
                                  "A4=.. or table:FILE.csv are known",
                                  word));
  }
  const std::string file(rest);
  const auto table = read_table(file, {{{"x"}, {"z"}}});
  if (!table) return core::fail(table.error());
  auto surface = fit::WheelSurface::table(*table->column("x"), *table->column("z"));
  if (!surface) return core::fail(in_file(surface.error(), file));
  return surface;
}

core::Result<fit::WheelSurface> take_removal(const fit::WheelSurface& surface,
                                             const std::string& file) {
  const auto table = read_table(file, {{{"x"}, {"depth_um"}}});
  if (!table) return core::fail(table.error());
  std::vector<double> depth = *table->column("depth_um");
  for (double& d : depth) d *= core::kMicrometre;
  auto out = surface.less(*table->column("x"), std::move(depth));
  if (!out) return core::fail(in_file(out.error(), file));
  return out;
}

}  // namespace rondure::app
