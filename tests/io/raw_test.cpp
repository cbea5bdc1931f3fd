// GSF and NPY as others write them: units, kinds of numbers, headers that are cut off or say what
// cannot be read, each refused by the words that tell what is wrong.
#include "geometry/io/raw.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::raw_test {
namespace {

constexpr const char* kStart = "Gwyddion Simple Field 1.0\n";

// Three columns and two rows of 0, 1, 2 (the upper row) and 3, 4, 5.
std::string gsf(const std::string& header, std::size_t values = 6) {
  std::string out = kStart + header;
  out.append(4 - out.size() % 4, '\0');
  for (std::size_t i = 0; i < values; ++i) {
    const auto value = static_cast<float>(i);
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return out;
}

std::string npy(const std::string& header, std::size_t bytes, int version = 1) {
  std::string out = "\x93NUMPY";
  out += static_cast<char>(version);
  out += '\0';
  const auto length = static_cast<std::uint32_t>(header.size());
  out.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
  out += header;
  out.append(bytes, '\0');
  return out;
}

// What reading the bytes says; "" where they are read.
std::string refusal(const std::string& ending, const std::string& bytes) {
  const std::string path = temporary("raw." + ending);
  write_bytes(path, bytes);
  return refusal_of([&] { read_heightmap(path, ending == "npy" ? 6e-6 : 0); });
}

constexpr const char* kSides = "XRes = 3\nYRes = 2\nXReal = 6\nYReal = 5\n";

TEST(Gsf, SidesAndHeightsAreInTheirOwnUnits) {
  for (const auto& [units, side, height] : {std::tuple{"", 1.0, 1.0},
                                            {"XYUnits = um\nZUnits = nm\n", 1e-6, 1e-9},
                                            {"XYUnits=nm\nZUnits=um\n", 1e-9, 1e-6},
                                            {"XYUnits =   m  \nTitle = a\n", 1.0, 1.0}}) {
    const std::string path = temporary("units.gsf");
    write_bytes(path, gsf(std::string(kSides) + units));
    const Heightmap h = read_heightmap(path);
    EXPECT_EQ(h.grid.nx, 3);
    EXPECT_EQ(h.grid.ny, 2);
    EXPECT_DOUBLE_EQ(h.grid.lx, 6 * side) << units;
    EXPECT_DOUBLE_EQ(h.grid.ly, 5 * side) << units;
    for (int ix = 0; ix < 3; ++ix) {
      EXPECT_NEAR(h(ix, 1), ix * height, 1e-12 * height) << units;  // rows from the top
      EXPECT_NEAR(h(ix, 0), (3 + ix) * height, 1e-12 * height) << units;
    }
  }
}

TEST(Gsf, SidesArePicometresToKilometres) {
  const auto of = [](const char* x, const char* y) {
    return refusal("gsf",
                   gsf(std::string("XRes = 3\nYRes = 2\nXReal = ") + x + "\nYReal = " + y + "\n"));
  };
  EXPECT_EQ(of("1.1e-12", "999"), "");
  EXPECT_EQ(of("999", "1.1e-12"), "");
  EXPECT_NE(of("9e-13", "1").find("size of 9e-13 x 1 m; expected 1 pm to 1 km"), std::string::npos);
  for (const auto& [x, y] : {std::pair{"1", "9e-13"}, {"1001", "1"}, {"1", "1001"}})
    EXPECT_NE(of(x, y).find("expected 1 pm to 1 km"), std::string::npos) << x;
}

// The format does not ask for sides: pixels are squares then, of the width that is given.
TEST(Gsf, WithoutSidesItHasThoseThatAreGiven) {
  const std::string path = temporary("no_sides.gsf");
  for (const char* said : {"", "XReal = 6\n", "YReal = 4\n"}) {
    write_bytes(path, gsf(std::string("XRes = 3\nYRes = 2\n") + said));
    const Heightmap h = read_heightmap(path, 6);
    EXPECT_DOUBLE_EQ(h.grid.lx, 6) << said;
    EXPECT_DOUBLE_EQ(h.grid.ly, 4) << said;
    EXPECT_EQ(h(2, 0), 5) << said;
    EXPECT_NE(refusal_of([&] { read_heightmap(path); })
                  .find("the file does not say its lateral size; give it: texture.width of a "
                        "measured texture, --size of papilla surface"),
              std::string::npos)
        << said;
  }
}

TEST(Gsf, AnotherWidthThanItsOwnIsRefused) {
  const std::string path = temporary("own.gsf");
  write_bytes(path, gsf(kSides));
  EXPECT_NO_THROW(read_heightmap(path, 6));
  try {
    read_heightmap(path, 6.1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("the file says that it is 6e+06 um wide, and 6.1e+06 um were given"),
              std::string::npos)
        << error.what();
  }
}

// What a design is called is written by anybody: no part of it becomes a key of the header.
TEST(Gsf, ATitleOfSeveralLinesIsOneLineOfTheHeader) {
  const std::string path = temporary("title.gsf");
  const Heightmap map{{2, 2, 6e-6, 4e-6}, {1e-6, 2e-6, 3e-6, 4e-6}};
  write_gsf(path, map,
            {"a\nZUnits = nm\r\nb" + std::string(1, '\0') + "c", "flat\nXReal = 1\nYReal = 1"});
  const Heightmap back = read_heightmap(path);
  EXPECT_DOUBLE_EQ(back.grid.lx, 6e-6);
  EXPECT_DOUBLE_EQ(back.grid.ly, 4e-6);
  EXPECT_NEAR(back(1, 1), 4e-6, 1e-12);
  const std::string bytes = read_bytes(path);
  EXPECT_NE(bytes.find("\nTitle = a ZUnits = nm  b c\n"), std::string::npos) << bytes;
  EXPECT_NE(bytes.find("\nPapillaDesign = flat XReal = 1 YReal = 1\n"), std::string::npos) << bytes;
}

TEST(Gsf, WhatIsMissingOrNoNumberIsNamed) {
  const std::string sides = kSides;
  EXPECT_EQ(refusal("gsf", gsf(sides)), "");
  for (const auto& [bytes, why] : std::vector<std::pair<std::string, std::string>>{
           {gsf(sides, 5) + "abc", "the data are cut off"},  // a byte less than needed
           {gsf(sides, 8), "8 bytes more than 3 x 2 pixels have"},
           {gsf("YRes = 2\nXReal = 6\nYReal = 5\n"), "no XRes in the header"},
           {gsf("XRes = 3\nYRes = 2\nXReal = 0\nYReal = 5\n"), "XReal is not a positive number"},
           {gsf("XRes = 3\nYRes = 2\nXReal = 6\nYReal = -5\n"), "YReal is not a positive number"},
           {gsf("XRes = 3\nYRes = 2\nXReal = inf\nYReal = 5\n"), "XReal is not a positive number"},
           {gsf("XRes = 3\nYRes = two\nXReal = 6\nYReal = 5\n"), "YRes is not a positive number"},
           {gsf("XRes = 2.5\nYRes = 2\nXReal = 6\nYReal = 5\n"), "not a whole number of pixels"},
           {gsf("XRes = 3\nYRes = 1.5\nXReal = 6\nYReal = 5\n"), "not a whole number of pixels"},
           {gsf(sides + "XYUnits = s\n"), "XYUnits is not a length unit"},
           {gsf(sides + "ZUnits = V\n"), "ZUnits is not a length unit"},
           {"Gwyddion Simple Field 2.0\n" + sides, "not a Gwyddion Simple Field"},
           {kStart + sides, "the header does not end"},
       })
    EXPECT_NE(refusal("gsf", bytes).find(why), std::string::npos)
        << why << ": " << refusal("gsf", bytes);
}

TEST(Npy, BothKindsOfNumbersAndBothVersionsAreRead) {
  const std::string wide = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n",
                    narrow = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
  for (const int version : {1, 2}) {
    const std::string path = temporary("kinds.npy");
    std::string bytes = npy(wide, 0, version);
    for (int i = 0; i < 6; ++i) {
      const double value = 1e-9 * i;
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    write_bytes(path, bytes);
    Heightmap h = read_heightmap(path, 6e-6);
    EXPECT_EQ(h(2, 1), 5e-9);  // rows from below, as they are in memory
    EXPECT_EQ(h(1, 0), 1e-9);
    EXPECT_NEAR(h.grid.ly, 4e-6, 1e-18);  // square pixels
    bytes = npy(narrow, 0, version);
    for (int i = 0; i < 6; ++i) {
      const float value = 0.25F * static_cast<float>(i);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    write_bytes(path, bytes);
    h = read_heightmap(path, 6);
    EXPECT_EQ(h(2, 1), 1.25);
    EXPECT_EQ(h(0, 1), 0.75);
  }
}

// Of Fortran order the columns stand one after the other.
TEST(Npy, ColumnsThatComeFirstAreRowsOfTheSameMap) {
  const std::string path = temporary("columns.npy");
  std::string bytes = npy("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }\n", 0);
  for (const float value : {0.F, 3.F, 1.F, 4.F, 2.F, 5.F})
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  write_bytes(path, bytes);
  const Heightmap h = read_heightmap(path, 6);
  for (int iy = 0; iy < 2; ++iy) {
    for (int ix = 0; ix < 3; ++ix) EXPECT_EQ(h(ix, iy), 3 * iy + ix);
  }
}

// As its format asks for, whatever the length of the header.
TEST(Npy, HeightsBeginAtAMultipleOfSixtyFourBytes) {
  const std::string path = temporary("aligned.npy");
  for (const int nx : {1, 12, 123, 1234}) {
    for (const int ny : {1, 56, 567}) {
      const Heightmap h{{nx, ny, 1e-6, 1e-6}, std::vector<double>(std::size_t(nx) * ny)};
      write_npy(path, h);
      const std::string bytes = read_bytes(path);
      const std::size_t begin = 10 + static_cast<unsigned char>(bytes[8]) +
                                256 * std::size_t{static_cast<unsigned char>(bytes[9])};
      EXPECT_EQ(begin % 64, 0u) << nx << " " << ny;
      EXPECT_EQ(bytes[begin - 1], '\n');
      EXPECT_EQ(bytes.size(), begin + 8 * h.z.size());
    }
  }
}

TEST(Npy, WhatCannotBeReadIsNamed) {
  const auto header = [](const std::string& type, const std::string& order,
                         const std::string& shape) {
    return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  };
  const std::string good = header("<f8", "False", "(2, 3)");
  EXPECT_EQ(refusal("npy", npy(good, 48)), "");
  for (const auto& [bytes, why] : std::vector<std::pair<std::string, std::string>>{
           {npy(good, 47), "the data are cut off"},
           {npy(header("<f4", "False", "(2, 3)"), 23), "the data are cut off"},
           {npy(good, 0).substr(0, 40), "the header is cut off"},
           {"\x93NUMP", "not a .npy file"},
           {npy(header(">f8", "False", "(2, 3)"), 48), "needs float64 or float32"},
           {npy(header("<i8", "False", "(2, 3)"), 48), "needs float64 or float32"},
           {npy(header("<f8", "False", "(6,)"), 48), "two-dimensional array, got the shape (6,)"},
           // An image of three channels is no map, however many numbers follow.
           {npy(header("<f8", "False", "(2, 3, 3)"), 144), "got the shape (2, 3, 3)"},
           {npy(header("<f8", "False", "(2, 3"), 48), "two-dimensional"},
           {npy(good, 49), "1 bytes more than 3 x 2 pixels have"},
           {npy(header("<f8", "True", "(2, 3)"), 56), "8 bytes more than 3 x 2 pixels have"},
           {npy("{'descr': [('z', '<f8'), ('q', '<f8')], 'fortran_order': False, 'shape': (2, 3), "
                "}",
                96),
            "its numbers are [('z', '<f8'), ('q', '<f8')]; needs float64 or float32"},
           {npy("{'fortran_order': False, 'shape': (2, 3), }", 48), "no descr in the header"},
           {npy(header("<f8", "False", "(0, 3)"), 48), "3 x 0 pixels"},
           {npy(header("<f8", "False", "(2, -3)"), 48), "-3 x 2 pixels"},
           {npy(header("<f8", "False", "(16385, 16384)"), 48),
            "16384 x 16385 pixels; at most 2^28 can be read"},
           // The largest that may be is refused for its length alone.
           {npy(header("<f8", "False", "(16384, 16384)"), 48), "the data are cut off"},
       })
    EXPECT_NE(refusal("npy", bytes).find(why), std::string::npos)
        << why << ": " << refusal("npy", bytes);
}

}  // namespace
}  // namespace papilla::tests::raw_test
