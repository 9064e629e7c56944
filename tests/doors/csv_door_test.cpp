// Damaged tables of every kind, through every reader of tables.

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record/csv/balls.h"
#include "record/csv/series.h"
#include "record/points/points.h"
#include "tests/app/files.h"
#include "tests/doors/exact.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/wrong_text.h"

namespace rondure::doors {
namespace {

/// Good tables: those of the analyses, points of several features in layers, and readings with the
/// temperature in a comment.
const std::vector<std::string>& good_tables() {
  static const std::vector<std::string> tables = [] {
    std::vector<std::string> out;
    for (const auto* some :
         {&fuzz::point_tables(), &fuzz::ball_tables(), &fuzz::spindle_tables(),
          &fuzz::roundness_tables(), &fuzz::wheel_tables(), &fuzz::contour_tables()}) {
      for (const std::string& table : *some) out.push_back(table.substr(0, 3000));
    }
    const auto shaft = app::testing::read(app::testing::example("15_shaft.csv"));
    out.push_back(shaft.substr(0, shaft.find('\n', 3000) + 1));
    out.emplace_back("\xef\xbb\xbf# temperature_degC: 20.3\r\n\r\nalpha_deg , H1_um\r\n0,1\r\n");
    using namespace std::string_literals;
    out.emplace_back(
        "Teil;7\r\nPunkt;X-Ist [mm];Y-Ist [mm];Z-Ist [mm];\xb5\r\n1;52,68;-17;1,0;a\r\n");
    out.emplace_back("\xff\xfeX\0\t\0Y\0\n\0001\0,\0005\0\t\0002\0\n\0"s);
    out.emplace_back(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double "
        "y\nproperty double z\nend_header\n1 2 3\n");
    out.emplace_back(
        "ply\nformat binary_big_endian 1.0\nelement a 1\nproperty list uchar short b\n"
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n\1\0\0\x41\0\0\0\x41\0\0\0\x41\0\0\0"s);
    out.emplace_back(
        "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA binary\n"
        "\0\0\x20\x41\0\0\x20\x41\0\0\x20\x41"s);
    out.emplace_back(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 5 6\nvertex 7 "
        "8 9\nendloop\nendfacet\nendsolid a\n");
    out.emplace_back("UNITS/MM,ANGDEC\nFILNAM/'A'\nFA(P)=FEAT/POINT,CART,1,$\n2,3\n");
    out.emplace_back("C: 00021 PtMeas(X(1))\nS: 00021 # X(1), Y(2), Z(3)\n");
    out.emplace_back(
        "<QIFDocument><MeasuredPointSet><Points>1 2 3 4 5 6</Points>"
        "</MeasuredPointSet></QIFDocument>");
    out.emplace_back("//X Y Z I\n2\n1.5 2.5 3.5 4\n5 6 7 8\n");
    out.emplace_back("x,y,z,layer,feature\n1,2,3,0,bore\n 1, 2,4,1,bore\n1,1e2,3,0,journal\n");
    return out;
  }();
  return tables;
}

template <class Table>
std::string wrong_with(const core::Result<Table>& read) {
  return read ? std::string() : fuzz::wrong_with_refusal(read.error());
}

std::string wrong_with_series(std::string_view text) {
  using record::WantedColumn;
  const std::array<std::vector<WantedColumn>, 4> wanted = {
      {{{"alpha_deg"}, {"H1_um"}, {"H2_um", false}, {"H3_um", false}},
       {{"x"}, {"z"}, {"depth_um", false}},
       {{"c_deg"}, {"c_error_deg"}, {"x_error_mm"}, {"d_cmd_mm", false}},
       {{"angle_deg"}, {"deviation_um"}}}};
  const std::vector<record::ColumnName> names = {{"alpha_deg", "angle_deg"}, {"x", "x_mm"}};
  for (const auto& columns : wanted) {
    for (const bool named : {false, true}) {
      const auto read = record::parse_series_csv(text, "table.csv", columns,
                                                 named ? std::span<const record::ColumnName>(names)
                                                       : std::span<const record::ColumnName>());
      if (!read) {
        if (auto wrong = fuzz::wrong_with_refusal(read.error()); !wrong.empty()) return wrong;
      } else if (read->values.size() != read->rows() * read->columns.size() || read->rows() == 0) {
        return "values that do not fill the columns";
      }
    }
  }
  return {};
}

/// Every reader on one text; "" or the fault of the first that has one.
std::string wrong_with_table(const std::string& text) {
  const Exact exact(text);
  for (const auto& wrong :
       {wrong_with(record::read_points(exact.view(), "table.csv")),
        wrong_with(
            record::read_points(exact.view(), "a.stl", {"", {}, {}, record::LayersFrom::kHeights})),
        wrong_with(record::read_points(exact.view(), "a.csv", {"", {"2", "1", "y"}})),
        wrong_with(record::read_points(exact.view(), "table.xyz", {"bore"})),
        wrong_with(record::read_profile(exact.view(), "table.csv")),
        wrong_with(record::parse_ball_csv(exact.view(), "table.csv")),
        wrong_with_series(exact.view())}) {
    if (!wrong.empty()) return wrong;
  }
  return {};
}

TEST(CsvDoor, StandsDamagedBytes) {
  const fuzz::Mutation mutation(good_tables(), fuzz::table_words());
  fuzz::try_cases({6'000}, [&](unsigned seed) { return wrong_with_table(mutation.input(seed)); });
}

TEST(CsvDoor, StandsDamagedTables) {
  const fuzz::TableMutation mutation(good_tables());
  fuzz::try_cases({6'000}, [&](unsigned seed) { return wrong_with_table(mutation.input(seed)); });
}

TEST(CsvDoor, StandsTablesThatEndTooEarly) {
  for (const std::string& text : good_tables()) {
    // All of the header, then some.
    const std::string head = text.substr(0, 60);
    for (std::size_t size = 0; size <= head.size(); ++size) {
      ASSERT_EQ(wrong_with_table(head.substr(0, size)), "") << head.substr(0, size);
    }
    for (const std::size_t size : cuts_of(text.size(), 4)) {
      for (const std::string_view half : half_words()) {
        const std::string cut = text.substr(0, size).append(half);
        ASSERT_EQ(wrong_with_table(cut), "") << cut;
      }
    }
  }
}

}  // namespace
}  // namespace rondure::doors
