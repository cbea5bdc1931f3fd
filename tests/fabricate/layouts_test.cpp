// Layouts and bodies of triangles that were changed a little: what is said is what was done.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>

#include "base/constants.h"
#include "geometry/io/drawing.h"
#include "tests/fabricate/exported_folder.h"

namespace papilla::tests::layouts_test {
namespace {

std::string faults_of(const Folder& folder, const std::string& name) {
  std::string out;
  for (const FileVerdict& file : verify_folder(folder.path(), name)) {
    for (const std::string& fault : file.faults) out += fault + "\n";
  }
  return out;
}

// What is said of texture.gds and, as it must, alike of texture.oas.
std::string said(const Folder& folder, const std::function<void(Layout&)>& change) {
  const std::string gds = folder.path() + "/texture.gds", oasis = folder.path() + "/texture.oas";
  Layout layout = read_gds(gds);
  change(layout);
  write_gds(gds, layout);
  write_oasis(oasis, layout);
  const std::string out = faults_of(folder, "texture.gds");
  EXPECT_EQ(faults_of(folder, "texture.oas"), out);
  folder.restore();
  return out;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

HoleArray holes() {
  HoleArray out;
  out.period = 6e-6, out.diameter = 3e-6;
  return out;
}

Grating grooves() {
  Grating out;
  out.period = 4e-6, out.width = 1.5e-6, out.depth = 120e-9;
  return out;
}

TEST(ChangedLayouts, OfASquareArrayAreSaidByWidthPlaceAndNumber) {
  const Workplace place;
  const Folder folder(place.path() / "f", Texture{holes()}, Polarity::WhiteDeep);
  EXPECT_EQ(said(folder, [](Layout&) {}), "");
  const auto reference = [](Layout& l) -> LayoutReference& {
    return l.cells.back().references.at(0);
  };
  const auto outline = [](Layout& l) -> Polygon& { return l.cells[0].polygons.at(0).outline; };
  // A nanometre is within the rounding of places.
  EXPECT_EQ(said(folder, [&](Layout& l) { reference(l).x += 1; }), "");
  std::string why = said(folder, [&](Layout& l) { reference(l).x += 30, reference(l).y -= 40; });
  EXPECT_TRUE(has(why, "its holes are up to 50 nm off their places")) << why;
  // A pitch that is wrong by 5 nm: the last of two columns is off by it.
  for (const int by : {5, -5}) {
    why = said(folder, [&](Layout& l) { reference(l).step_x += by; });
    EXPECT_TRUE(has(why, "up to 5 nm off")) << why;
  }
  why = said(folder, [&](Layout& l) { reference(l).step_y += 7; });
  EXPECT_TRUE(has(why, "up to 7 nm off their places, in the row that begins at (3, 9) um")) << why;
  why = said(folder, [&](Layout& l) { reference(l).columns -= 1; });
  EXPECT_TRUE(has(why, "2 polygons, the design's 4")) << why;
  why = said(folder, [&](Layout& l) { l.cells[0].polygons.at(0).layer = 7; });
  EXPECT_TRUE(has(why, "layer 7 in place of 1")) << why;
  why = said(folder, [&](Layout& l) { outline(l).x.at(0) += 100; });
  EXPECT_TRUE(has(why, "a corner of its holes is 9")) << why;
}

TEST(ChangedLayouts, OfGroovesAreSaidByBothTheirSides) {
  const Workplace place;
  const Folder folder(place.path() / "f", Texture{grooves()}, Polarity::WhiteDeep);
  EXPECT_EQ(said(folder, [](Layout&) {}), "");
  const auto outline = [](Layout& l) -> Polygon& { return l.cells[0].polygons.at(0).outline; };
  std::string why = said(folder, [&](Layout& l) {
    for (auto& x : outline(l).x) x += x > 2000 ? 150 : 0;
  });
  EXPECT_TRUE(has(why,
                  "its critical dimension (width of the grooves) is 1.65 um, the design's 1.5 "
                  "um: 10 % more"))
      << why;
  EXPECT_TRUE(has(why, "its grooves are up to 75 nm off")) << why;
  why = said(folder, [&](Layout& l) {
    for (auto& y : outline(l).y) y += 60;
  });
  EXPECT_TRUE(has(why, "its grooves are up to 60 nm off")) << why;
  EXPECT_TRUE(has(why, "(2, 6) um")) << why;  // the middle of their height
  EXPECT_FALSE(has(why, "critical dimension")) << why;
}

TEST(ChangedLayouts, OfContoursNameThePolygonThatIsAnother) {
  const Workplace place;
  Stack stack;
  RandomRough rough;
  rough.rms = 30e-9;
  stack.parts = {Texture{holes()}, Texture{rough}};
  const Folder folder(place.path() / "f", Texture{stack}, Polarity::WhiteDeep);
  EXPECT_EQ(said(folder, [](Layout&) {}), "");
  std::size_t all = 0;
  const std::string why = said(folder, [&](Layout& l) {
    all = l.cells[0].polygons.size();
    l.cells[0].polygons.at(5).outline.x.at(0) += 3;
  });
  EXPECT_TRUE(has(why, "1 of the design's " + std::to_string(all) +
                           " polygons are not there and 1 are there that it does not have"))
      << why;
}

// A binary STL: 84 bytes, then triangles of 50 whose corners begin 12 bytes in, in micrometres.
TEST(ChangedBodies, AreSaidByTheirCorners) {
  const Workplace place;
  const Folder folder(place.path() / "f", Texture{holes()}, Polarity::WhiteDeep);
  const std::string path = folder.path() + "/" + find_export_format("stl").file;
  const std::string sound = read_bytes(path);
  EXPECT_EQ(faults_of(folder, find_export_format("stl").file), "");
  const auto changed = [&](std::size_t triangle, std::size_t number, float by) {
    std::string bytes = sound;
    char* at = bytes.data() + 84 + 50 * triangle + 12 + 4 * number;
    float value = 0;
    std::memcpy(&value, at, 4);
    value += by;
    std::memcpy(at, &value, 4);
    write_bytes(path, bytes);
    const std::string out = faults_of(folder, find_export_format("stl").file);
    write_bytes(path, sound);
    return out;
  };
  for (const std::size_t number : {0u, 1u, 2u, 5u, 8u}) {
    for (const float by : {0.01F, -0.01F})
      EXPECT_TRUE(has(changed(400, number, by), "1 corners are off the surface, by 10 nm at most"))
          << number << ": " << changed(400, number, by);
  }
  write_bytes(path, sound.substr(0, sound.size() - 50));
  EXPECT_NE(faults_of(folder, find_export_format("stl").file), "");
}

// The volume above a base that lies 1 um below the lowest place.
TEST(ChangedBodies, AreSaidByTheirVolumeAndSides) {
  const Workplace place;
  const Folder folder(place.path() / "f", Texture{holes()}, Polarity::WhiteDeep);
  const Heightmap& design = folder.made().heightmap;
  const std::string name = find_export_format("stl").file;
  const auto volume = [](const Heightmap& h) {  // um3
    const double base = *std::min_element(h.z.begin(), h.z.end()) - 1e-6;
    double sum = 0;
    for (const double z : h.z) sum += 1e18 * (z - base) * h.grid.pixel_area();
    return sum;
  };
  const auto why = [&](const Heightmap& h) {
    write_again({"stl", folder.path() + "/" + name}, h, folder.made().texture, folder.options());
    return faults_of(folder, name);
  };
  for (const double times : {0.5, 1.5}) {
    Heightmap h = design;
    for (double& z : h.z) z *= times;
    const std::string said = why(h);
    const std::size_t at = said.find("its volume is ");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NEAR(std::stod(said.substr(at + 14)), volume(h), 0.01 * volume(h));
    const std::size_t wanted = said.find("um3, the design's ", at);
    ASSERT_NE(wanted, std::string::npos) << said;
    EXPECT_NEAR(std::stod(said.substr(wanted + 18)), volume(design), 1e-3 * volume(design));
    EXPECT_TRUE(has(said, times < 1 ? "% less" : "% more")) << said;
  }
  for (const double times : {0.5, 2.0}) {
    Heightmap wide = design, high = design;
    wide.grid.lx *= times, high.grid.ly *= times;
    const char* words = times < 1 ? "is 6 um, the design's 12 um: 50 % less"
                                  : "is 24 um, the design's 12 um: 100 % more";
    EXPECT_TRUE(has(why(wide), std::string("its width ") + words)) << why(wide);
    EXPECT_FALSE(has(why(wide), "its height")) << why(wide);
    EXPECT_TRUE(has(why(high), std::string("its height ") + words)) << why(high);
  }
  folder.restore();
  EXPECT_EQ(faults_of(folder, name), "");
  write_bytes(folder.path() + "/" + name,
              read_bytes(folder.path() + "/" + name) + std::string(50, '\0'));
  EXPECT_EQ(faults_of(folder, name), "more after its last triangle\n");
}

}  // namespace
}  // namespace papilla::tests::layouts_test
