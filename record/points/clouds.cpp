#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/cloud.h"
#include "record/points/internal/head.h"

namespace rondure::record {
namespace {

using core::Code;

/// A type of numbers in a binary file.
struct Scalar {
  char kind;  ///< 'i', 'u' or 'f'.
  std::size_t bytes;
};
constexpr auto kPlyTypes =
    std::to_array<std::pair<std::string_view, Scalar>>({{"char", {'i', 1}},
                                                        {"uchar", {'u', 1}},
                                                        {"short", {'i', 2}},
                                                        {"ushort", {'u', 2}},
                                                        {"int", {'i', 4}},
                                                        {"uint", {'u', 4}},
                                                        {"float", {'f', 4}},
                                                        {"double", {'f', 8}},
                                                        {"int8", {'i', 1}},
                                                        {"uint8", {'u', 1}},
                                                        {"int16", {'i', 2}},
                                                        {"uint16", {'u', 2}},
                                                        {"int32", {'i', 4}},
                                                        {"uint32", {'u', 4}},
                                                        {"float32", {'f', 4}},
                                                        {"float64", {'f', 8}}});

std::optional<Scalar> scalar_named(std::string_view name) {
  for (const auto& [word, type] : kPlyTypes) {
    if (word == name) return type;
  }
  return std::nullopt;
}

template <class Number, class Bits>
double number_of(Bits bits) {
  return static_cast<double>(std::bit_cast<Number>(bits));
}

/// The number at a place, of which so many bytes are there.
double number_at(const char* at, Scalar type, bool big) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < type.bytes; ++i) {
    const auto byte = static_cast<unsigned char>(at[big ? i : type.bytes - 1 - i]);
    bits = (bits << 8U) | byte;
  }
  switch (type.kind == 'f' ? 16 + type.bytes : type.kind == 'i' ? 8 + type.bytes : 0) {
    case 24:
      return number_of<double>(bits);
    case 20:
      return number_of<float>(static_cast<std::uint32_t>(bits));
    case 16:
      return number_of<std::int64_t>(bits);
    case 12:
      return number_of<std::int32_t>(static_cast<std::uint32_t>(bits));
    case 10:
      return number_of<std::int16_t>(static_cast<std::uint16_t>(bits));
    case 9:
      return number_of<std::int8_t>(static_cast<std::uint8_t>(bits));
    default:
      return static_cast<double>(bits);
  }
}

/// One number of a row, several, or a list behind its length.
struct Field {
  Scalar type;
  std::size_t repeat = 1;
  std::optional<Scalar> length = {};
  std::optional<std::size_t> axis = {};  ///< 0 for x.
};

/// The rows of one kind.
struct Block {
  std::size_t rows = 0;
  std::vector<Field> fields;

  /// Bytes of the shortest row.
  [[nodiscard]] std::size_t least_bytes() const {
    std::size_t out = 0;
    for (const Field& f : fields) out += f.length ? f.length->bytes : f.repeat * f.type.bytes;
    return out;
  }
};

enum class Coding { kText, kLittle, kBig };
RONDURE_WORDS(Coding, {kText, "text"}, {kLittle, "little endian"}, {kBig, "big endian"});

/// A file behind its head.
struct Body {
  std::string_view rest;
  std::string_view name;
  Coding form = Coding::kText;
  std::size_t line = 0;  ///< Of text, taken last.

  [[nodiscard]] tl::unexpected<core::Error> fail(Code code, std::string what) const {
    return core::fail(code, std::move(what),
                      form == Coding::kText ? fmt::format("{}:{}", name, line) : std::string(name));
  }
  [[nodiscard]] tl::unexpected<core::Error> cut_off(std::size_t rows, std::string_view what) const {
    return fail(Code::kSyntax, fmt::format("the head announces {} {}, the file ends before that: "
                                           "is it cut off?",
                                           rows, what));
  }
};

/// Checks that a file can hold the rows that its head announces.
core::Result<void> check_length(const Body& body, const Block& block, std::string_view what) {
  const std::size_t least =
      body.form == Coding::kText ? 2 * block.fields.size() : block.least_bytes();
  if (block.rows > kMostRows) return core::fail(too_many_rows().at(std::string(body.name)));
  // the last line of a text may end without a sign
  if (block.rows > 0 && least * block.rows > body.rest.size() + 1) {
    return body.cut_off(block.rows, what);
  }
  return {};
}

core::Result<void> keep_point(const Body& body, const Eigen::Vector3d& point, std::size_t row,
                              std::vector<Eigen::Vector3d>& out) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (core::is_measurable(point[k])) continue;
    return body.fail(
        Code::kNotFinite,
        fmt::format("{} of point {} is no number within 1e9",
                    std::string_view("xyz").substr(static_cast<std::size_t>(k), 1), row + 1));
  }
  out.push_back(point);
  return {};
}

/// The points of rows. A row with NaN has none: a scanner saw nothing there.
struct RowsTaken {
  std::vector<Eigen::Vector3d> points = {};
  std::size_t left_out = 0;
  std::optional<core::Error> first = {};  ///< Of a row that is left out.

  core::Result<void> take(const Body& body, const Eigen::Vector3d& point, std::size_t row) {
    auto kept = keep_point(body, point, row, points);
    if (kept || !point.hasNaN()) return kept;
    if (!first) first = std::move(kept).error();
    ++left_out;
    return {};
  }
};

core::Result<void> read_text_rows(Body& body, const Block& block, RowsTaken* out) {
  for (std::size_t row = 0; row < block.rows;) {
    if (body.rest.empty()) return body.cut_off(block.rows, "points");
    ++body.line;
    const std::string_view line = take_line(body.rest);
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    ++row;
    if (out == nullptr) continue;
    const auto words = fields_of(line, ' ');
    Eigen::Vector3d point;
    std::size_t word = 0;
    for (const Field& field : block.fields) {
      if (field.axis) {
        auto value = word < words.size() ? core::parse_number(words[word]) : std::nullopt;
        if (word < words.size() && is_nan(words[word])) value = std::nan("");
        if (!value) {
          return body.fail(Code::kSyntax, fmt::format("field {} of {} is no number within 1e9",
                                                      word + 1, quoted_text(line)));
        }
        point[static_cast<Eigen::Index>(*field.axis)] = *value;
      }
      word += field.repeat;
      if (field.length && word <= words.size()) {
        const auto length = core::parse_number(words[word - 1]);
        word += length && *length >= 0.0 && *length < 1e6 ? static_cast<std::size_t>(*length) : 0;
      }
    }
    TRY_DO(out->take(body, point, row - 1));
  }
  return {};
}

core::Result<void> read_binary_rows(Body& body, const Block& block, RowsTaken* out) {
  const bool big = body.form == Coding::kBig;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (std::size_t row = 0; row < block.rows; ++row) {
    for (const Field& field : block.fields) {
      std::size_t count = field.repeat;
      if (field.length) {
        if (body.rest.size() < field.length->bytes) return body.cut_off(block.rows, "rows");
        const double length = number_at(body.rest.data(), *field.length, big);
        body.rest.remove_prefix(field.length->bytes);
        if (!(length >= 0.0 && length <= static_cast<double>(body.rest.size()))) {
          return body.cut_off(block.rows, "rows");
        }
        count = static_cast<std::size_t>(length);
      }
      const std::size_t bytes = count * field.type.bytes;
      if (body.rest.size() < bytes) return body.cut_off(block.rows, "rows");
      if (field.axis) {
        point[static_cast<Eigen::Index>(*field.axis)] =
            number_at(body.rest.data(), field.type, big);
      }
      body.rest.remove_prefix(bytes);
    }
    if (out != nullptr) TRY_DO(out->take(body, point, row));
  }
  return {};
}

/// Reads the rows of a block, or passes over them.
core::Result<void> read_rows(Body& body, const Block& block, RowsTaken* out) {
  if (block.fields.empty()) return {};
  TRY_DO(check_length(body, block, out != nullptr ? "points" : "rows"));
  if (out != nullptr) out->points.reserve(block.rows);
  return body.form == Coding::kText ? read_text_rows(body, block, out)
                                    : read_binary_rows(body, block, out);
}

/// Reads the points of a block that must have x, y and z.
core::Result<Cloud> take_points(Body& body, const Block& block, std::string_view format) {
  Cloud out;
  std::size_t axes = 0;
  for (const Field& f : block.fields) {
    if (!f.axis) continue;
    axes += *f.axis + 1;
    out.single = out.single || (f.type.kind == 'f' && f.type.bytes == 4);
  }
  if (axes != 6) {
    return core::fail(Code::kSyntax, "the points need x, y and z, each once, as plain numbers",
                      std::string(body.name));
  }
  RowsTaken rows;
  TRY_DO(read_rows(body, block, &rows));
  if (rows.left_out * 100 > block.rows) return core::fail(*rows.first);
  out.points = std::move(rows.points);
  out.left_out = rows.left_out;
  if (body.form == Coding::kText) out.single = false;
  out.read = fmt::format("{}, {}, x y z", format, name_of(body.form));
  return out;
}

/// Refuses what stands behind the last point, where nothing else may.
core::Result<void> check_end(Body& body, std::size_t points) {
  using namespace std::string_view_literals;
  if (body.rest.find_first_not_of(" \t\r\n\0"sv) == std::string_view::npos) return {};
  ++body.line;
  return body.fail(Code::kSyntax, fmt::format("the head announces {} points, and more follow; "
                                              "correct the count, or save the file anew",
                                              points));
}

std::optional<std::size_t> axis_named(std::string_view name) {
  const bool known = name.size() == 1 && name[0] >= 'x' && name[0] <= 'z';
  return known ? std::optional(static_cast<std::size_t>(name[0] - 'x')) : std::nullopt;
}

core::Result<Cloud> read_ply(std::string_view bytes, std::string_view name) {
  Body body{bytes, name};
  std::vector<std::pair<std::string, Block>> blocks;
  std::optional<Coding> form;
  UnitLines units;
  for (bool ended = false; !ended;) {
    if (body.rest.empty()) return body.fail(Code::kSyntax, "the head of the PLY file has no end");
    ++body.line;
    const std::string_view line = take_line(body.rest);
    const auto words = fields_of(line, ' ');
    const std::string_view word = words[0];
    const auto wrong = [&] {
      return body.fail(Code::kSyntax,
                       fmt::format("{} is no line of a PLY head", quoted_text(line)));
    };
    if (word == "format" && words.size() > 1) {
      if (words[1] == "ascii") form = Coding::kText;
      if (words[1] == "binary_little_endian") form = Coding::kLittle;
      if (words[1] == "binary_big_endian") form = Coding::kBig;
      if (!form) return wrong();
    } else if (word == "element") {
      const auto rows = words.size() == 3 ? count_of(words[2]) : std::nullopt;
      if (!rows) return wrong();
      blocks.emplace_back(words[1], Block{*rows, {}});
    } else if (word == "property") {
      const bool list = words.size() == 5 && words[1] == "list";
      const auto type = words.size() > 2 ? scalar_named(words[words.size() - 2]) : std::nullopt;
      const auto length = list ? scalar_named(words[2]) : std::nullopt;
      if (blocks.empty() || !type || (list ? !length : words.size() != 3)) return wrong();
      blocks.back().second.fields.push_back(
          {*type, 1, length, list ? std::nullopt : axis_named(words.back())});
    } else if (word == "end_header") {
      ended = true;
    } else if (word == "comment" || word == "obj_info") {
      units.take(line.substr(word.size()), name, body.line);
    }  // other lines mean nothing: "Created by ..."
  }
  if (!form) return body.fail(Code::kSyntax, "the head of the PLY file names no format");
  body.form = *form;
  std::optional<Cloud> out;
  bool faces = false;
  bool more = false;  // than points
  for (const auto& [element, block] : blocks) {
    faces = faces || (element == "face" && block.rows > 0);
    more = more || (out && block.rows > 0);
    if (out) continue;  // what follows the points is not read
    if (element == "vertex") {
      TRY(out, take_points(body, block, "PLY"));
    } else {
      TRY_DO(read_rows(body, block, nullptr));
    }
  }
  if (!out) return body.fail(Code::kSyntax, "the PLY file has no element vertex");
  if (!more) TRY_DO(check_end(body, out->points.size() + out->left_out));
  out->mesh = faces;
  out->units = std::move(units);
  return *std::move(out);
}

/// "# .PCD v.7", or "VERSION 0.7" and FIELDS below any comments.
bool begins_pcd(std::string_view bytes) {
  if (bytes.starts_with("# .PCD")) return true;
  std::string_view head = bytes.substr(0, 65536);
  std::string_view line = take_line(head);
  while (!head.empty() && holds_no_row(line)) line = take_line(head);
  return line.starts_with("VERSION ") && head.starts_with("FIELDS ");
}

core::Result<Cloud> read_pcd(std::string_view bytes, std::string_view name) {
  Body body{bytes, name};
  Block block;
  std::vector<std::string_view> names;
  std::vector<std::string_view> types;
  std::vector<std::size_t> sizes;
  std::vector<std::size_t> counts;
  std::string_view data;
  UnitLines units;
  while (data.empty()) {
    if (body.rest.empty()) return body.fail(Code::kSyntax, "the head of the PCD file has no end");
    ++body.line;
    const std::string_view line = take_line(body.rest);
    const auto words = fields_of(line, ' ');
    if (words[0].starts_with('#')) units.take(line, name, body.line);
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (words[0] == "FIELDS") names.push_back(words[i]);
      if (words[0] == "TYPE") types.push_back(words[i]);
      if (words[0] == "SIZE") sizes.push_back(count_of(words[i]).value_or(0));
      if (words[0] == "COUNT") counts.push_back(count_of(words[i]).value_or(0));
      if (words[0] == "POINTS") block.rows = count_of(words[i]).value_or(0);
      if (words[0] == "DATA") data = words[i];
    }
  }
  if (counts.empty()) counts.assign(names.size(), 1);
  bool sound = !names.empty() && types.size() == names.size() && sizes.size() == names.size() &&
               counts.size() == names.size();
  for (std::size_t i = 0; sound && i < names.size(); ++i) {
    const Scalar type = {types[i] == "F" ? 'f' : types[i] == "I" ? 'i' : 'u', sizes[i]};
    sound = std::has_single_bit(type.bytes) && type.bytes <= 8 && counts[i] < 100'000 &&
            (type.kind != 'f' || type.bytes >= 4);
    const auto axis = counts[i] == 1 ? axis_named(names[i]) : std::nullopt;
    block.fields.push_back({type, counts[i], {}, axis});
  }
  if (!sound) {
    return body.fail(Code::kSyntax, "FIELDS, SIZE, TYPE and COUNT of the PCD head do not agree");
  }
  if (data != "ascii" && data != "binary") {
    return body.fail(Code::kSyntax, fmt::format("the PCD file has DATA {}; save it as ascii or "
                                                "binary",
                                                quoted_text(data)));
  }
  body.form = data == "ascii" ? Coding::kText : Coding::kLittle;
  TRY(auto out, take_points(body, block, "PCD"));
  TRY_DO(check_end(body, block.rows));
  out.units = std::move(units);
  return out;
}

/// Keeps each different vertex once, and three by three the triangles.
class Vertices {
 public:
  core::Result<void> add(const Body& body, const Eigen::Vector3d& vertex, Cloud& out) {
    // -0.0 and 0.0 are one place
    const std::array<double, 3> key = {vertex[0] + 0.0, vertex[1] + 0.0, vertex[2] + 0.0};
    const auto [known, is_new] = seen_.try_emplace(key, out.points.size());
    if (is_new) TRY_DO(keep_point(body, vertex, out.points.size(), out.points));
    triangle_[corners_++] = known->second;
    if (corners_ < 3) return {};
    out.triangles.push_back(triangle_);
    corners_ = 0;
    return {};
  }
  /// Whether every triangle has all of its corners.
  [[nodiscard]] bool whole() const { return corners_ == 0; }

 private:
  std::unordered_map<std::array<double, 3>, std::size_t, PlaceHash> seen_;
  std::array<std::size_t, 3> triangle_ = {};
  std::size_t corners_ = 0;  ///< Of the triangle so far.
};

constexpr std::size_t kStlHead = 84;
constexpr std::size_t kFacetBytes = 50;

core::Result<Cloud> read_binary_stl(std::string_view bytes, std::string_view name) {
  const Body body{bytes, name, Coding::kLittle};
  Cloud out;
  out.mesh = out.single = true;
  out.read = "STL, binary, vertices";
  const std::string_view head = bytes.substr(0, kStlHead - 4);
  out.units.take(head.substr(0, head.find('\0')), name, 1);
  Vertices vertices;
  if (3 * ((bytes.size() - kStlHead) / kFacetBytes) > kMostRows) {
    return core::fail(too_many_rows().at(std::string(name)));
  }
  for (std::size_t facet = kStlHead; facet < bytes.size(); facet += kFacetBytes) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* const at = bytes.data() + facet + 12 * (corner + 1);
      Eigen::Vector3d vertex;
      for (int k = 0; k < 3; ++k) vertex[k] = number_at(at + 4 * k, {'f', 4}, false);
      TRY_DO(vertices.add(body, vertex, out));
    }
  }
  return out;
}

core::Result<Cloud> read_text_stl(std::string_view bytes, std::string_view name) {
  Body body{bytes, name};
  Cloud out;
  out.mesh = true;
  out.read = "STL, text, vertices";
  Vertices vertices;
  bool ended = false;
  while (!body.rest.empty()) {
    ++body.line;
    const std::string_view line = take_line(body.rest);
    const auto words = fields_of(line, ' ');
    ended = words[0] == "endsolid" || (ended && filled_fields(words) == 0);
    if (words[0] == "solid") out.units.take(line.substr(line.find("solid") + 5), name, body.line);
    if (words[0] != "vertex") continue;
    Eigen::Vector3d vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto value = words.size() == 4 ? core::parse_number(words[k + 1]) : std::nullopt;
      if (!value) {
        return body.fail(Code::kSyntax, fmt::format("{} is no vertex of three numbers within 1e9",
                                                    quoted_text(line)));
      }
      vertex[static_cast<Eigen::Index>(k)] = *value;
    }
    TRY_DO(vertices.add(body, vertex, out));
    if (out.points.size() > kMostRows) {
      return core::fail(too_many_rows().at(std::string(name)));
    }
  }
  if (!ended || !vertices.whole()) {
    return body.fail(Code::kSyntax,
                     "the STL file ends without endsolid, or within a triangle: is "
                     "it cut off?");
  }
  return out;
}

}  // namespace

std::optional<core::Result<Cloud>> read_cloud(std::string_view bytes, std::string_view name) {
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n")) return read_ply(bytes, name);
  if (begins_pcd(bytes)) return read_pcd(bytes, name);
  // A binary STL file is known by its length: its head may begin with "solid", too.
  double facets = 0.0;
  if (bytes.size() > kStlHead) {
    facets = number_at(bytes.data() + kStlHead - 4, {'u', 4}, false);
    if (static_cast<double>(bytes.size()) == kStlHead + kFacetBytes * facets) {
      return read_binary_stl(bytes, name);
    }
  }
  if (bytes.starts_with("solid") && bytes.find("facet") < std::size_t{4096}) {
    return read_text_stl(bytes, name);
  }
  if (bytes.size() > kStlHead && (name.ends_with(".stl") || name.ends_with(".STL"))) {
    return core::fail(Code::kSyntax,
                      fmt::format("a binary STL file of {:.0f} triangles has {:.0f} bytes, the "
                                  "file has {}: is it cut off?",
                                  facets, kStlHead + kFacetBytes * facets, bytes.size()),
                      std::string(name));
  }
  return std::nullopt;
}

}  // namespace rondure::record
