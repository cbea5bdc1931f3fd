// GDSII record by record: the bytes that are written, by hand from its definition, and what is said
// of records that no layout of ours has.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/drawing.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::gds_records_test {
namespace {

using namespace std::string_literals;

std::string big(long value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out += static_cast<char>(value >> (8 * i) & 0xff);
  return out;
}
std::string shorts(const std::vector<long>& values) {
  std::string out;
  for (const long v : values) out += big(v, 2);
  return out;
}
std::string longs(const std::vector<long>& values) {
  std::string out;
  for (const long v : values) out += big(v, 4);
  return out;
}
std::string record(long type, const std::string& data = "") {
  return big(static_cast<long>(data.size()) + 4, 2) + big(type, 2) + data;
}

const std::string kDate = shorts({2025, 1, 1, 0, 0, 0, 2025, 1, 1, 0, 0, 0});
// 1e-3 is 0.256 / 16^2 and 1e-9 is 0.26844 / 16^7: exponents of 62 and 57, mantissas of 56 bits.
const std::string kUnits = record(0x0305,
                                  "\x3e\x41\x89\x37\x4b\xc6\xa7\xf0"
                                  "\x39\x44\xb8\x2f\xa0\x9b\x5a\x54"s);
const std::string kHead =
    record(0x0002, shorts({600})) + record(0x0102, kDate) + record(0x0206, "PAPILLA\0"s) + kUnits;

std::string cell(const std::string& name, const std::string& elements) {
  return record(0x0502, kDate) + record(0x0606, name) + elements + record(0x0700);
}
const std::string kEnd = record(0x0400);

const std::string kTriangle =
    record(0x0800) + record(0x0D02, shorts({3})) + record(0x0E02, shorts({0})) +
    record(0x1003, longs({0, 0, 70000, -5, -2, 300, 0, 0})) + record(0x1100);

Layout example() {
  Layout out;
  out.cells.push_back({"CELL", {{3, {{0, 70000, -2}, {0, -5, 300}}}}, {}});
  out.cells.push_back({"ODD", {}, {{.cell = "CELL", .x = -7, .y = 9}}});
  out.cells.push_back({"TOP",
                       {},
                       {{.cell = "ODD",
                         .x = 11,
                         .y = -13,
                         .columns = 300,
                         .rows = 2,
                         .step_x = 1000,
                         .step_y = 500,
                         .array = true}}});
  return out;
}

TEST(GdsRecords, StandInTheBytesOfTheirDefinition) {
  const std::string path = temporary("records.gds");
  write_gds(path, example());
  EXPECT_EQ(read_bytes(path),
            kHead + cell("CELL", kTriangle) +
                cell("ODD\0"s, record(0x0A00) + record(0x1206, "CELL") +
                                   record(0x1003, longs({-7, 9})) + record(0x1100)) +
                cell("TOP\0"s,
                     record(0x0B00) + record(0x1206, "ODD\0"s) + record(0x1302, shorts({300, 2})) +
                         record(0x1003, longs({11, -13, 11 + 300000, -13, 11, -13 + 1000})) +
                         record(0x1100)) +
                kEnd);
  const Layout back = read_gds(path), was = example();
  ASSERT_EQ(back.cells.size(), 3u);
  EXPECT_EQ(back.cells[0].polygons, was.cells[0].polygons);
  const LayoutReference &one = back.cells[1].references.at(0),
                        &all = back.cells[2].references.at(0);
  EXPECT_EQ(std::tuple(one.cell, one.x, one.y, one.array), std::tuple("CELL", -7, 9, false));
  EXPECT_EQ(std::tuple(one.columns, one.rows), std::tuple(1, 1));
  EXPECT_EQ(std::tuple(all.cell, all.x, all.y, all.array), std::tuple("ODD", 11, -13, true));
  EXPECT_EQ(std::tuple(all.columns, all.rows, all.step_x, all.step_y),
            std::tuple(300, 2, 1000, 500));
}

// One record holds 32767 columns and rows: what is more stands in further ones, beside the first.
// They are one array again when they are read.
TEST(GdsRecords, OfMoreThan32767CellsASideAreWrittenInPartsAndReadAsOneArray) {
  const std::string path = temporary("many.gds");
  const auto part = [](long x, long y, long columns, long rows) {
    const long left = 11 + x, low = -13 + y;
    return record(0x0B00) + record(0x1206, "ODD\0"s) + record(0x1302, shorts({columns, rows})) +
           record(0x1003, longs({left, low, left + 2 * columns, low, left, low + 3 * rows})) +
           record(0x1100);
  };
  const auto expect_parts = [&](long columns, long rows, const std::string& parts) {
    Layout layout = example();
    LayoutReference& r = layout.cells.back().references[0];
    r.columns = columns, r.rows = rows;
    r.step_x = 2, r.step_y = 3;
    write_gds(path, layout);
    EXPECT_TRUE(read_bytes(path).ends_with(cell("TOP\0"s, parts) + kEnd)) << columns;
    const std::vector<LayoutReference> back = read_gds(path).cells.back().references;
    ASSERT_EQ(back.size(), 1u) << columns;
    EXPECT_EQ(std::tuple(back[0].x, back[0].y, back[0].columns, back[0].rows),
              std::tuple(r.x, r.y, columns, rows));
    EXPECT_EQ(std::tuple(back[0].step_x, back[0].step_y), std::tuple(2, 3));
  };
  expect_parts(32767, 32767, part(0, 0, 32767, 32767));
  expect_parts(32768, 3, part(0, 0, 32767, 3) + part(65534, 0, 1, 3));
  expect_parts(40000, 70000,
               part(0, 0, 32767, 32767) + part(65534, 0, 7233, 32767) +
                   part(0, 98301, 32767, 32767) + part(65534, 98301, 7233, 32767) +
                   part(0, 196602, 32767, 4466) + part(65534, 196602, 7233, 4466));
  // Arrays beside each other of which the first is not full, or the second of another pitch, are
  // two.
  const LayoutReference full{
      .cell = "CELL", .columns = 32767, .rows = 2, .step_x = 2, .step_y = 3, .array = true};
  LayoutReference beside = full;
  beside.x = 65534, beside.step_x = 4;
  Layout two = example();
  two.cells.back().references = {full, beside};
  write_gds(path, two);
  EXPECT_EQ(read_gds(path).cells.back().references.size(), 2u);
  LayoutReference fewer = full;
  fewer.columns = 5, beside = fewer, beside.x = 10;
  two.cells.back().references = {fewer, beside};
  write_gds(path, two);
  EXPECT_EQ(read_gds(path).cells.back().references.size(), 2u);
}

// What the reader says, without the name of the file; "": it reads them.
std::string said(const std::string& bytes) {
  const std::string path = temporary("said.gds");
  write_bytes(path, bytes);
  try {
    read_gds(path);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(("cannot read " + path + ": ").size());
  }
  return "";
}

TEST(GdsRecords, ThatNoLayoutOfOursHasAreNamed) {
  const std::string drawn = cell("CELL", kTriangle);
  EXPECT_EQ(said(kHead + drawn + kEnd), "");
  EXPECT_EQ(said(kHead + drawn + kEnd + "anything"), "");  // after its end
  EXPECT_EQ(said(drawn + kEnd), "no GDSII file");
  EXPECT_EQ(said(kHead + kEnd), "no cell");
  EXPECT_EQ(said(record(0x0002, shorts({600})) + drawn + kEnd), "no database unit");
  EXPECT_EQ(said(kHead + drawn + drawn + kEnd), "two cells \"CELL\"");
  EXPECT_EQ(said(kHead + record(0x2202, shorts({1})) + drawn + kEnd),
            "a record 0x2202 that no layout of ours has");
  EXPECT_EQ(said(kHead + cell("CELL", record(0x0900)) + kEnd),
            "a record 0x0900 that no layout of ours has");
  EXPECT_EQ(said(kHead + record(0x0502, kDate) + kTriangle), "a record 0x0800 where 0x0606 is due");
  EXPECT_EQ(said(kHead + record(0x0502, kDate) + record(0x0606) + record(0x0700) + kEnd),
            "a record 0x0606 where 0x0606 is due");  // of no letter
  const std::string layer = record(0x0800) + record(0x0D02, shorts({1})), end = record(0x1100);
  const std::string type = record(0x0E02, shorts({0}));
  EXPECT_EQ(said(kHead + cell("A", record(0x0800) + type)), "a record 0x0e02 where 0x0d02 is due");
  EXPECT_EQ(said(kHead + cell("A", record(0x0800) + record(0x0D02) + type)),
            "a record 0x0d02 where 0x0d02 is due");
  EXPECT_EQ(said(kHead + cell("A", layer + record(0x0E02))), "a record 0x0e02 where 0x0e02 is due");
  // Three points and the first again at least.
  EXPECT_EQ(said(kHead + cell("A", layer + type + record(0x1003, longs({0, 0, 1, 0, 0, 0})) + end)),
            "a record 0x1003 where 0x1003 is due");
  const std::string points = record(0x1003, longs({0, 0, 9, 0, 9, 9, 0, 0}));
  EXPECT_EQ(said(kHead + cell("A", layer + type + points + end) + kEnd), "");
  EXPECT_EQ(said(kHead + cell("A", layer + record(0x0E02, shorts({7})) + points + end) + kEnd),
            "a polygon of data type 7, of a layout of ours 0");
  for (const std::vector<long>& last : {std::vector<long>{1, 0}, {0, -1}}) {
    const std::string open = record(0x1003, longs({0, 0, 9, 0, 9, 9, last[0], last[1]}));
    EXPECT_EQ(said(kHead + cell("A", layer + type + open + end) + kEnd),
              "a polygon that is open: its last point is not its first");
  }
  const std::string placed = record(0x0A00) + record(0x1206, "B");
  EXPECT_EQ(said(kHead + cell("A", placed + record(0x1003, longs({0, 0})) + end) + kEnd),
            "a reference to \"B\", which is no cell");
  const std::string b = cell("B", kTriangle);
  EXPECT_EQ(said(kHead + b + cell("A", placed + record(0x1003, longs({0, 0})) + end) + kEnd), "");
  EXPECT_EQ(said(kHead + b + cell("A", placed + record(0x1003, shorts({0, 0})) + end) + kEnd),
            "a record 0x1003 where 0x1003 is due");
  EXPECT_EQ(said(kHead + b + cell("A", placed + record(0x1003, longs({0, 0})) + kEnd)),
            "a record 0x0400 where 0x1100 is due");
}

TEST(GdsRecords, OfArraysAreCountedAndMeasured) {
  const std::string b = cell("B", kTriangle);
  const auto array = [&](const std::vector<long>& counts, const std::vector<long>& points) {
    return said(kHead + b +
                cell("A", record(0x0B00) + record(0x1206, "B") + record(0x1302, shorts(counts)) +
                              record(0x1003, longs(points)) + record(0x1100)) +
                kEnd);
  };
  EXPECT_EQ(array({1, 1}, {5, 6, 15, 6, 5, 26}), "");
  EXPECT_EQ(array({3, 4}, {5, 6, 35, 6, 5, 46}), "");
  EXPECT_EQ(array({0, 4}, {5, 6, 35, 6, 5, 46}), "an array of no columns or rows");
  EXPECT_EQ(array({3, -1}, {5, 6, 35, 6, 5, 46}), "an array of no columns or rows");
  EXPECT_EQ(array({3}, {5, 6, 35, 6, 5, 46}), "a record 0x1302 where 0x1302 is due");
  EXPECT_EQ(array({3, 4}, {5, 6, 35, 6}), "a record 0x1003 where 0x1003 is due");
  EXPECT_EQ(array({3, 4}, {5, 6, 35, 7, 5, 46}), "an array that is turned");
  EXPECT_EQ(array({3, 4}, {5, 6, 35, 6, 4, 46}), "an array that is turned");
  EXPECT_EQ(array({3, 4}, {5, 6, 36, 6, 5, 46}), "an array whose pitch is not whole nanometres");
  EXPECT_EQ(array({3, 4}, {5, 6, 35, 6, 5, 47}), "an array whose pitch is not whole nanometres");
}

TEST(GdsRecords, ThatAreCutOffOrOfNoLengthAreRefused) {
  const std::string whole = kHead + cell("CELL", kTriangle) + kEnd;
  const std::string cut = "the data are cut off";
  for (std::size_t length = 0; length < whole.size(); length += 3)
    EXPECT_EQ(said(whole.substr(0, length)), cut) << length;
  EXPECT_EQ(said(kHead + "\x00\x03\x05\x02"s + whole), cut);
  EXPECT_EQ(said(kHead + "\x00\x00\x00\x00"s), cut);
  // A unit of another size, or two in a record of another length.
  EXPECT_EQ(said(record(0x0002, shorts({600})) + record(0x0305, kUnits.substr(4, 8)) + kEnd),
            "the database unit is not 1 nm");
}

}  // namespace
}  // namespace papilla::tests::gds_records_test
