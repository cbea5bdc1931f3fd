// What a folder says its files were made from: read back as it was written, and each member that is
// not as an export writes it refused by its name.
#include "fabricate/record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "design/study.h"
#include "tests/cli/program.h"

namespace papilla::tests::record_test {
namespace {

using Json = nlohmann::ordered_json;

ExportRecord whole_record() {
  ExportRecord out;
  HoleArray holes;
  holes.period = 5e-6, holes.diameter = 2e-6;
  out.design.texture = Texture{holes};
  ExportOptions& o = out.options;
  o.formats = {"exr", "mask", "dose"};
  o.size = 1.5e-3, o.size_y = 0.5e-3, o.pixels = 96;
  o.polarity = Polarity::WhiteHigh;
  o.repeat = 3, o.levels = 5, o.facet_error = 4e-9;
  o.bias = {30e-9, 70e-9};
  o.dose_curve = DoseCurve{{0, 1e-7, 2e-6}, {5, 60, 255}};
  out.files = {{"exr", "heightmap.exr"},
               {"mask", "mask.tif"},
               {"dose", "dose.png"},
               {"design", "design.toml"}};
  out.limits = {read_constraint("min_hole", 0.4e-6), read_constraint("min_wall", 0.3e-6)};
  out.version = "0.2.9";
  return out;
}

class Record : public ::testing::Test {
 protected:
  ExportRecord read(const Json& made_from) const {
    place_.write(kRecordName, Json{{"made_from", made_from}}.dump());
    return read_record(place_.path().string());
  }
  // The member that is refused; "": none.
  std::string refused(const Json& made_from) const {
    try {
      read(made_from);
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().size(), 1u);
      EXPECT_EQ(error.problems()[0].file, place_.path().string() + "/" + kRecordName);
      return error.problems()[0].key;
    }
    return "";
  }
  std::string refused(const std::string& key, const Json& value) const {
    Json changed = good_;
    changed[key] = value;
    return refused(changed);
  }

  const Workplace place_;
  const Json good_ = Json::parse(record_json(whole_record()));
};

TEST_F(Record, ReadsBackAsItWasWritten) {
  const ExportRecord was = whole_record(), is = read(good_);
  const ExportOptions &a = was.options, &b = is.options;
  EXPECT_EQ(is.design, was.design);
  EXPECT_EQ(b.formats, a.formats);
  EXPECT_EQ(b.size, a.size);
  EXPECT_EQ(b.size_y, a.size_y);
  EXPECT_EQ(b.pixels, a.pixels);
  EXPECT_EQ(b.polarity, a.polarity);
  EXPECT_EQ(b.repeat, a.repeat);
  EXPECT_EQ(b.levels, a.levels);
  EXPECT_EQ(b.facet_error, a.facet_error);
  EXPECT_EQ(b.bias.shrink, a.bias.shrink);
  EXPECT_EQ(b.bias.edge_radius, a.bias.edge_radius);
  ASSERT_TRUE(b.dose_curve);
  EXPECT_EQ(b.dose_curve->depth, a.dose_curve->depth);
  EXPECT_EQ(b.dose_curve->grey, a.dose_curve->grey);
  EXPECT_EQ(is.limits, was.limits);
  ASSERT_EQ(is.files.size(), was.files.size());
  for (std::size_t i = 0; i < is.files.size(); ++i) {
    EXPECT_EQ(is.files[i].format, was.files[i].format);
    EXPECT_EQ(is.files[i].path, place_.path().string() + "/" + was.files[i].path);
  }
  ExportRecord deep = was;
  deep.options.polarity = Polarity::WhiteDeep;
  EXPECT_EQ(read(Json::parse(record_json(deep))).options.polarity, Polarity::WhiteDeep);
  ExportRecord plain = was;
  plain.options.polarity.reset();
  plain.options.dose_curve.reset();
  plain.files = {{"exr", "heightmap.exr"}};
  const ExportRecord again = read(Json::parse(record_json(plain)));
  EXPECT_FALSE(again.options.polarity);
  EXPECT_FALSE(again.options.dose_curve);
}

TEST_F(Record, EachMemberIsNeeded) {
  for (const auto& [key, value] : good_.items()) {
    if (key == "version") continue;  // 0.2.2 wrote none
    Json without = good_;
    without.erase(key);
    EXPECT_EQ(refused(without), "made_from." + key);
  }
}

TEST_F(Record, NamesTheVersionThatMadeTheFiles) {
  EXPECT_EQ(read(good_).version, whole_record().version);
  Json earlier = good_;
  earlier.erase("version");
  EXPECT_EQ(read(earlier).version, "");
  EXPECT_EQ(refused("version", 2), "made_from.version");
}

TEST_F(Record, NumbersHaveTheirRanges) {
  for (const auto& [key, low, high] : {std::tuple{"size", 0.0, 1.0},
                                       {"size_y", 0.0, 1.0},
                                       {"pixels", 8.0, 65536.0},
                                       {"repeat", 1.0, 4096.0},
                                       {"levels", 1.0, 64.0},
                                       {"facet_error", 0.0, 1.0},
                                       {"shrink", -1.0, 1.0},
                                       {"edge_rounding", 0.0, 1.0}}) {
    const std::string name = std::string("made_from.") + key;
    EXPECT_EQ(refused(key, low), "") << key;
    EXPECT_EQ(refused(key, high), "") << key;
    EXPECT_EQ(refused(key, low - 0.01), name);
    EXPECT_EQ(refused(key, high + 0.01), name);
    EXPECT_EQ(refused(key, "1"), name);
  }
}

TEST_F(Record, ADoseCurveHasTwoPointsAtLeastAndAsManyGreysAsDepths) {
  const auto curve = [&](const Json& depth, const Json& grey) {
    return refused("dose_curve", {{"depth", depth}, {"grey", grey}});
  };
  EXPECT_EQ(curve({0, 1e-6}, {0, 255}), "");
  const std::string wrong = "made_from.dose_curve";
  EXPECT_EQ(curve(Json::array({1e-6}), Json::array({255})), wrong);
  EXPECT_EQ(curve(Json::array(), Json::array()), wrong);
  EXPECT_EQ(curve({0, 1e-6, 2e-6}, {0, 255}), wrong);
  EXPECT_EQ(curve({0, 1e-6}, {0, 100, 255}), wrong);
  EXPECT_EQ(curve({0, "1"}, {0, 255}), wrong);
  EXPECT_EQ(curve(3, {0, 255}), wrong);
  EXPECT_EQ(refused("dose_curve", {{"depth", {0, 1e-6}}}), wrong);
  EXPECT_EQ(refused("dose_curve", nullptr), wrong);  // a file needs it
}

TEST_F(Record, TextsListsAndFilesAreOfTheirKind) {
  EXPECT_EQ(refused("design", 3), "made_from.design");
  EXPECT_EQ(refused("polarity", "white"), "made_from.polarity");
  EXPECT_EQ(refused("polarity", 1), "made_from.polarity");
  EXPECT_EQ(refused("polarity", nullptr), "made_from.polarity");  // the mask needs it
  EXPECT_EQ(refused("limits", {{"min_hole", "1"}}), "made_from.limits");
  const auto file = [&](const Json& one) { return refused("files", Json::array({one})); };
  EXPECT_EQ(file({{"format", "exr"}, {"file", "a.exr"}}), "");
  const std::string wrong = "made_from.files";
  EXPECT_EQ(file(3), wrong);
  EXPECT_EQ(file({{"format", "exr"}}), wrong);
  EXPECT_EQ(file({{"file", "a.exr"}}), wrong);
  EXPECT_EQ(file({{"format", 1}, {"file", "a.exr"}}), wrong);
  EXPECT_EQ(file({{"format", "exr"}, {"file", 1}}), wrong);
  EXPECT_EQ(file({{"format", "exr"}, {"file", ""}}), wrong);
  EXPECT_EQ(file({{"format", "exr"}, {"file", "../a.exr"}}), wrong);
}

TEST_F(Record, AFileThatSaysNothingOfItsOriginIsRefusedWithWhatIsMissing) {
  const auto why = [&](const std::string& text) {
    place_.write(kRecordName, text);
    try {
      read_record(place_.path().string());
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().at(0).key, "");
      EXPECT_EQ(error.problems().at(0).file, place_.path().string() + "/" + kRecordName);
      return error.problems().at(0).message;
    }
    return std::string();
  };
  for (const char* text : {"", "{", "3", "[1]", "null", "\"made_from\""})
    EXPECT_EQ(why(text), "no JSON object; export the design again") << text;
  for (const char* text : {"{}", R"({"made_from":3})", R"({"made_from":null})",
                           R"({"made_from":[]})", R"({"made_from":"x"})", R"({"design":{}})"}) {
    EXPECT_EQ(why(text), "it does not say what the files were made from; export the design again")
        << text;
  }
  const std::string none = (place_.path() / "none").string();
  try {
    read_record(none);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().at(0).file, none + "/" + kRecordName);
    EXPECT_EQ(error.problems().at(0).message,
              "not there: no folder of `papilla export`, nor best/ or front/ of a run; without it "
              "nothing says what the files should hold");
  }
}

// Of a study its widths alone, and of an export the formats of its files.
TEST(RecordOf, AStudyKeepsTheLimitsOfWidths) {
  Study study;
  study.constraints = {read_constraint("min_wall", 1e-6), read_constraint("aspect_ratio", 2),
                       read_constraint("min_hole", 2e-6)};
  Export made;
  made.files = {{"gsf", "f/heightmap.gsf"}, {"design", "f/design.toml"}};
  ExportOptions options;
  options.pixels = 77, options.formats = {"exr", "gsf"};
  const ExportRecord record = record_of(study, options, made);
  EXPECT_EQ(record.limits, (std::vector<Constraint>{read_constraint("min_wall", 1e-6),
                                                    read_constraint("min_hole", 2e-6)}));
  EXPECT_EQ(record.options.formats, std::vector<std::string>{"gsf"});
  EXPECT_EQ(record.options.pixels, 77);
  EXPECT_EQ(record.files.size(), 2u);
}

}  // namespace
}  // namespace papilla::tests::record_test
