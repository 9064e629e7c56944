#include "plans/checks/laboratory.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <boost/crc.hpp>

#include "core/encodings.h"
#include "plans/analyses/internal/series_file.h"
#include "plans/schema/findings.h"
#include "plans/schema/internal/table_reader.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

constexpr const char* kPointer = "/reports/laboratory";
constexpr std::uintmax_t kMostLogoBytes = 256 * 1024;  // it is in the journal and in every page

struct LaboratoryFile {
  std::string name;
  std::optional<std::string> address;
  std::optional<std::string> country;
  std::optional<std::string> contact;
  std::string logo;  ///< Empty: none.
};

template <class Visitor>
void describe(Visitor& v, LaboratoryFile& p) {
  v.text("name", p.name, {.required = true, .empty_allowed = false, .meaning = "Its name."});
  v.text("address", p.address, {.empty_allowed = false, .meaning = "Street and town."});
  v.text("country", p.country, {.empty_allowed = false, .meaning = "Where it is."});
  v.text("contact", p.contact, {.empty_allowed = false, .meaning = "Telephone or mail."});
  v.text("logo", p.logo, {.meaning = "A PNG or JPEG file, relative to the plan."});
}

/// A whole number of some bytes, the highest first.
std::size_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::size_t out = 0;
  for (const char byte : bytes.substr(at, count))
    out = out << 8U | static_cast<unsigned char>(byte);
  return out;
}

struct PictureSize {
  std::size_t width = 0;
  std::size_t height = 0;
};

/// The size of a PNG whose chunks are whole, from IHDR to IEND. Source: ISO/IEC 15948, 5 and 11.
std::optional<PictureSize> size_of_png(std::string_view bytes) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kAround = 12;  // length, name and check of a chunk
  constexpr std::size_t kHeader = 13;
  std::optional<PictureSize> out;
  bool has_data = false;
  std::size_t at = kSignature;
  while (at + kAround <= bytes.size()) {
    const std::size_t length = number_at(bytes, at, 4);
    if (length > bytes.size() - at - kAround) return std::nullopt;
    const std::string_view chunk = bytes.substr(at + 4, length + 4);
    boost::crc_32_type check;
    check.process_bytes(chunk.data(), chunk.size());
    if (check.checksum() != number_at(bytes, at + 8 + length, 4)) return std::nullopt;
    if (chunk.starts_with("IHDR") != (at == kSignature)) return std::nullopt;
    if (at == kSignature && length == kHeader)
      out = {number_at(chunk, 4, 4), number_at(chunk, 8, 4)};
    has_data = has_data || chunk.starts_with("IDAT");
    at += kAround + length;
    if (chunk.starts_with("IEND")) return has_data && at == bytes.size() ? out : std::nullopt;
  }
  return std::nullopt;
}

/// The size of a JPEG whose segments are whole up to its scan, and that has its end. Source: ITU-T
/// T.81, annex B.
std::optional<PictureSize> size_of_jpeg(std::string_view bytes) {
  constexpr std::size_t kEnd = 0xFFD9;
  if (bytes.size() < 4 || number_at(bytes, bytes.size() - 2, 2) != kEnd) return std::nullopt;
  std::optional<PictureSize> out;
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == '\xFF') {
    const std::size_t marker = number_at(bytes, at + 1, 1);
    const std::size_t length = number_at(bytes, at + 2, 2);
    if (length < 2 || length > bytes.size() - at - 2) return std::nullopt;
    if (marker == 0xDA) return out;
    const bool frame = marker >= 0xC0 && marker <= 0xC2;  // baseline, extended, progressive
    if (frame && length >= 8) out = {number_at(bytes, at + 7, 2), number_at(bytes, at + 5, 2)};
    at += 2 + length;
  }
  return std::nullopt;
}

core::Result<std::string> logo_of(const Plan& plan, const std::string& file) {
  constexpr std::size_t kMostPixels = 4000;  // of a side; a browser takes memory for all of them
  TRY(const std::string bytes, read_data_file(plan.folder / file, file, kMostLogoBytes));
  const auto refuse = [&](const std::string& why) {
    return core::fail(core::Code::kFile, fmt::format("the logo {} {}", in_quotes(file), why));
  };
  const bool png = bytes.starts_with("\x89PNG\r\n\x1a\n");
  const bool jpeg = number_at(bytes, 0, 3) == 0xFFD8FF;
  if (!png && !jpeg) return refuse("is neither a PNG nor a JPEG file");
  const auto size = png ? size_of_png(bytes) : size_of_jpeg(bytes);
  if (!size) {
    return refuse(
        fmt::format("is a damaged {} file; save the picture again", png ? "PNG" : "JPEG"));
  }
  if (std::min(size->width, size->height) == 0 ||
      std::max(size->width, size->height) > kMostPixels) {
    return refuse(fmt::format("has {} x {} pixels, a side may have 1 to {}; save it smaller",
                              size->width, size->height, kMostPixels));
  }
  return fmt::format("data:image/{};base64,{}", png ? "png" : "jpeg", core::base64(bytes));
}

core::Result<record::HeadSettings> read_laboratory(const Plan& plan) {
  const std::string& file = plan.reports.laboratory;
  TRY(const std::string text, read_data_file(plan.folder / file, file, kMaxPlanBytes));
  TRY(const JsonValue json, parse_json(text, file));
  LaboratoryFile found;
  Findings findings;
  TableReader reader(json, "", findings);
  describe(reader, found);
  reader.finish();
  if (const auto problems = findings.take(); !problems.empty()) {
    const core::Error& first = problems.front();
    return core::fail_with(first.code, "{}: {}: {}", in_quotes(file), first.where, first.what);
  }
  for (const auto& [key, value] :
       {std::pair("name", std::optional(found.name)), std::pair("address", found.address),
        std::pair("country", found.country), std::pair("contact", found.contact)}) {
    const auto fault = value ? fault_of_name(*value) : std::nullopt;
    if (!fault) continue;
    return core::fail_with(core::Code::kOutOfRange, "{}: /{}: {} {}", in_quotes(file), key,
                           in_quotes(*value), *fault);
  }
  record::HeadSettings out;
  out.laboratory = std::move(found.name);
  out.address = std::move(found.address);
  out.country = std::move(found.country);
  out.contact = std::move(found.contact);
  if (!found.logo.empty()) {
    TRY(out.logo, logo_of(plan, found.logo));
  }
  return out;
}

}  // namespace

core::Result<record::HeadSettings> laboratory_of(const Plan& plan) {
  if (plan.reports.laboratory.empty()) return record::HeadSettings();
  auto found = read_laboratory(plan);
  if (!found) {
    const core::Error& error = found.error();
    const bool placed = error.code == core::Code::kSyntax && !error.where.empty();
    return core::fail(error.code, placed ? error.where + ": " + error.what : error.what, kPointer);
  }
  return found;
}

}  // namespace rondure::plans
