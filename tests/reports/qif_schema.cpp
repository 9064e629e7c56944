#include "tests/reports/qif_schema.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/core/scratch.h"

namespace rondure::reports::testing {

namespace fs = std::filesystem;

namespace {

std::string head_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str().substr(0, 2000);
}

}  // namespace

void expect_valid_qif(const std::vector<std::string>& documents) {
  const fs::path schemas = fs::path(RONDURE_SOURCE_DIR) / ".." / "shared" / "qif";
  if (!fs::exists(schemas / "QIFApplications" / "QIFDocument.xsd")) {
    GTEST_SKIP() << "the QIF schemas are not there: " << schemas.string();
  }
  if (std::system("command -v xmllint >/dev/null") != 0) {
    GTEST_SKIP() << "xmllint is not installed (libxml2-utils)";
  }
  const test::Scratch folder;
  std::string files;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    const fs::path file = folder.path() / fmt::format("{}.qif", i);
    std::ofstream(file, std::ios::binary) << documents[i];
    files += " '" + file.string() + "'";
  }
  const std::string command = fmt::format(
      "XML_CATALOG_FILES='{0}/catalog.xml' xmllint --nonet --noout --huge "
      "--schema '{0}/QIFApplications/QIFDocument.xsd'{1} >'{2}/said' 2>&1",
      schemas.string(), files, folder.path().string());
  EXPECT_EQ(std::system(command.c_str()), 0) << head_of(folder / "said");
}

}  // namespace rondure::reports::testing
