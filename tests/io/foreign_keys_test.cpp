// The keys of Gwyddion and of our own descriptions in images of others: sides, heights, polarity
// and steps, row by row across the strips that are read at a time.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "tests/temporary.h"

namespace papilla::tests::foreign_keys_test {
namespace {

using Keys = std::vector<std::pair<std::string, std::string>>;

template <typename T>
std::string written(const std::string& name, int nx, int ny, const Keys& keys,
                    const std::vector<T>& pixels) {
  const std::string path = temporary(name);
  OIIO::ImageSpec spec(nx, ny, 1, OIIO::TypeDescFromC<T>::value());
  if (name.ends_with(".exr")) spec.channelnames = {"Y"};
  for (const auto& [key, value] : keys) spec.attribute(key, value);
  const auto out = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(out && out->open(path, spec)) << OIIO::geterror();
  EXPECT_TRUE(out->write_image(OIIO::TypeDescFromC<T>::value(), pixels.data()));
  EXPECT_TRUE(out->close());
  return path;
}

std::string refusal(const std::string& path) {
  try {
    open_height_rows(path);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(("cannot read " + path + ": ").size());
  }
  return "";
}

constexpr const char* kNoScale =
    "an integer image without its height scale; multiply its levels by the height of one, and save "
    "a float image in um, a .gsf, or a .npy in m";

Keys gwyddion(const std::string& low, const std::string& high) {
  return {{"Gwy::XReal", "6"}, {"Gwy::YReal", "4.5"}, {"Gwy::ZMin", low},
          {"Gwy::ZMax", high}, {"Gwy::XYUnit", "um"}, {"Gwy::ZUnit", "nm"}};
}

// 6 x 4.5 um; -20 to 110 nm, or the other way round: white is deep.
TEST(ForeignKeys, OfAPngAreReadInTheirUnits) {
  const std::vector<std::uint16_t> grey{0, 13107, 26214, 39321, 52428, 65535};  // fifths
  for (const bool deep : {false, true}) {
    const double low = deep ? 110e-9 : -20e-9, high = deep ? -20e-9 : 110e-9;
    const std::string path =
        written("keys.png", 3, 2, deep ? gwyddion("110", "-20") : gwyddion("-20", "110"), grey);
    const auto rows = open_height_rows(path);
    const MapHeader& said = rows->header();
    EXPECT_NEAR(said.lx, 6e-6, 1e-18);
    EXPECT_NEAR(said.ly, 4.5e-6, 1e-18);
    EXPECT_EQ(said.polarity, deep ? Polarity::WhiteDeep : Polarity::WhiteHigh);
    EXPECT_NEAR(said.step, 130e-9 / 65535, 1e-20);
    const Heightmap h = whole_map(*rows, 0);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(h(i % 3, 1 - i / 3), low + 0.2 * i * (high - low), 1e-14) << i;
  }
  const std::vector<std::uint8_t> bytes{0, 51, 102, 153, 204, 255};
  const auto rows = open_height_rows(written("bytes.png", 3, 2, gwyddion("-20", "110"), bytes));
  EXPECT_NEAR(rows->header().step, 130e-9 / 255, 1e-20);
  EXPECT_NEAR(whole_map(*rows, 0)(1, 0), 84e-9, 1e-14);
}

TEST(ForeignKeys, OfAPngAreAllNeededAndNumbers) {
  const std::vector<std::uint16_t> grey(6, 7);
  EXPECT_EQ(refusal(written("all.png", 3, 2, gwyddion("0", "1"), grey)), "");
  for (std::size_t i = 0; i < 4; ++i) {
    Keys keys = gwyddion("0", "1");
    keys[i].second += " or so";
    EXPECT_EQ(refusal(written("words.png", 3, 2, keys, grey)), kNoScale) << i;
    keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_EQ(refusal(written("less.png", 3, 2, keys, grey)), kNoScale) << i;
  }
  // A unit that is no length counts for metres.
  Keys keys = gwyddion("0", "1");
  keys[4].second = keys[5].second = "V";
  const auto rows = open_height_rows(written("volts.png", 3, 2, keys, grey));
  EXPECT_EQ(rows->header().lx, 6);
  EXPECT_EQ(rows->header().ly, 4.5);
  EXPECT_NEAR(rows->header().step, 1.0 / 65535, 1e-15);
}

// What of a description is no number or no word of ours says nothing.
TEST(ForeignKeys, OfADescriptionAreTakenWhereTheyAreOfTheirKind) {
  const std::vector<std::uint16_t> grey{0, 65535};
  const auto said = [&](const std::string& json) {
    return open_height_rows(written("said.tif", 2, 1, {{"ImageDescription", json}}, grey))
        ->header();
  };
  const std::string scale = R"("black_m": -1e-7, "white_m": 3e-7)";
  MapHeader header =
      said(R"({"size_x_m": 6e-6, "size_y_m": 5e-6, "polarity": "white-is-high", )" + scale + "}");
  EXPECT_EQ(header.lx, 6e-6);
  EXPECT_EQ(header.ly, 5e-6);
  EXPECT_EQ(header.polarity, Polarity::WhiteHigh);
  EXPECT_NEAR(header.step, 4e-7 / 65535, 1e-20);
  header = said(R"({"size_x_m": 6e-6, "polarity": "white", )" + scale + "}");  // one side alone
  EXPECT_EQ(header.lx, 0);
  EXPECT_EQ(header.ly, 0);
  EXPECT_FALSE(header.polarity);
  header = said(R"({"size_x_m": "6e-6", "size_y_m": 5e-6, "polarity": 3, )" + scale + "}");
  EXPECT_EQ(header.lx, 0);
  EXPECT_FALSE(header.polarity);
  EXPECT_TRUE(header.top_first);
  for (const char* json :
       {R"({"black_m": 1})", R"({"white_m": 1})", R"({"black_m": "0", "white_m": 1})", "{broken"})
    EXPECT_EQ(refusal(written("none.tif", 2, 1, {{"ImageDescription", json}}, grey)), kNoScale)
        << json;
  // Floats are micrometres, whatever black and white are said to be.
  const auto rows =
      open_height_rows(written("floats.tif", 2, 1, {{"ImageDescription", "{" + scale + "}"}},
                               std::vector<float>{0.25F, -2}));
  EXPECT_EQ(rows->header().step, 0);
  const Heightmap h = whole_map(*rows, 3e-6);
  EXPECT_NEAR(h(0, 0), 0.25e-6, 1e-18);
  EXPECT_NEAR(h(1, 0), -2e-6, 1e-18);
  EXPECT_EQ(h.grid.lx, 3e-6);
  EXPECT_EQ(h.grid.ly, 1.5e-6);
}

// Levels of an instrument in whatever whole numbers: taken for micrometres they would be heights of
// a thousandth. What other programs say in a description is no scale.
template <typename T>
void expect_refused(const std::string& description) {
  const Keys keys = description.empty() ? Keys{} : Keys{{"ImageDescription", description}};
  EXPECT_EQ(refusal(written("levels.tif", 2, 2, keys, std::vector<T>{0, 1, 100, 120})), kNoScale)
      << sizeof(T) << " bytes " << description;
}

TEST(ForeignKeys, WholeNumbersOfAnyWidthNeedTheHeightsOfBlackAndWhite) {
  const std::string scale = R"({"black_m": 1e-7, "white_m": 3e-7})";
  for (const std::string other : {"", R"({"shape": [64, 64]})"}) {
    expect_refused<std::uint8_t>(other);
    expect_refused<char>(other);
    expect_refused<std::uint16_t>(other);
    expect_refused<std::int16_t>(other);
    expect_refused<std::uint32_t>(other);
    expect_refused<std::int32_t>(other);
  }
  // Of signed and of wider ones it is nowhere said what is black and what is white.
  expect_refused<std::int16_t>(scale);
  expect_refused<std::uint32_t>(scale);
  const auto rows = open_height_rows(
      written("bytes.tif", 2, 1, {{"ImageDescription", scale}}, std::vector<std::uint8_t>{0, 51}));
  EXPECT_NEAR(rows->header().step, 2e-7 / 255, 1e-20);
  EXPECT_NEAR(whole_map(*rows, 1e-6)(1, 0), 1.4e-7, 1e-14);  // a fifth of the way
  // Floats that another program described so are micrometres, as any are.
  const auto floats =
      open_height_rows(written("shape.tif", 2, 1, {{"ImageDescription", R"({"shape": [1, 2]})"}},
                               std::vector<float>{0.5F, 2}));
  EXPECT_NEAR(whole_map(*floats, 1e-6)(1, 0), 2e-6, 1e-18);
}

// 64 rows are read at a time: of 150 the last 22.
TEST(ForeignKeys, RowsAcrossStripsAreEachTheirOwn) {
  constexpr int kNx = 5, kNy = 150;
  std::vector<float> um;
  std::vector<std::uint16_t> grey;
  for (int i = 0; i < kNx * kNy; ++i) {
    um.push_back(0.5F * static_cast<float>(i));
    grey.push_back(static_cast<std::uint16_t>(80 * i));
  }
  Keys keys = gwyddion("0", "65535");
  for (const auto& [path, step] : {std::pair{written("rows.exr", kNx, kNy, {}, um), 0.5e-6},
                                   {written("rows.tif", kNx, kNy, {}, um), 0.5e-6},
                                   {written("rows.png", kNx, kNy, keys, grey), 80e-9}}) {
    const Heightmap h = whole_map(*open_height_rows(path), 1e-6);
    ASSERT_EQ(h.grid.ny, kNy);
    for (int y = 0; y < kNy; ++y) {
      for (int x = 0; x < kNx; ++x)
        ASSERT_NEAR(h(x, kNy - 1 - y), step * (y * kNx + x), 1e-11) << path << " " << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace papilla::tests::foreign_keys_test
