// What pages are made of: designs, maps and files as JSON, and the pages around them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "base/digest.h"
#include "base/error.h"
#include "base/files.h"
#include "config/describe.h"
#include "design/design.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "geometry/io/legend.h"
#include "report/fields.h"
#include "report/page.h"
#include "report/page_data.h"
#include "report/sums.h"
#include "tests/report/pixels.h"
#include "tests/report/same_json.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::page_parts_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::string kHoles = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";

Json plain(const nlohmann::ordered_json& json) { return Json::parse(json.dump()); }

std::string fresh(const std::string& name) {
  const fs::path folder = temporary(name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder.string();
}

TEST(PageFiles, AreAllButThePageItsLockAndItsTimes) {
  const std::string folder = fresh("listed");
  fs::create_directories(folder + "/sub/report");
  for (const char* name : {"b.txt", "a.txt", "sub/report/c.txt", "report.html", "timing.json",
                           ".lock", "sub/timing.json"})
    write_bytes(folder + "/" + name, "abc");
  // The digest of "abc" is the first example of the standard.
  const auto file = [](const char* name) {
    return Json{{"name", name},
                {"bytes", 3},
                {"sha256", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"}};
  };
  EXPECT_EQ(plain(file_list(Folder(folder))),
            Json::array(
                {file("a.txt"), file("b.txt"), file("sub/report/c.txt"), file("sub/timing.json")}));
}

// Holes of 3 um at 6 um: half of the row through their middles is deep.
TEST(PageShapes, ASectionGoesThroughTheWidestPlaceOfItsFeatures) {
  constexpr int kRows = 64;  // 16 over a hole
  const Design design = read_design(kHoles);
  const auto json = plain(shape_json(design.texture));
  const Grid patch = patch_grid(design.texture, 1024);
  const Json& section = json["section"];
  EXPECT_EQ(section["nx"], 1024);
  EXPECT_EQ(section["ny"], 1);
  EXPECT_DOUBLE_EQ(section["lx"].get<double>(), patch.lx);
  EXPECT_DOUBLE_EQ(section["ly"].get<double>(), patch.ly / kRows);
  const Heightmap map = generate(design.texture, {1024, kRows, patch.lx, patch.ly});
  std::vector<double> means;
  for (int y = 0; y < kRows; ++y) {
    const auto row = map.z.begin() + static_cast<std::ptrdiff_t>(map.grid.index(0, y));
    means.push_back(std::accumulate(row, row + 1024, 0.0) / 1024);
  }
  const double place = kRows * section["at"].get<double>() - 0.5;
  EXPECT_EQ(place, std::floor(place));
  const auto least = std::min_element(means.begin(), means.end());
  EXPECT_EQ(place, static_cast<double>(least - means.begin()));
  EXPECT_NEAR(*least, -300e-9, 3e-9);
  EXPECT_EQ(json["heights"]["nx"], patch_grid(design.texture, 128).nx);
  expect_same(json["measures"],
              {{"raised", false},
               {"period", {{"name", "period"}, {"value", 6e-6}}},
               {"width", {{"name", "diameter"}, {"value", 3e-6}}},
               {"depth", {{"name", "depth"}, {"value", 600e-9}}}},
              "measures");
}

TEST(PageShapes, PillarsAreRaisedAndWhatIsFlatHasNoMeasures) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml");
  EXPECT_FALSE(plain(shape_json(design.texture)).contains("measures"));
  const auto& kinds = texture_kinds();
  const auto at = std::find(kinds.begin(), kinds.end(), "pillar_array") - kinds.begin();
  design.texture = default_texture(static_cast<std::size_t>(at));
  const auto json = plain(shape_json(design.texture));
  EXPECT_EQ(json["measures"]["raised"], true);
  EXPECT_EQ(json["measures"]["depth"]["name"], "height");
  EXPECT_EQ(json["measures"]["depth"]["value"], get_number(design, "texture.height"));
  EXPECT_EQ(json["measures"]["width"]["value"], get_number(design, "texture.diameter"));
  // Through the pillars: no row is higher by more than .5 %.
  const Grid patch = patch_grid(design.texture, 1024);
  const Heightmap map = generate(design.texture, {1024, 256, patch.lx, patch.ly});
  std::vector<double> sums;
  for (int y = 0; y < 256; ++y) {
    const auto row = map.z.begin() + static_cast<std::ptrdiff_t>(map.grid.index(0, y));
    sums.push_back(std::accumulate(row, row + 1024, 0.0));
  }
  const auto row = static_cast<std::size_t>(256 * json["section"]["at"].get<double>());
  EXPECT_GE(sums.at(row), 0.995 * *std::max_element(sums.begin(), sums.end()));
}

Fidelity one_patch() {
  Fidelity f = fidelity_level("search");
  f.grid = 32, f.skins = 1;
  return f;
}

TEST(PageMaps, AreThePatchInTheirUnits) {
  Design design = read_design(kHoles);
  const PatchPicture patch = picture_patch(scene_of(design), design.texture, one_patch(), 0.75);
  const auto expect_map = [&](const Json& map, const char* name, const char* unit, double scale,
                              const std::vector<double>& values) {
    EXPECT_EQ(map["name"], name);
    EXPECT_EQ(map["unit"], unit);
    EXPECT_EQ(map["nx"], patch.texture.grid.nx);
    EXPECT_DOUBLE_EQ(map["lx"].get<double>(), patch.texture.grid.lx);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    EXPECT_NEAR(map["low"].get<double>(), *low * scale, 1e-9 * std::abs(*high * scale)) << name;
    EXPECT_NEAR(map["high"].get<double>(), *high * scale, 1e-9 * std::abs(*high * scale)) << name;
  };
  Json json = plain(maps_json(design, one_patch(), 0.75));
  EXPECT_EQ(json["relative_humidity"], 0.75);
  ASSERT_EQ(json["maps"].size(), 5u);
  const PatchFields& f = patch.fields;
  expect_map(json["maps"][0], "gap, drive off", "nm", 1e9, f.off.gap);
  expect_map(json["maps"][1], "contact pressure, drive off", "MPa", 1e-6, f.off.pressure);
  expect_map(json["maps"][2], "contact pressure, drive on", "MPa", 1e-6, f.on.pressure);
  expect_map(json["maps"][3], "pull of the field", "MPa", 1e-6, f.pull.value);
  const std::vector<double> water(f.wetting_off.bridged.begin(), f.wetting_off.bridged.end());
  expect_map(json["maps"][4], "water that bridges the gap", "", 1, water);
  EXPECT_EQ(json["maps"][4]["high"], 1);
  set_number(design, "drive.amplitude", 0);
  json = plain(maps_json(design, one_patch(), 0.75));
  ASSERT_EQ(json["maps"].size(), 3u);
  EXPECT_EQ(json["maps"][2]["name"], "water that bridges the gap");
}

// A picture and its numbers for each field at each humidity, named by both.
TEST(FieldPictures, AreTheFieldsOfOnePatchAtEachHumidity) {
  Design design = read_design(kHoles);
  design.environment.relative_humidity = {0.75};
  const std::string folder = fresh("drawn");
  write_field_pictures(folder, design, one_patch());
  const PatchPicture patch = picture_patch(scene_of(design), design.texture, one_patch(), 0.75);
  const PatchFields& f = patch.fields;
  const std::vector<double> water(f.wetting_off.bridged.begin(), f.wetting_off.bridged.end());
  const FieldScale pressure{1e-6, "MPa", true};
  const auto expect_pair = [&](const std::string& name, const std::vector<double>& values,
                               const FieldScale& scale) {
    const std::string path = folder + "/" + name + "_75";
    const Heightmap back = read_heightmap(path + ".npy", patch.texture.grid.lx);
    EXPECT_EQ(back.z, values) << name;
    const FieldPicture drawn = picture_with_legend(patch.texture.grid, values, scale);
    const Pixels image = pixels_of(path + ".png");
    EXPECT_EQ(image.width, drawn.width);
    EXPECT_EQ(image.height, drawn.height);
    EXPECT_TRUE(image.rgb == drawn.rgb) << name;
  };
  expect_pair("gap", f.off.gap, {1e9, "nm"});
  expect_pair("pressure_off", f.off.pressure, pressure);
  expect_pair("pressure_on", f.on.pressure, pressure);
  expect_pair("pull", f.pull.value, {1e-3, "kPa"});
  expect_pair("water", water, {});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 10);
}

// One set for each humidity, also of those that round to one number.
TEST(FieldPictures, OfNearHumiditiesHaveNamesOfTheirOwn) {
  Design design = read_design(kHoles);
  design.environment.relative_humidity = {0.5, 0.503, 0.75};
  design.environment.weights.clear();
  const std::string folder = fresh("near");
  write_field_pictures(folder, design, one_patch());
  for (const char* name : {"gap_50.0", "gap_50.3", "gap_75.0"})
    EXPECT_TRUE(fs::exists(folder + "/" + name + ".png")) << name;
}

// The data of a page, and what stands in it without scripts.
struct ReadPage {
  std::string text, plain_part;
  Json data;

  explicit ReadPage(const std::string& page) : text(page) {
    const std::string mark = "id=\"data\">";
    const std::size_t at = page.find(mark) + mark.size();
    data = Json::parse(page.substr(at, page.find("</script>", at) - at));
    const std::size_t begin = page.find("<noscript>"), end = page.find("</noscript>");
    plain_part = page.substr(begin, end - begin);
  }
};

TEST(Pages, OfAFitHoldItAndItsFiles) {
  const std::string folder = fresh("a_fit");
  write_bytes(folder + "/fit.json",
              R"({"title": "a <b> & c", "check_skins": 3, "parameters": [], "x": "</script>"})");
  write_bytes(folder + "/fit.md", "# Fit\n\n| a |\n|---|\n| <1> |\n");
  const ReadPage page(report_page(folder));
  EXPECT_EQ(page.data["fit"]["x"], "</script>");
  EXPECT_EQ(page.data["schema"], 1);
  EXPECT_EQ(page.data["version"], PAPILLA_VERSION);
  EXPECT_EQ(page.data["files"], plain(file_list(Folder(folder))));
  EXPECT_EQ(page.data.size(), 4u);
  EXPECT_NE(page.text.find("<title>a &lt;b> &amp; c</title>"), std::string::npos);
  EXPECT_NE(page.text.find("<h1>a &lt;b> &amp; c</h1>"), std::string::npos);
  EXPECT_TRUE(page.plain_part.ends_with(
      "</style>\n<div class=\"scroll\"><table>\n<tr><th>a</th></tr>\n<tr><td>&lt;1></td></tr>\n"
      "</table></div>\n"))
      << page.plain_part;
  // Every mark of the frame was filled, and the modules are one script.
  EXPECT_EQ(page.text.find("{{"), page.text.find("{{", page.text.find("</html>")));
  EXPECT_EQ(page.text.find("\nexport "), std::string::npos);
  EXPECT_EQ(page.text.find("\nimport "), std::string::npos);
  for (const char* script : {"look.js", "numbers.js", "curves.js", "found.js"})
    EXPECT_EQ(page.text.find(std::string("from './") + script), std::string::npos);
  EXPECT_NE(page.text.find("\nfunction "), std::string::npos);
  EXPECT_TRUE(page.text.ends_with("</html>\n"));
  write_bytes(folder + "/fit.json", R"({"check_skins": 3, "parameters": []})");
  EXPECT_NE(report_page(folder).find("<title>a_fit</title>"), std::string::npos);
  EXPECT_EQ(refusal_of([&] { report_page(folder, "knee"); }),
            "--pick is for a folder of `papilla optimize`");
  for (const char* old : {R"({"check_skins": 3})", R"({"parameters": []})"}) {
    write_bytes(folder + "/fit.json", old);
    EXPECT_EQ(refusal_of([&] { report_page(folder); }),
              folder + ": fit.json is of another version; run `papilla calibrate` again");
  }
  write_bytes(folder + "/fit.json", "{");
  EXPECT_TRUE(
      refusal_of([&] { report_page(folder); }).starts_with(folder + "/fit.json is damaged"));
}

// By the sums beside them; of a folder without sums nothing is said.
TEST(Pages, SayWhatIsNotAsTheRunWroteIt) {
  const std::string folder = fresh("summed");
  const Folder place(folder);
  const std::string fit = R"({"check_skins": 3, "parameters": []})";
  place.write("fit.json", fit);
  place.write("fit.md", "# Fit\n");
  place.made_below("deep").write("table.csv", "a\n1\n");
  place.write("journal", "grows");
  place.write("timing.json", "1");
  place.write("log.txt", "2");
  const auto said = [&] {
    const std::string text = report_page(folder),
                      mark = "Not as the run wrote them, or not to be read: ";
    const std::size_t at = text.find(mark);
    if (at == text.npos) return std::string();
    const std::size_t from = at + mark.size();
    return text.substr(from, text.find(". This page", from) - from);
  };
  EXPECT_EQ(said(), "");
  write_sums(place);
  EXPECT_EQ(place.read(kSumsName), sha256("a\n1\n") + "  deep/table.csv\n" + sha256(fit) +
                                       "  fit.json\n" + sha256("# Fit\n") + "  fit.md\n");
  place.write("report.html", "the page");
  place.write("journal", "grew");
  place.write("timing.json", "3");
  place.write("log.txt", "4");
  place.write("more.txt", "of the user");
  EXPECT_EQ(said(), "");
  place.write("deep/table.csv", "a\n2\n");
  EXPECT_EQ(said(), "deep/table.csv");
  place.remove("fit.md");
  EXPECT_EQ(said(), "deep/table.csv, fit.md");
  place.write("deep/table.csv", "a\n1\n");
  place.write("fit.md", "# Fit\n");
  EXPECT_EQ(said(), "");
  // A name of the sums that leads out is none of theirs.
  place.write(kSumsName, sha256("x") + "  ../../etc/passwd\n");
  EXPECT_THROW(report_page(folder), InputError);
}

// What a link leads to is no part of a folder.
TEST(Pages, FollowNoLinkOfTheirFolder) {
  const std::string folder = fresh("linked"), outside = fresh("outside");
  write_bytes(outside + "/fit.json", R"({"check_skins": 3, "parameters": [], "x": "secret"})");
  write_bytes(outside + "/mine.html", "mine");
  fs::create_symlink(outside + "/fit.json", folder + "/fit.json");
  EXPECT_THROW(report_page(folder), InputError);
  fs::create_symlink(outside + "/mine.html", folder + "/report.html");
  write_bytes(folder + "/report.html", "the page");
  EXPECT_EQ(read_bytes(outside + "/mine.html"), "mine");
  fs::remove(folder + "/fit.json");
  write_bytes(folder + "/fit.json", R"({"check_skins": 3, "parameters": []})");
  fs::create_symlink(outside + "/fit.json", folder + "/fit.md");
  fs::create_directory_symlink(outside, folder + "/deep");
  const std::string page = report_page(folder);
  EXPECT_EQ(page.find("secret"), std::string::npos);
  EXPECT_EQ(page.find("mine.html"), std::string::npos);
}

TEST(Pages, OfARankingHaveEachDesignUnderItsName) {
  const std::string folder = fresh("a_ranking");
  fs::create_directories(folder + "/designs");
  fs::copy_file(kHoles, folder + "/designs/01.toml");
  fs::copy_file(PAPILLA_DESIGNS_DIR "/m3_samples/common.toml", folder + "/designs/common.toml");
  fs::copy_file(PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml", folder + "/designs/02.toml");
  write_bytes(folder + "/ranking.json",
              R"json({"seconds": 3, "candidates": [{"index": 1, "name": "two"},
                      {"index": 0, "name": "one"}], "criteria": [{"metric": "mean(a)"},
                      {"metric": "b"}], "states": [1]})json");
  write_bytes(folder + "/ranking.txt", "one < two\n");
  const ReadPage page(report_page(folder));
  EXPECT_EQ(
      page.data["ranking"],
      Json::parse(
          R"json({"criteria": [{"metric": "mean(a)"}, {"metric": "b"}], "states": [1]})json"));
  ASSERT_EQ(page.data["candidates"].size(), 2u);
  EXPECT_EQ(page.data["candidates"][0]["name"], "one");
  EXPECT_EQ(page.data["candidates"][0]["toml"], read_bytes(kHoles));
  EXPECT_NEAR(page.data["candidates"][0]["heights"]["low"].get<double>(), -600e-9, 1e-12);
  EXPECT_EQ(page.data["candidates"][1]["name"], "two");
  EXPECT_EQ(page.data["candidates"][1]["heights"]["low"], 0);
  EXPECT_NE(page.text.find("<title>2 designs by mean(a), b</title>"), std::string::npos);
  EXPECT_TRUE(page.plain_part.ends_with("<pre>one &lt; two\n</pre>\n")) << page.plain_part;
  write_bytes(folder + "/ranking.json", R"({"candidates": [{"index": 1, "name": "two"}]})");
  EXPECT_TRUE(
      refusal_of([&] { report_page(folder); }).starts_with(folder + ": ranking.json is damaged: "));
}

// The scan is 20 um wide, its patch 12 um.
TEST(Pages, OfARankingSayWhichPartOfAMapTheyShow) {
  const std::string folder = fresh("a_ranking_of_maps");
  fs::create_directories(folder + "/designs");
  const auto design = [&](const char* name, const std::string& place) {
    write_bytes(folder + "/designs/" + name,
                "schema_version = 1\n[texture]\ntype = \"measured\"\nfile = "
                "\"" PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf\"\n" +
                    place);
  };
  design("01.toml", "");
  design("02.toml", "at_x = \"2 um\"\nat_y = \"-1 um\"\n");
  design("03.toml", "patch = \"20 um\"\n");
  write_bytes(folder + "/ranking.json",
              R"json({"candidates": [{"index": 0, "name": "a"}, {"index": 1, "name": "b"},
                      {"index": 2, "name": "c"}], "criteria": [], "states": [1]})json");
  write_bytes(folder + "/ranking.txt", "a\n");
  const ReadPage page(report_page(folder));
  const Json& shown = page.data["candidates"];
  EXPECT_EQ(shown[0]["shown"], "12 x 12 um in the middle of its map of 20 x 20 um");
  EXPECT_EQ(shown[1]["shown"],
            "12 x 12 um round (2, -1) um from the middle of its map of 20 x 20 um");
  EXPECT_FALSE(shown[2].contains("shown"));
}

Json list_of(const Json& one) {
  Json out = Json::array();
  out.push_back(one);
  return out;
}

// The folder of a run, made up: a best design, and a front of two.
TEST(Pages, OfARunHoldItsDesignsAndTables) {
  const std::string folder = fresh("a_run");
  const std::string design =
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[accuracy]\nlevel = \"draft\"\n"
      "grid = 32\n[environment]\nrelative_humidity = [\"35 %\"]\n";
  const Json point{{"relative_humidity", 0.35},
                   {"weight", 1},
                   {"F_off", 2},
                   {"F_on", 3},
                   {"modulation", 4},
                   {"capillary_force", 5},
                   {"electrostatic_force", 6},
                   {"status", "ok"},
                   {"left_out", 7}};
  Json shown = point;
  shown.erase("left_out");
  const Json response{{"points", list_of(point)}, {"plan", {{"seconds", 8}}}};
  Json other_point = point, other_shown = shown;
  other_point["F_off"] = other_shown["F_off"] = 20;
  const Json task{{"name", "a finger"},
                  {"weight", 0.25},
                  {"response", response},
                  {"flat", {{"points", list_of(other_point)}}}};
  const Json objectives{{"o", {{"value", 2}, {"maximise", true}}}};
  Json metrics{{"title", "a run"},         {"variables", {{"v", 1}}},
               {"objectives", objectives}, {"feasible", true},
               {"worst_modulation", 0.25}, {"tasks", list_of(task)},
               {"flat", {{"a", 3}}},       {"left_out", 4}};
  Heightmap map{{4, 2, 4e-6, 2e-6}, {0, -1e-7, -2e-7, 0, 0, 0, 0, 0}};
  for (const char* name : {"best", "front/02", "front/01"}) {
    const std::string place = folder + "/" + name;
    fs::create_directories(place);
    write_bytes(place + "/design.toml", design);
    write_bytes(place + "/metrics.json", metrics.dump());
    write_gsf(place + "/heightmap.gsf", map, {});
  }
  for (const char* name : {"pareto.csv", "history.csv", "plan.txt", "summary.md"})
    write_bytes(folder + "/" + name, std::string("text of ") + name);
  write_bytes(folder + "/run.json", R"({"recommendation": "Build it."})");
  const ReadPage page(report_page(folder));
  EXPECT_NE(page.text.find("<title>a run</title>"), std::string::npos);
  for (const char* name : {"pareto", "history"})
    EXPECT_EQ(page.data[name], std::string("text of ") + name + ".csv");
  EXPECT_EQ(page.data["plan"], "text of plan.txt");
  EXPECT_EQ(page.data["summary"], "text of summary.md");
  EXPECT_EQ(page.data["run"]["recommendation"], "Build it.");
  EXPECT_TRUE(page.plain_part.ends_with("<p>text of summary.md</p>\n"));
  EXPECT_EQ(page.data["fields"].size(), 1u);
  EXPECT_EQ(page.data["fields"][0]["relative_humidity"], 0.35);
  EXPECT_EQ(page.data["designs"].size(), 3u);
  Json best = page.data["designs"]["best"], front = page.data["designs"]["front/02"];
  const Json section = best["section"];
  EXPECT_EQ(section["nx"], 4096);
  EXPECT_EQ(best["heights"]["nx"], 4);
  EXPECT_NEAR(best["heights"]["low"].get<double>(), -2e-7, 1e-13);
  EXPECT_EQ(best["toml"], design);
  EXPECT_EQ(best["plan"], (Json{{"seconds", 8}}));
  for (const char* key : {"section", "measures", "heights", "toml"})
    EXPECT_EQ(best.erase(key) + front.erase(key), 2u) << key;
  Json expected{
      {"variables", {{"v", 1}}},
      {"objectives", objectives},
      {"worst_modulation", 0.25},
      {"feasible", true},
      {"flat", {{"a", 3}}},
      {"tasks", list_of({{"name", "a finger"}, {"weight", 0.25}, {"points", list_of(shown)}})}};
  EXPECT_EQ(front, expected);
  expected["tasks"][0]["flat"] = list_of(other_shown);
  expected["plan"] = {{"seconds", 8}};
  EXPECT_EQ(best, expected);
  EXPECT_FALSE(page.data.contains("picked"));
  // Of another design of the front, whose build sheet the run has not.
  metrics["title"] = "the second";
  write_bytes(folder + "/front/02/metrics.json", metrics.dump());
  const ReadPage picked(report_page(folder, "2"));
  EXPECT_NE(picked.text.find("<title>the second</title>"), std::string::npos);
  EXPECT_EQ(picked.data["picked"], "front/02");
  EXPECT_NE(picked.text.find("This page shows design 02, which was picked for it."),
            std::string::npos);
  // What is picked is what the run recommends anyway.
  write_bytes(folder + "/run.json", R"({"recommendation": "Build it.", "design": "front/02"})");
  EXPECT_EQ(report_page(folder, "2"), report_page(folder));
  fs::remove(folder + "/plan.txt");
  EXPECT_EQ(refusal_of([&] { report_page(folder); }),
            folder + " has no plan.txt: not the folder of a finished `papilla optimize`");
}

TEST(Pages, OfAnUnfinishedSearchHoldItsStudy) {
  const std::string folder = fresh("unfinished");
  write_bytes(folder + "/study.toml",
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\ntitle = \"mine\"\n");
  const ReadPage page(unfinished_page(folder, {{"state", "running"}}));
  EXPECT_NE(page.text.find("<title>mine</title>"), std::string::npos);
  EXPECT_EQ(page.data["search"], (Json{{"state", "running"}}));
  EXPECT_EQ(page.data["study"], read_bytes(folder + "/study.toml"));
}

// Without scripts too: how far it is, the front in the units that people read, the study.
TEST(Pages, OfAnUnfinishedSearchSayWithoutScriptsWhatWasFound) {
  const std::string folder = fresh("unfinished_plain");
  write_bytes(folder + "/study.toml",
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\ntitle = \"mine\"\n");
  const auto point = [](double friction, const char* depth) {
    return Json{{"values", Json::array({depth})},
                {"objectives", Json::array({friction})},
                {"ok", true},
                {"feasible", true}};
  };
  const Json depth{{"path", "texture.depth"}, {"unit", "nm"}},
      friction{{"name", "mean(friction)"}, {"maximise", false}, {"scale", 1e3}, {"unit", "mN"}};
  Json search{
      {"state", "paused"},
      {"done", 3},
      {"total", 30},
      {"trouble", ""},
      {"variables", Json::array({depth})},
      {"objectives", Json::array({friction})},
      {"points", Json::array({point(0.2, "300 nm"), point(0.1234, "250 nm"), point(0.3, "1 nm")})},
      {"front", Json::array({1})}};
  const auto without_scripts = [&] {
    const std::string text = unfinished_page(folder, search);
    const std::size_t begin = text.find("<noscript>");
    return text.substr(begin, text.find("</noscript>") - begin);
  };
  const std::string told = without_scripts();
  for (const char* part : {"Not finished: 3 of 30 designs were judged. The search is paused.",
                           "<th>mean(friction) [mN]</th><th>texture.depth</th>",
                           "<td>123</td><td>250 nm</td>", "title = \"mine\""})
    EXPECT_NE(told.find(part), std::string::npos) << part << "\n" << told;
  EXPECT_EQ(told.find("300 nm"), std::string::npos);
  EXPECT_EQ(told.find("No design keeps"), std::string::npos);
  search["front"] = Json::array({0, 1});  // as they were judged; the least friction is the best
  EXPECT_LT(without_scripts().find("250 nm"), without_scripts().find("300 nm"));
  search["front"] = Json::array({1});
  search["points"][1]["feasible"] = false;
  EXPECT_NE(without_scripts().find("No design keeps every limit yet: the nearest is shown."),
            std::string::npos);
  search["points"][1]["objectives"] = Json::array({1.234});
  EXPECT_NE(without_scripts().find("<td>1230</td>"), std::string::npos);
  // The nearest of designs that were all refused before an evaluation has no numbers.
  search["points"][1]["ok"] = false;
  search["points"][1]["objectives"] = Json::array();
  EXPECT_NE(without_scripts().find("<td></td><td>250 nm</td>"), std::string::npos)
      << without_scripts();
  // Of designs that all failed not even that.
  search["front"] = Json::array();
  search["state"] = "failed";
  search["trouble"] = "error: one\nanother\n";
  for (const char* part :
       {"The search has failed. No design", "has that.</p>\n<p>error: one</p>\n<p>another</p>\n",
        "No design that was judged has an answer yet."})
    EXPECT_NE(without_scripts().find(part), std::string::npos) << part << "\n" << without_scripts();
}

}  // namespace
}  // namespace papilla::tests::page_parts_test
