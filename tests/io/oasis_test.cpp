// OASIS by its definition: what stands in the bytes, and that a change of any of them is seen.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "geometry/io/drawing.h"
#include "geometry/texture.h"
#include "tests/temporary.h"

namespace papilla::tests {
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

}  // namespace
}  // namespace papilla::tests
