// What the studio answers to a page, as whole documents.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "base/files.h"
#include "design/design.h"
#include "forward/forward.h"
#include "report/page_data.h"
#include "tests/studio/loopback.h"
#include "tests/temporary.h"

namespace papilla::tests::answers_test {
namespace {

using Json = nlohmann::json;

class Answers : public ::testing::Test {
 protected:
  Json ask(const std::string& path, const Json& body = Json::object()) {
    const HttpAnswer out = studio_.answer({"POST", path, "", body.dump()});
    EXPECT_EQ(out.status, 200) << path;
    EXPECT_EQ(out.type, "application/json");
    return Json::parse(out.body);
  }
  Json state() { return Json::parse(studio_.answer({"GET", "/state", "", ""}).body); }
  // The session without its form and its count.
  Json session() {
    Json out = state()["session"];
    out.erase("keys"), out.erase("revision");
    return out;
  }

  const TemporaryFolder folder_;
  Studio studio_{studio_options(folder_.path().string())};
};

TEST_F(Answers, TellTheStateOfTheSession) {
  const std::uint64_t first = state()["session"]["revision"];
  Json expected{{"title", "Published sample: holes of 3 um, 600 nm deep, period 6 um"},
                {"file", "a3h600.toml"},
                {"in_folder", false},
                {"kind", "hole_array"},
                {"driven", true},
                {"changes", Json::array()},
                {"undo", false},
                {"redo", false},
                {"steps", Json::array()},
                {"done", 0},
                {"pins", Json::array()}};
  EXPECT_EQ(session(), expected);
  EXPECT_EQ(ask("/set", {{"path", "texture.depth"}, {"value", "262 nm"}}),
            (Json{{"revision", first + 1}}));
  EXPECT_EQ(ask("/pin", {{"name", "mine"}}), (Json{{"pin", 1}}));
  EXPECT_EQ(ask("/set", {{"path", "drive.amplitude"}, {"value", "0"}}),
            (Json{{"revision", first + 2}}));
  expected["changes"] = Json::parse(R"([["texture.depth", "262 nm"], ["drive.amplitude", "0 V"]])");
  expected["title"] =
      expected["title"].get<std::string>() + "; texture.depth 262 nm; drive.amplitude 0 V";
  expected["undo"] = true, expected["driven"] = false;
  expected["steps"] = {"depth 262 nm", "amplitude 0 V"}, expected["done"] = 2;
  expected["pins"] = Json::array({{{"number", 1}, {"name", "mine"}, {"readable", true}}});
  EXPECT_EQ(session(), expected);
  EXPECT_EQ(ask("/undo"), (Json{{"revision", first + 3}}));
  EXPECT_EQ(session()["redo"], true);
  EXPECT_EQ(ask("/redo"), (Json{{"revision", first + 4}}));
  EXPECT_EQ(session(), expected);
  EXPECT_EQ(ask("/history", {{"done", 3}})["problems"][0]["message"],
            "the history has no step of that number");
  EXPECT_EQ(session(), expected);
  EXPECT_EQ(ask("/take", {{"pin", 1}}), (Json{{"revision", first + 5}}));
  EXPECT_EQ(session()["changes"], Json::parse(R"([["texture.depth", "262 nm"]])"));
  EXPECT_EQ(ask("/unpin", {{"pin", 1}}), (Json{{"revision", first + 5}}));
  EXPECT_EQ(session()["pins"], Json::array());
  EXPECT_EQ(ask("/reset", {{"path", "texture.depth"}}), (Json{{"revision", first + 6}}));
  EXPECT_EQ(ask("/kind", {{"kind", "pillar_array"}}), (Json{{"revision", first + 7}}));
  EXPECT_EQ(session()["kind"], "pillar_array");
  // Two moves of one gesture are one step back.
  ask("/set", {{"path", "texture.height"}, {"value", "500 nm"}, {"step", 9}});
  ask("/set", {{"path", "texture.height"}, {"value", "400 nm"}, {"step", 9}});
  ask("/undo");
  EXPECT_EQ(session()["kind"], "pillar_array");
  EXPECT_TRUE(session()["redo"].get<bool>());
}

TEST_F(Answers, OfferTheKindsThatNumbersDescribe) {
  const Json kinds = state()["kinds"];
  ASSERT_GE(kinds.size(), 4u);
  for (const Json& kind : kinds) {
    EXPECT_NE(kind["kind"], "measured");
    EXPECT_EQ(std::max(kind["heights"]["nx"].get<int>(), kind["heights"]["ny"].get<int>()), 48)
        << kind["kind"];
    EXPECT_EQ(kind.size(), 2u);
  }
}

TEST_F(Answers, SaveOpenAndListTheFilesOfTheFolder) {
  ask("/set", {{"path", "texture.depth"}, {"value", "262 nm"}});
  EXPECT_EQ(ask("/save", {{"name", "sub/mine.toml"}}), (Json{{"file", "sub/mine.toml"}}));
  EXPECT_EQ(session()["file"], "sub/mine.toml");
  EXPECT_EQ(session()["in_folder"], true);
  EXPECT_EQ(session()["changes"], Json::array());
  EXPECT_EQ(ask("/files")["designs"], Json({"sub/mine.toml"}));
  const Json refused = ask("/save", {{"name", "sub/mine.toml"}});
  EXPECT_EQ(refused["problems"],
            Json::parse(R"([{"key": "", "message": "is there already: overwrite it, or choose )"
                        R"(another name"}])"));
  ask("/set", {{"path", "texture.depth"}, {"value", "300 nm"}});
  ask("/save", {{"name", "sub/mine.toml"}, {"overwrite", true}});
  ask("/save", {{"name", "other.toml"}});
  ask("/open", {{"name", "sub/mine.toml"}});
  EXPECT_EQ(read_design((folder_.path() / "sub/mine.toml").string()).texture,
            read_design((folder_.path() / "other.toml").string()).texture);
  EXPECT_EQ(session()["file"], "sub/mine.toml");
  EXPECT_EQ(ask("/export/preview")["aspect_ratio"]["limit"], nullptr);
}

TEST_F(Answers, NameTheKeyThatIsWrong) {
  const Json refused = ask("/set", {{"path", "texture.depth"}, {"value", "fast"}});
  EXPECT_EQ(refused["problems"],
            Json::parse(R"([{"key": "texture.depth", "message": "expected a number in nm"}])"));
  EXPECT_EQ(refused["error"], "texture.depth: expected a number in nm");
  EXPECT_EQ(ask("/take", {{"pin", 5}})["error"], "no design is pinned under this number");
  for (const auto& [method, path, body, status] : {std::tuple{"POST", "/nothing", "{}", 404},
                                                   {"GET", "/set", "", 404},
                                                   {"POST", "/state", "", 404},
                                                   {"POST", "/set", "{", 400},
                                                   {"POST", "/set", "[]", 400},
                                                   {"POST", "/set", "{}", 400},
                                                   {"POST", "/take", R"({"pin": "x"})", 400},
                                                   {"GET", "/report/searches/001", "", 404},
                                                   {"GET", "/page/nothing.js", "", 404}})
    EXPECT_EQ(studio_.answer({method, path, "", body}).status, status) << path << body;
  const HttpAnswer page = studio_.answer({"GET", "/", "", ""});
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_FALSE(page.whole_page);
}

// A pinned file that goes while the studio works is said; all else goes on.
TEST_F(Answers, GoOnWithoutTheFileOfAPin) {
  ask("/save", {{"name", "old.toml"}});
  ask("/pin", {{"name", "old"}});
  ask("/save", {{"name", "new.toml"}});
  ask("/pin", {{"name", "new"}});
  std::filesystem::remove(folder_.path() / "old.toml");
  const Json set = ask("/set", {{"path", "texture.depth"}, {"value", "262 nm"}});
  EXPECT_EQ(set["revision"], state()["session"]["revision"]);
  EXPECT_EQ(session()["pins"], Json::array({{{"number", 1}, {"name", "old"}, {"readable", false}},
                                            {{"number", 2}, {"name", "new"}, {"readable", true}}}));
  EXPECT_TRUE(ask("/take", {{"pin", 1}}).contains("error"));
  EXPECT_EQ(ask("/unpin", {{"pin", 1}}), set);
}

// At the nearest humidity of the design, at draft level.
TEST_F(Answers, DrawTheMapsOfTheNearestHumidity) {
  ask("/set", {{"path", "environment.relative_humidity"}, {"value", "20 %, 50 %, 90 %"}});
  const std::uint64_t revision = state()["session"]["revision"];
  const Json maps = ask("/maps", {{"humidity", 0.38}});
  EXPECT_EQ(maps["relative_humidity"], 0.5);
  EXPECT_EQ(maps["revision"], revision);
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  const Json expected = Json::parse(maps_json(design, fidelity_level("draft"), 0.5).dump());
  EXPECT_EQ(maps["maps"], expected["maps"]);
}

// Each event is a line of JSON; the first answer to a wish names its step.
TEST_F(Answers, AreToldAsOneLineEach) {
  const Place place(studio_.address());
  Connection page(place.port);
  page.send(place.own("GET", "events"));
  const std::uint64_t revision =
      ask("/set", {{"path", "texture.depth"}, {"value", "262 nm"}})["revision"];
  const std::string begin =
      "event: response\ndata: {\"revision\":" + std::to_string(revision) + ",";
  std::string seen = page.read_until(begin, 60);
  const std::size_t at = seen.find(begin) + std::string("event: response\ndata: ").size();
  for (int i = 0; i < 100 && seen.find('\n', at) == std::string::npos; ++i)
    seen = page.read_until("no such text", 0.1);  // the rest of its line
  const std::string line = seen.substr(at, seen.find('\n', at) - at);
  const Json told = Json::parse(line);
  EXPECT_EQ(told.size(), 7u);
  EXPECT_EQ(told["step"], "first");
  EXPECT_EQ(told["comparisons"], Json::array());
  EXPECT_EQ(told["pinned"], Json::object());
  // As papilla evaluate says it of these numbers, in its words.
  ASSERT_FALSE(told["caveats"].empty());
  bool air = false;
  for (const std::string caveat : told["caveats"])
    air = air || caveat.starts_with("air beyond its breakdown field on up to ");
  EXPECT_TRUE(air) << told["caveats"];
  EXPECT_GT(told["seconds"].get<double>(), 0);
  EXPECT_LT(told["seconds"].get<double>(), 60);
  EXPECT_FALSE(told["response"].contains("seconds"));
  EXPECT_FALSE(told["response"]["points"].empty());
}

// A page is moved where papilla evaluate refuses: it says so beside each answer.
TEST_F(Answers, SayTheModelOptionsThatTheFingerWasNotFittedWith) {
  const Place place(studio_.address());
  Connection page(place.port);
  page.send(place.own("GET", "events"));
  const std::uint64_t revision =
      ask("/set", {{"path", "model.rim_pinning"}, {"value", "true"}})["revision"];
  const std::string begin =
      "event: response\ndata: {\"revision\":" + std::to_string(revision) + ",";
  page.read_until(begin, 60);
  EXPECT_NE(page.read_until("was fitted with false", 60).find("warning: model.rim_pinning is true"),
            std::string::npos);
}

// Of a stack they are of each part alone, and its parts may leave less between them. They come with
// the shape, at once, and not with the look, which waits until nothing moves.
TEST(Studio, SaysWhoseTheSmallestWidthsAre) {
  for (const bool stack : {false, true}) {
    const TemporaryFolder folder;
    StudioOptions options = studio_options(folder.path().string());
    if (stack) {
      options.file = (folder.path() / "two.toml").string();
      write_bytes(options.file,
                  "schema_version = 1\nbase = \"m3_samples/common.toml\"\n\n[texture]\n"
                  "type = \"stack\"\n\n[[texture.parts]]\ntype = \"waves\"\n"
                  "period = \"6 um\"\ndepth = \"100 nm\"\n\n[[texture.parts]]\n"
                  "type = \"waves\"\nperiod = \"3 um\"\ndepth = \"50 nm\"\n");
    }
    Studio studio(options);
    const Place place(studio.address());
    Connection page(place.port);
    page.send(place.own("GET", "events"));
    const std::string wanted = stack ? "\"of_parts\":true" : "\"of_parts\":false";
    const std::string seen = page.read_until(wanted, 60);
    ASSERT_NE(seen.find(wanted), std::string::npos) << wanted;
    const std::string event = "\nevent: ";
    EXPECT_EQ(seen.substr(seen.rfind(event) + event.size(), 5), "shape");
  }
}

// A desk tells of both until its thread has ended.
TEST(Studio, IsClosedWhileItsLabWorks) {
  const TemporaryFolder folder;
  StudioOptions options = studio_options(folder.path().string());
  options.program = (folder.path() / "program.sh").string();
  write_bytes(options.program,
              "#!/bin/sh\n[ $1 = optimize ] && echo '{}' > $4/run.json && exit 0\n"
              "while :; do sleep 0.05; done\n");
  std::filesystem::permissions(options.program, std::filesystem::perms::owner_all);
  std::string opening;
  {
    Studio studio(options);
    opening = studio.opening_file();
    const auto asked = [&](const char* method, const char* path, const char* body) {
      return Json::parse(studio.answer({method, path, "", body}).body);
    };
    asked("POST", "/search/start",
          R"j({"variables":[{"path":"texture.depth","low":"100 nm","high":"800 nm"}],)j"
          R"j("maximise":["mean(modulation)"]})j");
    for (int i = 0; i < 500 && asked("GET", "/state", "")["search"]["state"] != "finished"; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(asked("POST", "/lab/plan", R"({"touches":5})")["doing"], "plan");
  }
  EXPECT_FALSE(std::filesystem::exists(opening));
}

}  // namespace
}  // namespace papilla::tests::answers_test
