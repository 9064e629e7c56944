#include "record/points/points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/cloud.h"
#include "record/points/internal/head.h"
#include "record/points/internal/text_table.h"
#include "record/points/internal/units.h"
#include "record/points/triangles.h"

namespace rondure::record {
namespace {

constexpr WantedColumns kPoints;
constexpr std::string_view kProfileList = "theta_deg,r_um or x,y";
constexpr WantedColumns kSection = {{"x", "y", "z"}, {"mm", "mm", "mm"}, false, true, kProfileList};
constexpr WantedColumns kPolar = {
    {"theta_deg", "r_um", ""}, {"deg", "um", ""}, true, true, kProfileList};

/// How many points each layer has, layer 0 first.
std::vector<int> points_of_layers(const std::vector<int>& layers) {
  std::vector<int> out;
  for (const int layer : layers) {
    if (layer >= static_cast<int>(out.size())) out.resize(static_cast<std::size_t>(layer) + 1);
    ++out[static_cast<std::size_t>(layer)];
  }
  return out;
}

/// Makes layers that count from 1 count from 0.
/// @return  kSampling where one of them has no points.
core::Result<void> count_from_zero(std::vector<int>& layers) {
  if (layers.empty()) return {};
  if (*std::ranges::min_element(layers) == 1) {
    for (int& layer : layers) --layer;
  }
  const std::vector<int> points = points_of_layers(layers);
  const auto gap = std::ranges::find(points, 0);
  if (gap == points.end()) return {};
  return core::fail_with(core::Code::kSampling,
                         "there are points of layer {} and none of layer {}; layers count from 0 "
                         "or 1 without a gap",
                         points.size() - 1, gap - points.begin());
}

/// Leaves out the rows that have the coordinates and the layer of an earlier one.
void leave_out_repeated(PointTable& table) {
  const std::size_t count = table.points_mm.size();
  std::vector<std::uint32_t> seen(std::bit_ceil(2 * count + 1), 0);  // points from 1, by their hash
  const auto layer_of = [&](std::size_t k) { return table.layers.empty() ? 0 : table.layers[k]; };
  std::size_t kept = 0;
  for (std::size_t row = 0; row < count; ++row) {
    const Eigen::Vector3d point = table.points_mm[row];
    const int layer = layer_of(row);
    std::size_t at = PlaceHash()({point[0] + 0.0, point[1] + 0.0, point[2] + 0.0}) +
                     static_cast<std::size_t>(layer);
    const auto other = [&]() -> std::uint32_t& { return seen[at & (seen.size() - 1)]; };
    while (other() != 0 &&
           (table.points_mm[other() - 1] != point || layer_of(other() - 1) != layer)) {
      ++at;
    }
    if (other() != 0) {
      if (!table.repeated) {
        table.repeated = {0, row, other() - 1};
        table.rows.resize(row);
        std::iota(table.rows.begin(), table.rows.end(), std::size_t{0});
      }
      ++table.repeated->count;
      continue;
    }
    if (table.repeated) table.rows.push_back(row);
    table.points_mm[kept] = point;
    if (!table.layers.empty()) table.layers[kept] = layer;
    other() = static_cast<std::uint32_t>(++kept);
  }
  table.points_mm.resize(kept);
  if (!table.layers.empty()) table.layers.resize(kept);
}

/// Layers of points by their height, from the lowest: the steps between layers are longer than all
/// steps within one, and than 0.05 mm, by the greatest factor.
/// @return  kSampling where that factor is not above 3, or a layer has less than 3 points.
core::Result<std::vector<int>> layers_by_height(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kFactor = 3.0;
  constexpr double kLeast_mm = 0.05;  // a machine scatters by less; layers are farther apart
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t row) { return points[row].z(); });
  std::vector<double> steps = {0.0};
  for (std::size_t i = 1; i < order.size(); ++i) {
    steps.push_back(points[order[i]].z() - points[order[i - 1]].z());
  }
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted, std::greater());
  double best = kFactor;
  double limit = -1.0;  // the longest step within a layer
  for (std::size_t k = 1; 3 * k < sorted.size(); ++k) {
    const double factor = sorted[k - 1] / std::max(sorted[k], kLeast_mm);
    if (factor > best) std::tie(best, limit) = std::pair(factor, sorted[k]);
  }
  std::vector<int> out(points.size(), 0);
  int layer = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    layer += limit >= 0.0 && steps[i] > limit ? 1 : 0;
    out[order[i]] = layer;
  }
  const std::vector<int> counts = points_of_layers(out);
  if (layer > 0 && *std::ranges::min_element(counts) >= 3) return out;
  return core::fail(core::Code::kSampling,
                    "the heights z form no layers of 3 points or more; give a column layer");
}

/// Converts to mm.
core::Result<void> scale(std::optional<LengthUnit> unit, std::vector<Eigen::Vector3d>& points) {
  const double factor = mm_in(unit.value_or(LengthUnit::kMm));
  if (factor == 1.0) return {};
  for (Eigen::Vector3d& p : points) {
    p *= factor;
    if (core::is_measurable(p.cwiseAbs().maxCoeff())) continue;
    return core::fail_with(core::Code::kOutOfRange,
                           "a point lies {:g} mm off, the limit is {:g} mm",
                           p.cwiseAbs().maxCoeff(), core::kGreatestNumber);
  }
  return {};
}

/// ", 2 rows without values left out".
std::string left_out(std::size_t count, std::string_view name, std::string_view which) {
  if (count == 0) return {};
  return fmt::format(", {} {}{} {} left out", count, name, count == 1 ? "" : "s", which);
}

/// "24 points, 30.0 x 30.0 x 80.0 mm".
std::string extent_of(const PointTable& table) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : table.points_mm) box.extend(p);
  const Eigen::Vector3d size = box.sizes();
  std::string out =
      fmt::format("{} points, {:.1f} x {:.1f}", table.points_mm.size(), size[0], size[1]);
  return out + (table.dimensions == 3 ? fmt::format(" x {:.1f} mm", size[2]) : std::string(" mm"));
}

/// ", 5 heights taken as layers 1 to 5".
std::string layers_of(const PointTable& table, const PointsOptions& options) {
  if (table.layers.empty()) return {};
  const int count = table.layer_count();
  return options.layers == LayersFrom::kHeights
             ? fmt::format(", {} heights taken as layers 1 to {}", count, count)
             : fmt::format(", {} layer{}", count, count == 1 ? "" : "s");
}

/// "60 lines, 6 columns, the place of the scanner, its axes, a matrix": how many numbers stand in
/// each of the first lines of a PTX scan.
bool begins_ptx(std::string_view text) {
  for (const std::size_t count : {1, 1, 3, 3, 3, 3, 4, 4, 4, 4}) {
    const auto words = fields_of(take_line(text), ' ');
    const auto is_number = [](std::string_view word) {
      return core::parse_number(word).has_value();
    };
    if (words.size() != count || !std::ranges::all_of(words, is_number)) return false;
  }
  return true;
}

/// Why a file is of a format that is not read, as its first bytes show.
std::optional<core::Error> other_format(std::string_view bytes) {
  constexpr std::string_view kTable = "export the points as a text table";
  constexpr std::string_view kSheet = "save the sheet as CSV";
  constexpr std::string_view kPly = "convert it to PLY";
  // Bytes that are no text.
  static constexpr std::array kZip = {'P', 'K', '\x03', '\x04'};
  static constexpr std::array kOle = {'\xd0', '\xcf', '\x11', '\xe0'};
  static constexpr std::array kGzip = {'\x1f', '\x8b'};
  static constexpr std::array kPng = {'\x89', 'P', 'N', 'G'};
  static constexpr std::array kJpeg = {'\xff', '\xd8', '\xff'};
  static constexpr std::array kNumPy = {'\x93', 'N', 'U', 'M', 'P', 'Y'};
  static constexpr std::array kElf = {'\x7f', 'E', 'L', 'F'};
  const auto begin = [](const auto& chars) { return std::string_view(chars.data(), chars.size()); };
  struct Format {
    std::string_view begin;  ///< In lower case where it is text.
    std::string_view name;
    std::string_view instead;
  };
  const auto formats = std::to_array<Format>({
      {"ASTM-E57", "an E57 file", kPly},
      {"LASF", "a LAS scan", kPly},
      {begin(kZip), "an archive or a workbook", kSheet},
      {begin(kOle), "a workbook", kSheet},
      {begin(kGzip), "compressed", "unpack it"},
      {"%PDF", "a PDF document", kTable},
      {begin(kPng), "an image", kTable},
      {begin(kJpeg), "an image", kTable},
      {begin(kNumPy), "an array of NumPy", "save it by savetxt"},
      {"MATLAB 5.0 MAT-file", "a MAT file", kTable},
      {"ISO-10303-21", "a STEP model, which holds no measured points", kTable},
      {begin(kElf), "a program", kTable},
      {"<html", "an HTML page", kSheet},
      {"<!doctypehtml", "an HTML page", kSheet},
      {"<table", "an HTML page", kSheet},
      {"{\"", "a JSON document", kTable},
      {"[{", "a JSON document", kTable},
      {"[[", "a list in brackets", kTable},
      {"#vtkdatafile", "a VTK file", kPly},
      {"0section", "a DXF drawing", kTable},
  });
  std::string text = lower_case(without_byte_order_mark(bytes).substr(0, 4096));
  const std::string_view first = std::string_view(text).substr(0, text.find('\n'));
  const bool iges = first.size() >= 80 && first.substr(72, 8) == "s      1";
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
  const auto error = [](std::string_view name, std::string_view instead) {
    return syntax_error(fmt::format("the file is {}; {}", name, instead));
  };
  for (const Format& f : formats) {
    if (bytes.starts_with(f.begin) || text.starts_with(f.begin)) return error(f.name, f.instead);
  }
  if (iges) return error("an IGES model, which holds no measured points", kTable);
  if (text.find("=header/") != std::string::npos || text.find("=point/") != std::string::npos) {
    return error("a VDA model", kTable);
  }
  if (begins_ptx(bytes)) return error("a PTX scan", kPly);
  return std::nullopt;
}

/// Checks that a format without columns was not asked for them, and that it has points.
core::Result<void> check_cloud(const PointsOptions& options, const Cloud& cloud,
                               std::string_view name) {
  const auto fail = [&](core::Code code, std::string_view what) {
    return core::fail(code, std::string(what), std::string(name));
  };
  if (cloud.points.empty()) return fail(core::Code::kNoPoints, "the file has no points");
  if (!options.columns.empty() || !options.feature.empty() ||
      options.layers == LayersFrom::kColumn) {
    return fail(core::Code::kMeaning,
                "the file is no text table: it has no columns, features and layers to choose");
  }
  return {};
}

}  // namespace

int PointTable::layer_count() const { return static_cast<int>(points_of_layers(layers).size()); }

int PointTable::least_points_per_layer() const {
  const std::vector<int> points = points_of_layers(layers);
  return points.empty() ? 0 : *std::min_element(points.begin(), points.end());
}

core::Result<PointTable> read_points(std::string_view bytes, std::string_view name,
                                     const PointsOptions& options) {
  if (auto other = other_format(bytes)) return core::fail(other->at(std::string(name)));
  PointTable out;
  std::string how;
  auto unit = options.unit;
  auto cloud = read_cloud(bytes, name);
  DecodedText decoded;
  if (!cloud) {
    TRY(decoded, decode_text(bytes, name));
    cloud = read_export(decoded.text(bytes), name);
  }
  if (cloud) {
    TRY(auto found, *std::move(cloud));
    TRY_DO(check_cloud(options, found, name));
    out.points_mm = std::move(found.points);
    out.mesh = found.mesh;
    how = found.read + (found.mesh ? " of a mesh" : "");
    if (found.single) how += ", stored with 32 bits";
    how += left_out(found.left_out, "row", "without values");
    if (const auto fault = found.units.fault(); !unit && fault) return core::fail(*fault);
    if (!unit) unit = found.units.unit;
  } else {
    PointsOptions said = options;  // a name may be in the encoding of the file
    TRY(const auto feature, decode_text(options.feature, name));
    said.feature = feature.text(options.feature);
    TRY(auto text, read_text_table(decoded.text(bytes), name, said, kPoints));
    out.dimensions = text.dimensions;
    out.points_mm = std::move(text.rows);
    out.layers = std::move(text.layers);
    out.others = std::move(text.others);
    how = std::string(decoded.encoding) + (decoded.encoding.empty() ? "" : ", ") + text.read;
    how += left_out(text.left_out, "row", "without values");
    how += left_out(text.below, "line", "of text below the rows");
    if (unit && text.unit && unit != text.unit) {
      how += fmt::format(", which the file states in {},", name_of(*text.unit));
    }
    if (!unit) unit = text.unit;
  }
  out.unit_stated = unit.has_value();
  leave_out_repeated(out);
  const auto done = [&]() -> core::Result<void> {
    TRY_DO(scale(unit, out.points_mm));
    if (options.layers == LayersFrom::kHeights) {
      TRY(out.layers, layers_by_height(out.points_mm));
    }
    return count_from_zero(out.layers);
  }();
  if (!done) return core::fail(done.error().at(std::string(name)));
  out.read = fmt::format("{} in {}{}; {}{}", how, name_of(unit.value_or(LengthUnit::kMm)),
                         unit ? "" : " (not stated)", extent_of(out), layers_of(out, options));
  return out;
}

core::Result<ProfileTable> read_profile(std::string_view bytes, std::string_view name,
                                        const PointsOptions& options) {
  TRY(const auto decoded, decode_text(bytes, name));
  const std::string_view all = decoded.text(bytes);
  const bool polar = options.columns.empty() && all.find(kPolar.names[0]) != std::string_view::npos;
  if (polar && options.unit) {
    return core::fail(core::Code::kBadOption,
                      "theta_deg and r_um have their units; --unit is that of x and y",
                      std::string(name));
  }
  TRY(auto text, read_text_table(all, name, options, polar ? kPolar : kSection));
  if (!polar && text.dimensions == 3) {
    return core::fail(core::Code::kSyntax,
                      "the file has x, y and z; a section has theta_deg,r_um or x,y",
                      fmt::format("{}:1", name));
  }
  if (!polar) TRY_DO(scale(options.unit ? options.unit : text.unit, text.rows));
  ProfileTable table{polar, {}};
  table.rows.reserve(text.rows.size());
  for (const Eigen::Vector3d& values : text.rows) table.rows.emplace_back(values.head<2>());
  return table;
}

core::Result<Triangles> read_triangles(std::string_view bytes, std::string_view name,
                                       LengthUnit unit) {
  auto cloud = read_cloud(bytes, name);
  if (cloud && !*cloud) return core::fail(cloud->error());
  if (!cloud || (*cloud)->triangles.empty()) {
    return core::fail(core::Code::kSyntax, "this is no STL file with triangles", std::string(name));
  }
  Triangles out{std::move((*cloud)->points), std::move((*cloud)->triangles)};
  for (Eigen::Vector3d& point : out.points_mm) point *= mm_in(unit);
  return out;
}

}  // namespace rondure::record
