// Files of heights against a design of a hundred pixels: all that is said of them, worked out by
// hand, and where each tolerance ends.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/files.h"
#include "fabricate/checks.h"
#include "fabricate/formats.h"
#include "geometry/io/files.h"
#include "geometry/io/layout.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::heights_judged_test {
namespace {

constexpr Grid kGrid{10, 10, 10e-6, 10e-6};  // pixels of 1 um

// A design and what is said of files that hold other heights than its own.
struct Judge {
  Heightmap design;
  Texture texture{HoleArray{.period = 10e-6}};
  ExportOptions options{};
  std::function<void(double)> progress{};

  Faults of(const char* format, const Heightmap& file) const { return of(format, file, options); }
  Faults of(const char* format, const Heightmap& file, const ExportOptions& written) const {
    const ExportFormat& kind = find_export_format(format);
    const std::string path = temporary(kind.file);
    const std::function<void(double)> quiet;
    const FileInfo info;
    Export out;
    kind.write({file, texture, written, info, quiet}, path, out);
    return kind.check({design, texture, options, info, progress}, path);
  }
};

Heightmap map_of(const Grid& grid, const std::function<double(std::size_t pixel)>& height) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (std::size_t i = 0; i < h.z.size(); ++i) h.z[i] = height(i);
  return h;
}

// So many pixels 100 nm deep, row by row, below a land at 30 nm.
Heightmap with_deep(std::size_t deep) {
  return map_of(kGrid, [&](std::size_t i) { return i < deep ? -70e-9 : 30e-9; });
}

std::string off(int pixels, const std::string& by, const std::string& place) {
  return fmt::format(
      "{} of 100 heights are off by more than the rounding of the format, by {} nm at most, at {} "
      "um",
      pixels, by, place);
}

// Of 20 and 25 pixels of 100 of each kind of feature, by its own area: discs of a cell of 100 um2
// or of half of 10 x 10 sqrt 3, lines of a period, and what is no array by its area alone.
TEST(JudgedHeights, AWidthIsThatOfTheShareBelowHalfTheDepth) {
  const auto disc = [](double share, double cell) {
    return 1e-6 * std::sqrt(4 / kPi * share * cell);
  };
  const double half = 50 * std::sqrt(3.0);
  const Texture holes{HoleArray{.period = 10e-6}},
      hexagons{HoleArray{.lattice = Lattice::Hexagonal, .period = 10e-6}},
      pillars{PillarArray{.period = 10e-6}}, grooves{Grating{.period = 10e-6}};
  for (const auto& [texture, name, is, design] :
       {std::tuple{holes, "holes", disc(0.25, 100), disc(0.2, 100)},
        {hexagons, "holes", disc(0.25, half), disc(0.2, half)},
        {pillars, "pillars", disc(0.75, 100), disc(0.8, 100)},
        {grooves, "grooves", 2.5e-6, 2e-6}}) {
    const Judge judge{with_deep(20), texture};
    EXPECT_EQ(judge.of("npy", with_deep(25)),
              (Faults{fmt::format("its critical dimension (width of the {}) {}", name,
                                  differs(is, design, 1e-6, "um")),
                      off(5, "100", "(0.5, 2.5)")}));
    EXPECT_EQ(judge.of("npy", with_deep(20)), Faults{});
  }
  EXPECT_EQ((Judge{with_deep(20), Texture{RandomRough{}}}.of("gsf", with_deep(15))),
            (Faults{"15 % of its area is below half the depth, of the design's 20 %",
                    off(5, "100", "(5.5, 1.5)")}));
}

// A thousandth of the share below half the depth is no other width.
TEST(JudgedHeights, AWidthOfAThousandthMoreOrLessIsNone) {
  const Grid grid{100, 100, 10e-6, 10e-6};
  const auto deep = [&](std::size_t n) {
    return map_of(grid, [n](std::size_t i) { return i < n ? -100e-9 : 0; });
  };
  const Judge judge{deep(5000)};
  for (const auto& [n, faults] : {std::pair{4994, 2}, {4996, 1}, {5000, 0}, {5004, 1}, {5006, 2}})
    EXPECT_EQ(judge.of("npy", deep(static_cast<std::size_t>(n))).size(),
              static_cast<std::size_t>(faults))
        << n;
}

// Two maps of 50 deep pixels that share k have the correlation 4 k / 100 - 1; of 50 and 60 with k
// in common it is (k / 100 - 0.3) / sqrt(0.25 0.24).
TEST(JudgedHeights, AreUpsideDownFromACorrelationOfLessThanMinusAHalf) {
  const auto file = [](std::size_t deep, std::size_t common) {
    return map_of(kGrid, [=](std::size_t i) {
      return (i < 50 ? i < common : i - 50 < deep - common) ? -70e-9 : 30e-9;
    });
  };
  const Judge judge{with_deep(50)};
  const std::string upside = "it is upside down: what is deep is high (its polarity)";
  EXPECT_EQ(judge.of("npy", file(50, 12)), (Faults{upside, off(76, "100", "(2.5, 1.5)")}));
  EXPECT_EQ(judge.of("npy", file(50, 13)), (Faults{off(74, "100", "(3.5, 1.5)")}));
  EXPECT_EQ(judge.of("npy", file(60, 17)), (Faults{upside, off(76, "100", "(7.5, 1.5)")}));
  EXPECT_EQ(judge.of("npy", file(60, 18)).at(0),
            "its critical dimension (width of the holes) " +
                differs(1e-6 * std::sqrt(240 / kPi), 1e-6 * std::sqrt(200 / kPi), 1e-6, "um"));
  EXPECT_EQ(judge.of("npy", file(60, 18)).size(), 2u);
}

// By volume where the depth is another: 10 pixels of twice the depth and 20 of the depth are a
// fifth of twice the depth, as 20 of the depth are a fifth of it.
TEST(JudgedHeights, OfAnotherDepthHaveTheWidthOfTheirVolume) {
  const Judge judge{with_deep(20)};
  const auto file = [](std::size_t twice, std::size_t once) {
    return map_of(kGrid, [=](std::size_t i) {
      return i < twice ? -170e-9 : i < twice + once ? -70e-9 : 30e-9;
    });
  };
  EXPECT_EQ(judge.of("npy", file(10, 20)),
            (Faults{"its depth is 200 nm, the design's 100 nm: 100 % more",
                    off(20, "100", "(0.5, 2.5)")}));
  // 20 of twice the depth and 10 of it are a quarter.
  EXPECT_EQ(
      judge.of("npy", file(20, 10)),
      (Faults{"its depth is 200 nm, the design's 100 nm: 100 % more",
              "its critical dimension (width of the holes) " +
                  differs(1e-6 * std::sqrt(100 / kPi), 1e-6 * std::sqrt(80 / kPi), 1e-6, "um"),
              off(30, "100", "(0.5, 2.5)")}));
}

TEST(JudgedHeights, ADepthIsRightToAMillionth) {
  const Judge judge{with_deep(20)};
  const auto deeper = [](double by) {
    return map_of(kGrid, [=](std::size_t i) { return i < 20 ? 30e-9 - 100e-9 * (1 + by) : 30e-9; });
  };
  EXPECT_EQ(judge.of("npy", deeper(2e-6)),
            (Faults{"its depth is 100.0002 nm, the design's 100 nm: 0.0002 % more",
                    off(20, "0.0002", "(0.5, 0.5)")}));
  EXPECT_EQ(judge.of("npy", deeper(-2e-6)).at(0),
            "its depth is 99.9998 nm, the design's 100 nm: 0.0002 % less");
  EXPECT_EQ(judge.of("npy", deeper(0.5e-6)), (Faults{off(20, "5e-05", "(0.5, 0.5)")}));
  EXPECT_EQ(judge.of("npy", deeper(-0.5e-6)).size(), 1u);
}

// Heights of -100, 0 and 40 nm, a pixel of which is moved: 1e-7 of the largest number in 32 bits,
// 0.505 of a level of grey, 1e-9 of 140 nm and a ten millionth of a nanometre in doubles.
TEST(JudgedHeights, AreRightToTheRoundingOfTheirFormat) {
  for (const bool down : {false, true}) {
    const double sign = down ? -1 : 1;
    const Heightmap design = map_of(kGrid, [&](std::size_t i) {
      return sign * (i < 20 ? -100e-9 : i < 60 ? 0 : 40e-9);
    });
    Judge judge{design};
    const auto moved = [&](std::size_t pixel, double by) {
      Heightmap h = design;
      h.z[pixel] += by;
      return h;
    };
    const double level = 140e-9 / 65535;
    // The lowest plane is zero in EXR: a lowest pixel has all digits there. Zero is level 46810.71
    // or, upside down, 18724.29: the nearest is 0.29 away, the other 0.71.
    const std::size_t lowest = down ? 70 : 10, zero = 30;
    for (const auto& [format, pixel, right, wrong] :
         {std::tuple{"exr", lowest, 1.38e-14, 1.46e-14},
          {"tiff32", lowest, 1.38e-14, 1.46e-14},
          {"gsf", zero, 0.98e-14, 1.06e-14},
          {"gsf", zero, -0.98e-14, -1.06e-14},
          {"npy", zero, 2.2e-16, 2.6e-16},
          {"npy", zero, -2.2e-16, -2.6e-16},
          {"x3p", zero, 2.2e-16, 2.6e-16},
          {"png16", zero, sign * 0.2 * level, -sign * 0.25 * level}}) {
      EXPECT_EQ(judge.of(format, moved(pixel, right)), Faults{}) << format << right << down;
      EXPECT_EQ(judge.of(format, moved(pixel, wrong)).size(), 1u) << format << wrong << down;
    }
    for (const Polarity polarity : {Polarity::WhiteHigh, Polarity::WhiteDeep}) {
      judge.options.polarity = polarity;
      EXPECT_EQ(judge.of("tiff", moved(zero, sign * 0.2 * level)), Faults{});
      EXPECT_EQ(judge.of("tiff", moved(zero, -sign * 0.25 * level)).size(), 1u);
    }
  }
}

// On the threshold of a mask, half the depth, either side is right, to a millionth of a thousandth
// of the depth.
TEST(JudgedHeights, OnTheThresholdOfAMaskAreRightOnEitherSide) {
  const auto at = [](double pixel) {
    return map_of(kGrid, [=](std::size_t i) { return i == 0 ? pixel : i < 50 ? -70e-9 : 30e-9; });
  };
  // Of a texture that states no depth: that of its pixels.
  for (const double sign : {1.0, -1.0}) {
    for (const auto& [away, faults] : {std::pair{0.5e-16, 0u}, {2e-16, 2u}}) {
      Judge judge{at(-20e-9 + sign * away), Texture{RandomRough{}}};
      judge.options.polarity = Polarity::WhiteDeep;
      EXPECT_EQ(judge.of("mask", at(-20e-9 - sign * 1e-9)).size(), faults) << sign << away;
      EXPECT_EQ(judge.of("mask", at(-20e-9 + sign * 1e-9)), Faults{});
    }
  }
}

TEST(JudgedHeights, SidesAreRightToABillionthAndByTagsToAMillionth) {
  Judge judge{with_deep(20)};
  const auto sides = [&](const char* format, double x, double y) {
    Heightmap h = judge.design;
    h.grid.lx *= 1 + x, h.grid.ly *= 1 + y;
    return judge.of(format, h);
  };
  EXPECT_EQ(sides("gsf", 0.5e-9, -0.5e-9), Faults{});
  EXPECT_EQ(sides("gsf", 2e-9, 0),
            Faults{"its width is 10.00000002 um, the design's 10 um: 2e-07 % more"});
  EXPECT_EQ(sides("gsf", 0, -2e-9),
            Faults{"its height is 9.99999998 um, the design's 10 um: 2e-07 % less"});
  judge.options.polarity = Polarity::WhiteHigh;
  const auto tags = [&](double x, double y) {
    std::string out;
    for (const std::string& fault : sides("tiff", x, y))
      out += fault.substr(0, fault.find(" is ")) + "; ";
    return out;
  };
  EXPECT_EQ(tags(0, 0), "");
  EXPECT_EQ(tags(0.7e-6, -0.7e-6), "its width; its height; ");
  EXPECT_EQ(tags(1.4e-6, 0), "its width; its width by the TIFF tags; ");
  EXPECT_EQ(tags(0, 1.4e-6), "its height; its height by the TIFF tags; ");
  EXPECT_EQ(tags(0, -1.4e-6), "its height; its height by the TIFF tags; ");
}

TEST(JudgedHeights, WhatAFileDoesNotSayOrSaysOtherwiseIsNamed) {
  Judge judge{with_deep(20)};
  judge.options.polarity = Polarity::WhiteDeep;
  ExportOptions other = judge.options;
  other.polarity = Polarity::WhiteHigh;
  EXPECT_EQ(judge.of("tiff", judge.design, other),
            Faults{"its polarity is white-high, the export's is white-deep"});
  judge.options.polarity = Polarity::WhiteHigh, other.polarity = Polarity::WhiteDeep;
  EXPECT_EQ(judge.of("tiff", judge.design, other),
            Faults{"its polarity is white-deep, the export's is white-high"});
  const FileInfo info;
  const std::string exr = temporary("silent.exr"), npy = temporary("silent.npy");
  write_exr(exr, judge.design, info);
  write_npy(npy, judge.design);
  const ExportSource source{judge.design, judge.texture, judge.options, info, judge.progress};
  const Faults said = check_tiff(source, exr);
  ASSERT_GE(said.size(), 3u);
  EXPECT_EQ(said[0], "its width by the TIFF tags is not in the file");
  EXPECT_EQ(said[1], "its height by the TIFF tags is not in the file");
  EXPECT_EQ(said[2], "its polarity is not said, the export's is white-high");
  EXPECT_EQ(check_gsf(source, npy),
            (Faults{"its width is not in the file", "its height is not in the file"}));
}

// ImageJ knows sides and heights by other lines of the description than our own reader.
TEST(JudgedHeights, WhatImageJTakesOfATiffIsTheDesigns) {
  Judge judge{with_deep(20), Texture{RandomRough{}}};  // as deep as its pixels
  const std::function<void(double)> quiet;
  const FileInfo info;
  for (const bool deep : {false, true}) {
    judge.options.polarity = deep ? Polarity::WhiteDeep : Polarity::WhiteHigh;
    for (const char* format : {"tiff", "mask", "tiff32"}) {
      const ExportFormat& kind = find_export_format(format);
      const std::string path = temporary(kind.file);
      const ExportSource source{judge.design, judge.texture, judge.options, info, quiet};
      Export out;
      kind.write(source, path, out);
      EXPECT_EQ(kind.check(source, path), Faults{}) << format;
      const std::string bytes = read_bytes(path);
      const auto changed = [&](const std::string& from, const std::string& to) {
        std::string other = bytes;
        // Of the file's own directory, the last one: libtiff leaves a first that nothing points to.
        const std::size_t at = other.rfind(from);
        if (at != std::string::npos) other.replace(at, from.size(), to);
        write_bytes(path, other);
        return kind.check(source, path);
      };
      const std::string said = "its description says to ImageJ ";
      EXPECT_EQ(changed("\nunit=cm", "\nunit=mm"), Faults{said + "unit=mm, and unit=cm is due"});
      EXPECT_EQ(changed("vunit=um", "vunit=nm"), Faults{said + "vunit=nm, and vunit=um is due"});
      EXPECT_EQ(changed("vunit=um", "wunit=um"), Faults{said + "no vunit, and vunit=um is due"});
      if (kind.name == std::string("tiff32")) continue;
      EXPECT_EQ(changed("cf=0", "cf=1"), Faults{said + "cf=1, and cf=0 is due"});
      const std::string zero = deep ? "c0=0.03" : "c0=-0.07", other = deep ? "c0=0.04" : "c0=-0.06";
      EXPECT_EQ(changed(zero, other), Faults{said + other + ", and " + zero + " is due"});
      // 0.1 um in 65535 levels.
      EXPECT_EQ(changed("c1=", "d1="),
                Faults{said + "no c1, and c1=" + (deep ? "-" : "") + "1.52590219e-06 is due"});
      EXPECT_EQ(changed("52590219e-06", "52590319e-06").size(), 1u);
    }
  }
}

// 262 of type 3, one value: grey whose 0 is white is turned round by some readers, colours have no
// heights.
TEST(JudgedHeights, ATiffIsGreyFromBlackAtZero) {
  Judge judge{with_deep(20), Texture{RandomRough{}}};
  judge.options.polarity = Polarity::WhiteHigh;
  const std::function<void(double)> quiet;
  const FileInfo info;
  for (const char* format : {"tiff", "mask", "tiff32"}) {
    const ExportFormat& kind = find_export_format(format);
    const std::string path = temporary(kind.file);
    const ExportSource source{judge.design, judge.texture, judge.options, info, quiet};
    Export out;
    kind.write(source, path, out);
    std::string bytes = read_bytes(path);
    const std::size_t at = bytes.rfind(std::string("\x06\x01\x03\0\x01\0\0\0\x01\0", 10));
    ASSERT_NE(at, std::string::npos) << format;
    const auto stated = [&](char photometric) {
      bytes[at + 8] = photometric;
      write_bytes(path, bytes);
      return kind.check(source, path);
    };
    EXPECT_EQ(stated(1), Faults{}) << format;
    EXPECT_EQ(stated(2),
              Faults{"its PhotometricInterpretation is 2, and 1 is due: grey, 0 is black"});
    EXPECT_NE(refusal_of([&] { stated(0); }).find("its grey is inverted, 0 is white"),
              std::string::npos)
        << format;
  }
}

// Of three by three tiles the pixel of one is another: the place is that in the whole file.
TEST(JudgedHeights, OfTilesAreJudgedInEachOfThem) {
  Judge judge{with_deep(20)};
  judge.options.repeat = 3;
  EXPECT_EQ(judge.of("exr", judge.design), Faults{});
  const Grid all{30, 30, 30e-6, 30e-6};
  Heightmap file = map_of(all, [&](std::size_t i) {
    return judge.design
        .z[kGrid.index(static_cast<int>(i % 30 % 10), static_cast<int>(i / 30 % 10))];
  });
  file(25, 17) -= 40e-9;
  ExportOptions whole = judge.options;
  whole.repeat = 1;
  EXPECT_EQ(judge.of("exr", file, whole),
            Faults{"1 of 900 heights are off by more than the rounding of the format, by 40 nm at "
                   "most, at (25.5, 17.5) um"});
  Heightmap less = file;
  less.grid.ny = 20, less.grid.ly = 20e-6;
  less.z.resize(less.grid.size());
  EXPECT_EQ(judge.of("exr", less, whole),
            (Faults{"its height is 20 um, the design's 30 um: 33.3 % less",
                    "30 x 20 pixels, the design's 30 x 30"}));
}

// Where a sound file is read once, its share is told each 1024 rows.
TEST(JudgedHeights, TheShareThatIsJudgedIsToldEachThousandRows) {
  std::vector<double> told;
  Judge judge{map_of({4, 2050, 1e-6, 512.5e-6},
                     [](std::size_t i) { return 1e-9 * static_cast<double>(i % 7); })};
  judge.progress = [&](double share) { told.push_back(share); };
  EXPECT_EQ(judge.of("npy", judge.design), Faults{});
  EXPECT_EQ(told, (std::vector<double>{0, 1024.0 / 2050, 2048.0 / 2050}));
}

TEST(JudgedHeights, WhatIsNoNumberIsCountedWithItsPlace) {
  const Judge judge{with_deep(20)};
  Heightmap file = with_deep(20);
  file.z[57] = file.z[58] = std::numeric_limits<double>::quiet_NaN();
  const std::string path = temporary("heightmap.npy");
  write_npy(path, file);
  const std::function<void(double)> quiet;
  const FileInfo info;
  EXPECT_EQ(find_export_format("npy").check(
                {judge.design, judge.texture, judge.options, info, quiet}, path),
            Faults{"2 of 100 heights are no finite numbers, the first in column 7 of row 5 of the "
                   "file"});
}

// What lies between two pixels is in no file, however exact its heights are.
TEST(JudgedHeights, OfFeaturesThatAreFinerThanPixelsNoMapIsSound) {
  for (const auto& [width, lost] : {std::pair{2.1e-6, false}, {1.9e-6, true}}) {
    const Judge judge{with_deep(20), Texture{HoleArray{.period = 10e-6, .diameter = width}}};
    const Faults faults = judge.of("npy", with_deep(20));
    EXPECT_EQ(faults.size(), lost ? 1u : 0u);
    if (!lost) continue;
    EXPECT_EQ(
        faults[0],
        "edges are lost between its pixels: a pixel of 1000 nm is more than half the smallest "
        "hole or wall, 1890 nm; --pixels 22 would do");
  }
}

}  // namespace
}  // namespace papilla::tests::heights_judged_test
