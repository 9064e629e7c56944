#include "plans/checks/laboratory.h"

#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base64.h"
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

core::Result<std::string> logo_of(const Plan& plan, const std::string& file) {
  TRY(const std::string bytes, read_data_file(plan.folder / file, file, kMostLogoBytes));
  const bool png = bytes.starts_with("\x89PNG\r\n");
  if (!png && !bytes.starts_with("\xFF\xD8\xFF")) {
    return core::fail_with(core::Code::kFile, "the logo {} is neither a PNG nor a JPEG file",
                           in_quotes(file));
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
