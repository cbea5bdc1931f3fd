// Maps of several chunks of pixels, whose extremes may lie in any of them, and tables of dose, each
// refused by the words that tell what is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "tests/temporary.h"

namespace papilla::tests::ranges_and_curves_test {
namespace {

// Chunks of 2^14 pixels are looked at side by side: of 200 x 200 the last is of 7232.
TEST(Ranges, AreThoseOfAllPixelsWhereverTheyLie) {
  const std::string path = temporary("range.png");
  Heightmap h{{200, 200, 2e-6, 2e-6}, std::vector<double>(40000, 5e-9)};
  for (const std::size_t low : {0u, 16383u, 16384u, 20000u, 39999u}) {
    Heightmap map = h;
    const std::size_t high = 39999 - low / 2;  // another one
    map.z[high] = 9e-9;
    map.z[low] = -3e-9;
    write_png16(path, map);
    const Heightmap back = whole_map(*open_height_rows(path), 0);
    EXPECT_NEAR(back.z[low], -3e-9, 1e-15) << low;
    EXPECT_NEAR(back.z[100], 5e-9, 12e-9 / 65535) << low;  // a level
    EXPECT_NEAR(back.z[high], 9e-9, 1e-14) << low;
  }
  for (const std::size_t at : {0u, 16384u, 39999u}) {
    for (const double broken :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()}) {
      Heightmap map = h;
      map.z[at] = broken;
      try {
        write_png16(path, map);
        ADD_FAILURE() << at;
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "cannot write " + path + ": a height is not a finite number");
      }
    }
  }
}

std::string refusal(const std::string& table) {
  const std::string path = temporary("curve.csv");
  write_bytes(path, table);
  try {
    read_dose_curve(path);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(path.size());
  }
  return "";
}

TEST(DoseCurves, SayWhichLineIsWrongAndWhatIsDue) {
  const std::string pair = "expected depth_nm,grey",
                    separator = "; the separator is a comma, decimals a point",
                    range = "expected a depth from 0 and a grey of 0 to 255";
  for (const auto& [table, words] : std::vector<std::pair<std::string, std::string>>{
           {"0,10\n100,60\n", ""},
           {"depth,grey\n0,10\n100,60\n", ""},
           {"# resist\n\n0 , 10\n100,60\n", ""},
           {"0,0\n1,255\n", ""},
           {"999999999,10\n0,20\n", ""},
           {"depth_um,grey\n0,10\n0.1,60\n", ""},
           {"gray,depth [nm]\n10,0\n60,100\n", ""},
           {"\xEF\xBB\xBF"
            "depth_nm,grey\n0,10\n100,60\n",
            ""},
           {"depth_V,grey\n0,10\n100,60\n",
            ":1: depth_V: \"V\" is no unit of a length; write depth_nm"},
           {"depth_nm,dose\n0,10\n100,60\n",
            ":1: \"depth_nm,dose\" names no columns: " + pair + ", the depth in any unit"},
           {"0,10 nm\n100,60\n",
            ":1: \"0,10 nm\" names no columns: " + pair + ", the depth in any unit"},
           {"0,10\ndepth,grey\n100,60\n", ":2: " + pair},
           {"0,10\n100,60 nm\n", ":2: " + pair},
           {"0,10\n100\n", ":2: " + pair},
           {"0;10\n100;60\n", ":1: " + pair + separator},
           {"0\t10\n", ":1: " + pair + separator},
           {"depth,grey\n0,10\n100;60\n", ":3: " + pair + separator},
           {"0,10\n100,255.1\n", ":2: " + range},
           {"0,-0.1\n100,60\n", ":1: " + range},
           {"-0.1,0\n100,60\n", ":1: " + range},
           {"0,10\n1e9,60\n", ":2: " + range},
           {"0,10\nnan,60\n", ":2: " + range},
           {"0,10\n", ": expected at least two lines depth_nm,grey"},
           {"# nothing\n", ": expected at least two lines depth_nm,grey"},
           {"0,10\n100,60\n80,255\n", ": depth over grey is not monotone at 80 nm, grey 255"},
           {"0,10\n100,60\n100,70\n", ": depth over grey is not monotone at 100 nm, grey 70"},
           {"0,10\n100,60\n200,60\n", ": depth over grey is not monotone at 200 nm, grey 60"},
           {"0,90\n100,95\n200,70\n", ": depth over grey is not monotone at 100 nm, grey 95"},
           // From its end: turned before it is judged.
           {"200,10\n150,20\n180,30\n0,40\n",
            ": depth over grey is not monotone at 150 nm, grey 20"}})
    EXPECT_EQ(refusal(table), words) << table;
}

// 10 at 100 nm, 40 at 200, 250 at 300: between by lines, half a nanometre beyond the ends as they.
TEST(DoseCurves, AreInvertedByLinesWithinTheirEnds) {
  const std::vector<double> depth_nm{0,   99,  99.6, 100, 150,   199, 200,
                                     205, 250, 299,  300, 300.4, 301, 400};
  Heightmap h{{static_cast<int>(depth_nm.size()), 1, 1e-6, 1e-6}, {}};
  for (const double d : depth_nm) h.z.push_back(-1e-9 * d);
  DoseMap out;
  EXPECT_EQ(
      dose_levels(h, {{100e-9, 200e-9, 300e-9}, {10, 40, 250}}, out),
      (std::vector<std::uint8_t>{10, 10, 10, 10, 25, 40, 40, 51, 145, 248, 250, 250, 250, 250}));
  EXPECT_EQ(out.shallow, 2u);
  EXPECT_EQ(out.deep, 2u);
  EXPECT_EQ(out.lowest, 10);
  EXPECT_EQ(out.highest, 250);
}

}  // namespace
}  // namespace papilla::tests::ranges_and_curves_test
