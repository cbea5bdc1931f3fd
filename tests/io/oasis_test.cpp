// OASIS by its definition: what stands in the bytes, and that a change of any of them is seen.
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "geometry/io/drawing.h"
#include "geometry/io/raw.h"
#include "geometry/texture.h"
#include "tests/temporary.h"

namespace papilla::tests::oasis_test {
namespace {

Layout square_at(std::int32_t x, std::int32_t y) {
  Layout out;
  out.cells.push_back({"CELL", {{1, {{x, x + 200, x + 200, x}, {y, y, y + 100, y + 100}}}}, {}});
  out.cells.push_back({"TEXTURE",
                       {},
                       {{.cell = "CELL",
                         .x = -3,
                         .y = 5,
                         .columns = 130,
                         .rows = 2,
                         .step_x = 1000,
                         .step_y = 500,
                         .array = true}}});
  return out;
}

// Worked out by hand from SEMI P39: 7 bits a byte, the sign in the lowest bit.
TEST(Oasis, StandsInTheBytesOfItsDefinition) {
  const std::string path = temporary("bytes.oas");
  write_oasis(path, square_at(-1, 70));
  const std::string bytes = read_bytes(path);
  using namespace std::string_literals;
  const std::string start = "%SEMI-OASIS\r\n"s +
                            "\x01\x03"
                            "1.0\x00\xe8\x07\x00"s +
                            std::string(12, '\0');
  const std::string cell =
      "\x0e\x04"
      "CELL"s;
  // Polygon of layer 1, type 0: steps (200, 0), (0, 100), (-200, 0) from (-1, 70).
  const std::string polygon =
      "\x15\x3b\x01\x00\x04\x03\xa1\x06\x00\x01\xc8\x01\xa3\x06\x00"s + "\x03\x8c\x01"s;
  // Placed at (-3, 5): 130 columns of 1000, 2 rows of 500.
  const std::string top = "\x0e\x07TEXTURE"s +
                          "\x11\xb8\x04"
                          "CELL"s +
                          "\x07\x0a\x01\x80\x01\x00\xe8\x07\xf4\x03"s;
  const std::string body = start + cell + polygon + top;
  EXPECT_EQ(bytes.substr(0, body.size()), body);
  EXPECT_EQ(bytes.size(), body.size() + 256);  // the last record
  EXPECT_EQ(bytes[body.size()], '\x02');
  EXPECT_EQ(bytes[bytes.size() - 5], '\x01');  // a CRC32 follows
}

TEST(Oasis, ReadsBackWhatGdsiiReadsBack) {
  HoleArray holes;
  holes.lattice = Lattice::Hexagonal;
  const auto array = std::get<FeatureArray>(facts(Texture{holes}).outline);
  const Grid grid{64, 64, 12e-6, 12e-6};
  const Heightmap h = generate(Texture{ParticleFilm{}}, grid);
  for (const Layout& layout : {draw_array(array, 1e-3, 0.7e-3).layout, draw_contours(h, 3)}) {
    write_oasis(temporary("a.oas"), layout);
    write_gds(temporary("a.gds"), layout);
    const Layout a = read_oasis(temporary("a.oas")), b = read_gds(temporary("a.gds"));
    ASSERT_EQ(a.cells.size(), layout.cells.size());
    ASSERT_EQ(b.cells.size(), layout.cells.size());
    for (std::size_t i = 0; i < layout.cells.size(); ++i) {
      EXPECT_EQ(a.cells[i].name, layout.cells[i].name);
      EXPECT_EQ(a.cells[i].polygons, layout.cells[i].polygons);
      EXPECT_EQ(b.cells[i].polygons, layout.cells[i].polygons);
      ASSERT_EQ(a.cells[i].references.size(), layout.cells[i].references.size());
      ASSERT_EQ(b.cells[i].references.size(), layout.cells[i].references.size());
      for (std::size_t k = 0; k < a.cells[i].references.size(); ++k) {
        const LayoutReference &r = layout.cells[i].references[k], &o = a.cells[i].references[k],
                              &g = b.cells[i].references[k];
        EXPECT_EQ(std::tie(r.cell, r.x, r.y, r.columns, r.rows),
                  std::tie(o.cell, o.x, o.y, o.columns, o.rows));
        EXPECT_EQ(std::tie(r.cell, r.x, r.y, r.columns, r.rows),
                  std::tie(g.cell, g.x, g.y, g.columns, g.rows));
        EXPECT_TRUE(r.columns == 1 || r.step_x == o.step_x);
        EXPECT_TRUE(r.rows == 1 || r.step_y == o.step_y);
      }
    }
  }
}

// Any byte of either file changed, or its end cut off: refused or read as something else, and never
// more than that.
TEST(Layouts, DamagedFilesAreRefusedOrReadToTheirEnd) {
  for (const std::string ending : {"oas", "gds"}) {
    const std::string path = temporary("hurt." + ending);
    const bool oasis = ending == "oas";
    oasis ? write_oasis(path, square_at(0, 0)) : write_gds(path, square_at(0, 0));
    const std::string good = read_bytes(path);
    const auto read = [&](const std::string& bytes) {
      write_bytes(path, bytes);
      return oasis ? read_oasis(path) : read_gds(path);
    };
    RandomStream random(5, "damage", 0);
    for (int i = 0; i < 60; ++i) {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(good.size()));
      EXPECT_THROW(read(good.substr(0, at)), InputError) << ending << at;
      std::string changed = good;
      changed[at] = static_cast<char>(changed[at] ^ (1 << (i % 8)));
      if (oasis) {
        EXPECT_THROW(read(changed), InputError) << at;  // by its sum
        continue;
      }
      try {
        read(changed);
      } catch (const InputError&) {  // GDSII has no sum: another number is another layout
      }
    }
  }
}

// What a reader says of bytes, without the file's name; "": it reads them.
std::string refusal(const std::string& bytes, Layout read(const std::string& path)) {
  const std::string path = temporary("refused");
  write_bytes(path, bytes);
  try {
    read(path);
  } catch (const InputError& error) {
    const std::string why = error.what(), head = "cannot read " + path + ": ";
    EXPECT_TRUE(why.starts_with(head)) << why;
    return why.substr(head.size());
  }
  return "";
}

// A whole file of SEMI P39 around records: its start before them, its end with the right sum.
std::string oasis_of(const std::string& records, const std::string& start = "") {
  using namespace std::string_literals;
  std::string out = "%SEMI-OASIS\r\n"s +
                    (start.empty() ? "\x01\x03"
                                     "1.0\x00\xe8\x07\x00"s
                                   : start) +
                    std::string(12, '\0') + records;
  out += "\x02\xf8\x01"s + std::string(248, '\0') + "\x01"s;
  const auto* bytes = reinterpret_cast<const Bytef*>(out.data());
  return out + little(crc32_z(0, bytes, out.size()), 4);
}

TEST(Oasis, WhatNoLayoutOfOursHasIsRefusedByItsName) {
  using namespace std::string_literals;
  const std::string cell =
      "\x0e\x04"
      "CELL"s;
  const std::string steps = "\x04\x03\xa1\x06\x00\x01\xc8\x01\xa3\x06\x00\x03\x8c\x01"s;
  const std::string polygon = "\x15\x3b\x01\x00"s + steps, same_layer = "\x15\x38"s + steps;
  const std::string top = "\x0e\x01T"s, placed =
                                            "\x04"
                                            "CELL\x07\x0a"s;
  const std::string drawn = cell + polygon + top;
  const auto why = [](const std::string& records, const std::string& start = "") {
    return refusal(oasis_of(records, start), read_oasis);
  };
  EXPECT_EQ(why(drawn + "\x11\xb0"s + placed), "");
  EXPECT_EQ(why(cell + polygon + same_layer), "");
  const std::string unit = "the database unit is not 1 nm", element = " that no layout of ours has";
  EXPECT_EQ(why(cell,
                "\x01\x03"
                "1.1\x00\xe8\x07\x00"s),
            "no OASIS of version 1.0");
  EXPECT_EQ(why(cell,
                "\x02\x03"
                "1.0\x00\xe8\x07\x00"s),
            "no OASIS of version 1.0");
  EXPECT_EQ(why(cell,
                "\x01\x03"
                "1.0\x01\xe8\x07\x00"s),
            unit);
  EXPECT_EQ(why(cell,
                "\x01\x03"
                "1.0\x00\xd0\x0f\x00"s),
            unit);
  EXPECT_EQ(why(cell,
                "\x01\x03"
                "1.0\x00\xe8\x07\x01"s),
            "tables at its end, which no layout of ours has");
  EXPECT_EQ(why(""), "no cell");
  EXPECT_EQ(why(cell + cell), "two cells \"CELL\"");
  EXPECT_EQ(why(polygon + cell), "an element outside of any cell");
  EXPECT_EQ(why(cell + "\x03"s), "a record 3" + element);
  EXPECT_EQ(why(cell + "\x15\x2b\x01\x00"s + steps), "a polygon" + element);
  EXPECT_EQ(why(cell + same_layer), "a polygon on no layer");
  EXPECT_EQ(why(drawn + same_layer), "a polygon on no layer");  // each cell begins anew
  EXPECT_EQ(why(cell + "\x15\x3b\x01\x00\x01\x03"s), "a list of points" + element);
  EXPECT_EQ(why(cell + "\x15\x3b\x01\x00\x04\x01\xa1\x06\x00\x03\x8c\x01"s),
            "a polygon of less than three points");
  EXPECT_EQ(why(cell + "\x15\x3b\x01\x00\x04\x02\xa1\x06\x00\x01\xc8\x01\x03\x8c\x01"s), "");
  EXPECT_EQ(why(cell + "\x15\x3b\x01\x00\x04\x03\xa0\x06\x00"s), "a list of points" + element);
  EXPECT_EQ(why(top + "\x11\xb0"s + placed), "a reference to \"CELL\", which is no cell");
  EXPECT_EQ(why(drawn + "\x11\xf0"s + placed), "a placement" + element);
  EXPECT_EQ(why(drawn + "\x11\xb8"s + placed + "\x00"s), "a repetition" + element);
  EXPECT_EQ(why(drawn + "\x11\xb8"s + placed + "\x04"s), "a repetition" + element);
  // 2^31 and one more, then a pitch.
  EXPECT_EQ(why(drawn + "\x11\xb8"s + placed + "\x02\x80\x80\x80\x80\x08\x0a"s), "");
  EXPECT_EQ(why(drawn + "\x11\xb8"s + placed + "\x02\x81\x80\x80\x80\x08\x0a"s),
            "a repetition of more than 2^31");
  EXPECT_EQ(why(drawn + std::string(10, '\xff')), "a number of more than 63 bits");
  // 2^31 - 1 nm along x, and 1 nm more.
  const std::string name =
      "\x11\xb0\x04"
      "CELL"s;
  EXPECT_EQ(why(drawn + name + "\xfe\xff\xff\xff\x0f\x00"s), "");
  EXPECT_EQ(why(drawn + name + "\x80\x80\x80\x80\x10\x00"s), "a coordinate beyond 2.1 m");
  EXPECT_EQ(why(drawn + name + "\x81\x80\x80\x80\x10\x00"s), "");  // -2^31
  EXPECT_EQ(why(drawn + name + "\x83\x80\x80\x80\x10\x00"s), "a coordinate beyond 2.1 m");
}

// A name that is said to be as long as the whole file.
TEST(Oasis, ANameBeyondTheEndIsCutOff) {
  using namespace std::string_literals;
  const auto file = [](std::size_t length) {
    return oasis_of("\x0e\x01T\x11\xb0"s + static_cast<char>((length & 0x7f) | 0x80) +
                    static_cast<char>(length >> 7) + "T\x00\x00"s);
  };
  EXPECT_EQ(refusal(file(file(0).size()), read_oasis), "the data are cut off");
}

TEST(Oasis, RowsOrColumnsAloneAreReadAsSuch) {
  using namespace std::string_literals;
  const std::string path = temporary("rows.oas");
  const std::string placed = "\x0e\x01T\x0e\x01U\x11\xb8\x01T\x07\x0a"s;
  write_bytes(path, oasis_of(placed + "\x02\x05\x64"s));  // 5 + 2 columns of 100
  const LayoutReference columns = read_oasis(path).cells.at(1).references.at(0);
  EXPECT_EQ(std::tuple(columns.columns, columns.rows, columns.step_x, columns.step_y),
            std::tuple(7, 1, 100, 0));
  EXPECT_EQ(std::tuple(columns.x, columns.y, columns.array), std::tuple(-3, 5, true));
  write_bytes(path, oasis_of(placed + "\x03\x06\x32"s));
  const LayoutReference rows = read_oasis(path).cells.at(1).references.at(0);
  EXPECT_EQ(std::tuple(rows.columns, rows.rows, rows.step_x, rows.step_y), std::tuple(1, 8, 0, 50));
}

TEST(Gds, OtherUnitsAndPitchesAreRefusedByTheirName) {
  const std::string path = temporary("other.gds");
  write_gds(path, square_at(0, 0));
  const std::string good = read_bytes(path);
  const auto why = [&](const std::string& head, std::size_t at, int by) {
    std::string bytes = good;
    const std::size_t record = bytes.find(head);
    EXPECT_NE(record, std::string::npos);
    bytes[record + 4 + at] = static_cast<char>(bytes[record + 4 + at] + by);
    return refusal(bytes, read_gds);
  };
  using namespace std::string_literals;
  const std::string unit = "the database unit is not 1 nm";
  const std::string units = "\x00\x14\x03\x05"s;  // two reals, their first bytes the exponents
  EXPECT_EQ(refusal(good, read_gds), "");
  for (const int by : {1, -1}) {
    EXPECT_EQ(why(units, 0, by), unit);
    EXPECT_EQ(why(units, 8, by), unit);
    EXPECT_EQ(why(units, 4, by), unit);  // 1e-8 of it
    EXPECT_EQ(why(units, 12, by), unit);
  }
  const std::string counts = "\x00\x08\x13\x02"s;  // 130 columns, 2 rows
  EXPECT_EQ(why(counts, 1, -130), "an array of no columns or rows");
  EXPECT_EQ(why(counts, 3, -2), "an array of no columns or rows");
  const std::string points = "\x00\x1c\x10\x03"s;  // three of an array
  const std::string pitch = "an array whose pitch is not whole nanometres";
  EXPECT_EQ(why(points, 11, 1), pitch);
  EXPECT_EQ(why(points, 23, 1), pitch);
  EXPECT_EQ(why(points, 15, 1), "an array that is turned");
  EXPECT_EQ(why(points, 19, 1), "an array that is turned");
}

}  // namespace
}  // namespace papilla::tests::oasis_test
