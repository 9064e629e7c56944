// Tables of numbers with named columns.
#include "record/csv/internal/lines.h"
#include "record/csv/series.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rondure::record {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::array<WantedColumn, 3> kWanted = {{{"alpha_deg"}, {"H1_um"}, {"beta_deg", false}}};

core::Error series_refusal(std::string_view text, std::span<const ColumnName> names = {}) {
  const auto series = parse_series_csv(text, "probes.csv", kWanted, names);
  return series ? core::Error{core::Code::kInternal, "it was read", {}} : series.error();
}

TEST(SeriesCsv, ReadsColumnsInAnyOrderWithTheirUnits) {
  const auto series = parse_series_csv(
      "\xef\xbb\xbf# probes\r\nH1_um, alpha_deg\r\n 1.5,0\r\n\n-2e-3,+90\n", "p", kWanted);
  ASSERT_TRUE(series) << series.error().what;
  ASSERT_EQ(series->columns.size(), 2U);
  EXPECT_EQ(series->columns[0].name, "alpha_deg");
  EXPECT_EQ(series->columns[0].unit, "deg");
  EXPECT_EQ(series->columns[1].unit, "um");
  EXPECT_THAT(series->values, ElementsAre(0.0, 1.5, 90.0, -2e-3));
  EXPECT_EQ(series->rows(), 2U);
  EXPECT_THAT(*series->column("H1_um"), ElementsAre(1.5, -2e-3));
  EXPECT_FALSE(series->column("beta_deg"));
}

TEST(SeriesCsv, TakesNamesOfTheFileAndPassesOverTheRest) {
  const std::array<ColumnName, 2> names = {{{"alpha_deg", "C"}, {"H1_um", "gauge 1"}}};
  const auto series =
      parse_series_csv("t,C,gauge 1\nx,1,2\ny,3,4\n", "control.csv", kWanted, names);
  ASSERT_TRUE(series) << series.error().what;
  EXPECT_THAT(series->values, ElementsAre(1.0, 2.0, 3.0, 4.0));
  const std::array<ColumnName, 1> foreign = {{{"gamma_deg", "C"}}};
  EXPECT_EQ(series_refusal("C\n1\n", foreign).code, core::Code::kBadOption);
  std::array<ColumnName, 2> in_mm = {{{"alpha_deg", "C"}, {"H1_um", "H1_mm"}}};
  const core::Error unit = series_refusal("C,H1_mm\n1,2\n", in_mm);
  EXPECT_EQ(unit.code, core::Code::kWrongUnit);
  EXPECT_THAT(unit.what, HasSubstr("column \"H1_mm\" is read as H1_um, in um"));
  in_mm[1].converted = true;
  EXPECT_TRUE(parse_series_csv("C,H1_mm\n1,2\n", "p", kWanted, in_mm));
}

TEST(SeriesCsv, TakesTheTemperatureFromAColumnOrOnceFromAComment) {
  const auto column =
      parse_series_csv("alpha_deg,temperature_degC,H1_um\n0,20.1,1\n90,20.4,2\n", "p", kWanted);
  ASSERT_TRUE(column) << column.error().what;
  EXPECT_THAT(*column->column(kTemperatureColumn), ElementsAre(20.1, 20.4));
  EXPECT_EQ(column->columns.back().name, kTemperatureColumn);
  EXPECT_EQ(column->columns.back().unit, "degC");
  const auto once = parse_series_csv(
      "# probe amplifier 3\n# temperature_degC: 20.3\r\nalpha_deg,H1_um\n0,1\n90,2\n", "p",
      kWanted);
  ASSERT_TRUE(once) << once.error().what;
  EXPECT_THAT(*once->column(kTemperatureColumn), ElementsAre(20.3, 20.3));
  EXPECT_THAT(*once->column("H1_um"), ElementsAre(1.0, 2.0));
  // A column says more than a comment; a comment about the temperature states none.
  const auto both = parse_series_csv(
      "# temperature_degC = 35\nalpha_deg,H1_um,temperature_degC\n0,1,20\n", "p", kWanted);
  ASSERT_TRUE(both) << both.error().what;
  EXPECT_THAT(both->values, ElementsAre(0.0, 1.0, 20.0));
  const auto none =
      parse_series_csv("# see temperature_degC in the log\nalpha_deg,H1_um\n0,1\n", "p", kWanted);
  ASSERT_TRUE(none) << none.error().what;
  EXPECT_FALSE(none->column(kTemperatureColumn));
  const core::Error warm = series_refusal("# \n# temperature_degC: warm\nalpha_deg,H1_um\n0,1\n");
  EXPECT_EQ(warm.where, "probes.csv:2");
  EXPECT_EQ(warm.what, "temperature_degC is \"warm\"; a number is expected");
  const std::array<ColumnName, 3> names = {
      {{"alpha_deg", "C"}, {"H1_um", "gauge 1"}, {"temperature_degC", "T part"}}};
  const auto renamed = parse_series_csv("C,gauge 1,T part\n1,2,20.2\n", "p", kWanted, names);
  ASSERT_TRUE(renamed) << renamed.error().what;
  EXPECT_THAT(*renamed->column(kTemperatureColumn), ElementsAre(20.2));
}

TEST(SeriesCsv, RefusesWhatIsNotSuchATable) {
  using core::Code;
  const core::Error unit = series_refusal("alpha_rad,H1_um\n0,1\n");
  EXPECT_EQ(unit.code, Code::kWrongUnit);
  EXPECT_EQ(unit.where, "probes.csv:1");
  EXPECT_THAT(unit.what, HasSubstr("\"alpha_rad\" is not in deg; give alpha_deg"));
  EXPECT_THAT(series_refusal("alpha_deg,H9_um\n0,1\n").what,
              HasSubstr("column \"H9_um\" is unknown"));
  EXPECT_THAT(series_refusal("alpha_deg\n0\n").what, HasSubstr("column \"H1_um\" is missing"));
  EXPECT_THAT(series_refusal("alpha_deg,H1_um,H1_um\n0,1,1\n").what, HasSubstr("stands twice"));
  const core::Error empty = series_refusal("alpha_deg,H1_um\n0,1\n1,\n");
  EXPECT_EQ(empty.where, "probes.csv:3");
  EXPECT_THAT(empty.what, HasSubstr("H1_um is empty"));
  EXPECT_EQ(series_refusal("alpha_deg,H1_um\n0,nan\n").code, Code::kNotFinite);
  const core::Error huge = series_refusal("alpha_deg,H1_um\n0,1\n0,1e155\n");
  EXPECT_EQ(huge.code, Code::kOutOfRange);
  EXPECT_EQ(huge.where, "probes.csv:3");
  EXPECT_THAT(huge.what, HasSubstr("H1_um is 1e155 um, beyond the limit of 1e+09 um"));
  EXPECT_THAT(series_refusal("alpha_deg,H1_um\n0,1,2\n").what, HasSubstr("3 fields"));
  EXPECT_THAT(series_refusal("alpha_deg;H1_um\n0;1\n").what, HasSubstr("semicolons"));
  EXPECT_EQ(series_refusal("alpha_deg,H1_um\n").code, Code::kNoPoints);
  EXPECT_EQ(series_refusal("").code, Code::kNoPoints);
}

TEST(SeriesCsv, KnowsTheUnitAtTheEndOfAName) {
  EXPECT_EQ(unit_of_column("H1_um"), "um");
  EXPECT_EQ(unit_of_column("X"), "");
  EXPECT_EQ(unit_of_column("X_error"), "");
  EXPECT_EQ(unit_of_column("_um"), "");
}

}  // namespace
}  // namespace rondure::record
