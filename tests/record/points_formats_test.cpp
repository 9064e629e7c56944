// Points files that are no text tables. The bytes are made here, by other code than that which
// reads them.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/points/points.h"

namespace rondure::record {
namespace {

using ::testing::HasSubstr;

const std::vector<Eigen::Vector3d>& expected() {
  static const std::vector<Eigen::Vector3d> points = {
      {52.683941, -17.491, 101.0}, {46.431122, -6.667203, 101.0}, {33.931813, -6.665358, 107.5}};
  return points;
}

template <class Number>
std::string bytes_of(Number number, bool big) {
  std::string out(sizeof(number), '\0');
  std::memcpy(out.data(), &number, sizeof(number));
  return big == (std::endian::native == std::endian::big) ? out
                                                          : std::string(out.rbegin(), out.rend());
}

template <class Number>
std::string places(bool big) {
  std::string out;
  for (const auto& p : expected()) {
    out += bytes_of(std::uint8_t{7}, big);  // a colour before x
    for (int k = 0; k < 3; ++k) out += bytes_of(static_cast<Number>(p[k]), big);
  }
  return out;
}

std::string ply(std::string_view format, std::string_view type, const std::string& body,
                int faces = 0) {
  std::string out = fmt::format(
      "ply\nformat {} 1.0\ncomment made here\nCreated by hand\nelement box 1\nproperty list uchar "
      "short "
      "sides\nelement vertex 3\nproperty uchar red\n",
      format);
  for (const char axis : {'x', 'y', 'z'}) out += fmt::format("property {} {}\n", type, axis);
  out +=
      fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", faces);
  return out + body;
}

std::string binary_ply(bool big, bool single, int faces = 0) {
  const std::string box = bytes_of(std::uint8_t{2}, big) + bytes_of(std::int16_t{-5}, big) +
                          bytes_of(std::int16_t{6}, big);
  return ply(big ? "binary_big_endian" : "binary_little_endian", single ? "float" : "double",
             box + (single ? places<float>(big) : places<double>(big)), faces);
}

std::string text_ply() {
  return ply("ascii", "double",
             "2 -5 6\n7 52.683941 -17.491 101.0\n7 46.431122 -6.667203 101.0\n"
             "7 33.931813 -6.665358 107.5\n");
}

/// Two triangles that share two corners, the second after the first.
std::string stl(bool text) {
  const auto& p = expected();
  const std::vector<Eigen::Vector3d> corners = {p[0], p[1], p[2], p[2], p[1], p[0]};
  std::string out = text ? std::string("solid made here\n") : std::string("solid").append(75, ' ');
  if (!text) out += bytes_of(std::uint32_t{2}, false);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) {
      out += text ? " facet normal 0 0 1\n  outer loop\n" : std::string(12, '\0');
    }
    out += text ? fmt::format("   vertex {} {} {}\n", corners[i][0], corners[i][1], corners[i][2])
                : "";
    for (int k = 0; k < 3 && !text; ++k) out += bytes_of(static_cast<float>(corners[i][k]), false);
    if (i % 3 == 2) out += text ? "  endloop\n endfacet\n" : std::string(2, '\0');
  }
  return out + (text ? "endsolid made here\n" : "");
}

std::string pcd(bool text) {
  std::string out =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS rgb x y z\nSIZE 1 8 8 8\nTYPE U F F F\n"
      "COUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\n";
  if (!text) return out + "DATA binary\n" + places<double>(false);
  return out +
         "DATA ascii\n7 52.683941 -17.491 101\n7 46.431122 -6.667203 101\n"
         "7 33.931813 -6.665358 107.5\n";
}

const std::string kDmis =
    "FILNAM/'OUTPUT',05.2\r\nUNITS/MM,ANGDEC\r\n$$ F(P0)=FEAT/POINT,CART,1,2,3,0,0,1\r\n"
    "F(P1)=FEAT/POINT,CART,52.7,-17.5,101,0,0,1\r\n"
    "FA(P1)=FEAT/POINT,CART,52.683941,-17.491,$\r\n101.0,0,0,1\r\n"
    "FA(ZYL1)=FEAT/CYLNDR,OUTER,CART,40.2,-17.5,110,0,0,1,25\r\n"
    "fa(p2)=feat/point,cart,46.431122,-6.667203,101.0,0,0,1\r\n"
    "RAWDAT/CART,33.931813,-6.665358,107.5,0,0,1\r\nENDFIL\r\n";
const std::string kLog =
    "C: 00021 PtMeas(X(52.7), Y(-17), Z(101), IJK(1,0,0))\nS: 00021 &\n"
    "S: 00021 # ER(3.0), IJK(0,0,1), X(52.683941), Y(-17.491), Z(101.0)\nS: 00021 %\n"
    "C: 00022 Get(X(),Y(),Z())\nS: 00022 # X(1.0), Y(2.0), Z(3.0)\n"
    "C: 00023 PtMeas(X(46), Y(-6), Z(101))\nS: 00023 # X(46.431122), Y(-6.667203), Z(101.0)\n"
    "C: 00024 PtMeas(X(33), Y(-6), Z(107))\nS: 00024 # X(33.931813), Y(-6.665358), Z(107.5)\n";
const std::string kQif =
    "<?xml version=\"1.0\"?><QIFDocument><FileUnits><PrimaryUnits><LinearUnit><UnitName>mm"
    "</UnitName></LinearUnit></PrimaryUnits></FileUnits><MeasuredPointSets n=\"1\">"
    "<MeasuredPointSet id=\"28\" count=\"3\"><Points>52.683941 -17.491 101\n46.431122 -6.667203 "
    "101 33.931813 -6.665358 107.5</Points><Compensated>true</Compensated></MeasuredPointSet>"
    "</MeasuredPointSets></QIFDocument>";

struct FormatFile {
  const char* name;
  std::string bytes;
  double step_mm;  ///< Of the numbers in the file.
  const char* read;
};

std::vector<FormatFile> good_files() {
  const double single = 4e-6;
  return {{"a.ply", text_ply(), 0.0, "PLY, text, x y z in mm (not stated); 3 points"},
          {"a.ply", binary_ply(false, false), 0.0, "PLY, little endian, x y z in mm"},
          {"a.ply", binary_ply(true, false), 0.0, "PLY, big endian, x y z in mm"},
          {"a.ply", binary_ply(true, true), single, "PLY, big endian, x y z, stored with 32 bits"},
          {"a.stl", stl(true), 0.0, "STL, text, vertices of a mesh in mm"},
          {"a.stl", stl(false), single, "STL, binary, vertices of a mesh, stored with 32 bits"},
          {"a.pcd", pcd(true), 0.0, "PCD, text, x y z in mm"},
          {"a.pcd", pcd(false), 0.0, "PCD, little endian, x y z in mm"},
          {"a.pcd", "# of a scanner\r\n\n" + pcd(true).substr(12), 0.0, "PCD, text, x y z in mm"},
          {"a.pcd", pcd(false).substr(12), 0.0, "PCD, little endian, x y z in mm"},
          {"a.dmo", kDmis, 0.0, "DMIS, x y z of points in mm; 3 points"},
          {"wire.log", kLog, 0.0, "I++ DME log, answers to PtMeas in mm"},
          {"a.qif", kQif, 0.0, "QIF, compensated points in mm; 3 points"}};
}

TEST(PointsFormats, GiveThePointsAndSayWhatWasRead) {
  for (const FormatFile& c : good_files()) {
    SCOPED_TRACE(c.read);
    const auto table = read_points(c.bytes, c.name);
    ASSERT_TRUE(table) << core::to_line(table.error());
    EXPECT_THAT(table->read, HasSubstr(c.read));
    EXPECT_EQ(table->mesh, std::string(c.name) == "a.stl");
    ASSERT_EQ(table->points_mm.size(), expected().size());
    for (std::size_t i = 0; i < expected().size(); ++i) {
      EXPECT_LE((table->points_mm[i] - expected()[i]).cwiseAbs().maxCoeff(), c.step_mm) << i;
    }
  }
}

TEST(PointsFormats, GiveAllPointsOrNoneOfAFileThatIsCutOff) {
  for (const FormatFile& c : good_files()) {
    const bool counted = std::string(c.name) != "a.dmo" && std::string(c.name) != "wire.log";
    for (std::size_t size = 0; size < c.bytes.size(); ++size) {
      const auto table = read_points(std::string_view(c.bytes).substr(0, size), c.name);
      if (!table || !counted) continue;
      SCOPED_TRACE(fmt::format("{}: {} bytes of {}", c.read, size, c.bytes.size()));
      EXPECT_EQ(table->points_mm.size(), expected().size());
    }
  }
}

TEST(PointsFormats, RefuseMorePointsThanTheirHeadAnnounces) {
  int seen = 0;
  for (const FormatFile& c : good_files()) {
    const std::string name = c.name;
    if (!name.ends_with(".ply") && !name.ends_with(".pcd")) continue;
    SCOPED_TRACE(c.read);
    ++seen;
    const auto table = read_points(c.bytes + "\n7 8 9\n", c.name);
    ASSERT_FALSE(table);
    EXPECT_THAT(table.error().what, HasSubstr("the head announces 3 points, and more follow"));
    EXPECT_TRUE(read_points(c.bytes + "\n\n", c.name));
  }
  EXPECT_GE(seen, 4);
}

TEST(PointsFormats, LeaveOutFewRowsOfNanAndSaySo) {
  const auto cloud = [](int rows, bool text) {
    std::string out =
        fmt::format("# .PCD v.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS {}\nDATA {}\n",
                    rows + 1, text ? "ascii" : "binary");
    for (int k = 0; k <= rows; ++k) {
      const float x = k == 7 ? std::nanf("") : static_cast<float>(k);
      out += text ? fmt::format("{} 2 3\n", x)
                  : bytes_of(x, false) + bytes_of(2.0F, false) + bytes_of(3.0F, false);
    }
    return out;
  };
  for (const bool text : {false, true}) {
    const auto table = read_points(cloud(99, text), "a.pcd");
    ASSERT_TRUE(table) << core::to_line(table.error());
    EXPECT_EQ(table->points_mm.size(), 99);
    EXPECT_THAT(table->read, HasSubstr("1 row without values left out"));
    EXPECT_THAT(read_points(cloud(98, text), "a.pcd").error().what,
                HasSubstr("x of point 8 is no"));
  }
}

TEST(PointsFormats, AUnitInDoubtInTheHeadIsRefusedUntilItIsGiven) {
  const auto ply = [](std::string_view comment) {
    return fmt::format(
        "ply\nformat ascii 1.0\n{}element vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n1 2 3\n4 5 6\n",
        comment);
  };
  const auto pcd = [](std::string_view comment) {
    return fmt::format(
        "# .PCD v.7\n{}VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\n"
        "POINTS 2\nDATA ascii\n1 2 3\n4 5 6\n",
        comment);
  };
  const std::string_view unclear = "inch\" seems to state a unit";
  const std::array files = {std::tuple(ply("comment all in inch\n"), "a.ply", unclear),
                            std::tuple(ply("comment unit mm\ncomment unit inch\n"), "a.ply",
                                       std::string_view("says mm and inch")),
                            std::tuple(pcd("# all in inch\n"), "a.pcd", unclear)};
  for (const auto& [bytes, name, what] : files) {
    SCOPED_TRACE(bytes);
    const auto refused = read_points(bytes, name);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kUnits);
    EXPECT_THAT(refused.error().what, HasSubstr(std::string(what)));
    EXPECT_TRUE(read_points(bytes, name, {.feature = "", .unit = LengthUnit::kMm}));
  }
  std::string binary = stl(false);
  binary.replace(0, 20, "units: inches       ");
  EXPECT_EQ(read_points(binary, "a.stl")->points_mm.at(0)[2], 101.0 * 25.4);
  std::string text = stl(true);
  text.replace(6, 9, "all inch ");
  EXPECT_FALSE(read_points(text, "a.stl"));
  EXPECT_EQ(read_points(pcd("# units: inch\n"), "a.pcd")->points_mm.at(0)[0], 25.4);
  EXPECT_EQ(read_points(ply("comment all in inch\ncomment unit mm\n"), "a.ply")->points_mm.at(0)[0],
            1.0);
}

TEST(PointsFormats, WithoutOneUnitAreRefused) {
  const auto replaced = [](std::string text, const std::string& old, std::string_view by) {
    return text.replace(text.find(old), old.size(), by);
  };
  const std::string unit_name = "<UnitName>mm</UnitName>";
  const auto with_factor = [](std::string_view unit) {
    return fmt::format("<UnitName>{}</UnitName><Factor>0.0254</Factor>", unit);
  };
  const std::array files = {
      std::pair(replaced(kDmis, "UNITS/MM", "$$"), "states no UNITS of its points: give --unit"),
      std::pair(replaced(kDmis, "UNITS/MM", "UNITS/FEET"), "says \"UNITS/FEET,ANGDEC\": give"),
      std::pair(replaced(kDmis, "RAWDAT", "UNITS/INCH\r\nRAWDAT"), "changes from mm to inch"),
      std::pair(replaced(kQif, unit_name, ""), "states no unit of length: give --unit"),
      std::pair(replaced(kQif, unit_name, with_factor("mm")), "says mm and inch")};
  for (const auto& [bytes, what] : files) {
    SCOPED_TRACE(what);
    const auto refused = read_points(bytes, "a.dmo");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kUnits);
    EXPECT_THAT(refused.error().what, HasSubstr(what));
  }
  EXPECT_TRUE(read_points(files[0].first, "a.dmo", {.feature = "", .unit = LengthUnit::kMm}));
  const auto inches = replaced(kQif, unit_name, with_factor("in_us"));
  EXPECT_EQ(read_points(inches, "a.qif")->points_mm.at(0)[2], 101.0 * 25.4);
}

TEST(PointsFormats, AMeshIsSaidToBeOne) {
  const auto faces =
      read_points(binary_ply(false, false, 1) + bytes_of(std::uint8_t{0}, false), "a.ply");
  ASSERT_TRUE(faces) << core::to_line(faces.error());
  EXPECT_TRUE(faces->mesh);
  EXPECT_FALSE(read_points(binary_ply(false, false), "a.ply")->mesh);
}

TEST(PointsFormats, RefuseWhatHoldsNoPointsByName) {
  struct Bad {
    std::string bytes;
    const char* what;
  };
  const std::string results =
      "FILNAM/'OUTPUT',05.2\r\nUNITS/MM,ANGDEC\r\nFA(Z)=FEAT/CYLNDR,OUTER,CART,40.2,-17,110,0,$\r\n"
      "0,1,24.99,18.0\r\nTA(C)=TOL/CYLCTY,0.004731,INTOL\r\nENDFIL\r\n";
  std::string many = binary_ply(false, false);
  many.replace(many.find("vertex 3"), 8, "vertex 18000000");
  std::string nan = binary_ply(false, true);
  nan.replace(nan.size() - 4, 4, bytes_of(std::uint32_t{0x7FC00000}, false));
  std::string longer = stl(false);
  longer.pop_back();
  const std::vector<Bad> files = {
      {"planid\tpartnb\tid\ttype\tidsymbol\tactual\r\ntube\t7\tZ\tCyl\tgdtCylinder\t0.0047\r\n",
       "a table of CALYPSO holds results, not points: export the points"},
      {results, "holds results or targets, not points: export the points"},
      {"<QIFDocument><Results/></QIFDocument>", "holds results and no points: export the points"},
      {"PK\x03\x04workbook", "save the sheet as CSV"},
      {"ASTM-E57....", "convert it to PLY"},
      {"ISO-10303-21;\nHEADER;\n", "a STEP model"},
      {"\x89PNG\r\n", "an image; export the points"},
      {"\x93NUMPY\x01", "an array of NumPy; save it by savetxt"},
      {"LASF", "a LAS scan; convert it to PLY"},
      {"\xef\xbb\xbf[\n {\"x\": 1.5}]", "a JSON document; export the points as a text table"},
      {"<!DOCTYPE html>\n<table>", "an HTML page; save the sheet as CSV"},
      {"  0\r\nSECTION\r\n", "a DXF drawing"},
      {"A = HEADER / 2\nP1 = POINT / 1.5, 2, 3\n", "a VDA model"},
      {"points" + std::string(66, ' ') + "S      1\n", "an IGES model"},
      {"2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n",
       "a PTX scan; convert it to PLY"},
      {many, "the head announces 18000000 points, the file ends before that"},
      {nan, "z of point 3 is no number within 1e9"},
      {longer, "a binary STL file of 2 triangles has 184 bytes, the file has 183"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nend_header\n1\n",
       "the points need x, y and z"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n1\n",
       "\"property real x\" is no line of a PLY head"},
      {"# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA binary_compressed\n",
       "save it as ascii or binary"},
  };
  for (const Bad& bad : files) {
    SCOPED_TRACE(bad.what);
    const bool stl = bad.bytes == longer;
    const auto table = read_points(bad.bytes, stl ? "export.stl" : "export.dat");
    ASSERT_FALSE(table);
    EXPECT_THAT(table.error().what, HasSubstr(bad.what));
    EXPECT_THAT(table.error().where, ::testing::StartsWith("export."));
  }
}

}  // namespace
}  // namespace rondure::record
