// What a lab is opened with: which designs are decided among, which are only measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/lab_source.h"
#include "tests/cli/program.h"
#include "tests/lab/small_lab.h"
#include "tests/support/refusal.h"

namespace papilla::tests::source_test {
namespace {

class LabSources : public testing::Test {
 protected:
  void SetUp() override {
    write_small_lab(own_.path());
    write_third("third.toml");
    write_third("wafer/designs/third.toml");
    copy("deep.toml", "wafer/designs/deep.toml");
    write_text(own_.path() / "wafer/manifest.csv",
               "field,design,load_N,humidity_percent,voltage_V,state\n"
               "A1,designs/third.toml,0.2,35,200,clean\n"
               "A2,designs/deep.toml,0.2,35,200,clean\n");
    write_run("run");
  }

  std::string path(const std::string& name) const { return (own_.path() / name).string(); }
  void copy(const std::string& from, const std::string& to) const {
    write_text(own_.path() / to, file_text(path(from)));
  }
  void write_third(const std::string& name) const {
    std::filesystem::create_directories((own_.path() / name).parent_path());
    write_design(path(name), read_design(path("deep.toml"), {"texture.depth=400 nm"}));
  }
  // Its front: deep and shallow.
  void write_run(const std::string& name) const {
    nlohmann::ordered_json run;
    nlohmann::ordered_json& decision = run["decision"];
    decision["worth"] = "worst(modulation)";
    for (const auto& [front, design] :
         {std::pair("front/01", "deep.toml"), std::pair("front/02", "shallow.toml")}) {
      decision["designs"][front]["worth_at_members"] = std::vector<double>(6, 0.3);
      decision["designs"][front]["limits_kept_at_members"] = std::vector<bool>(6, true);
      copy(design, name + "/" + front + "/design.toml");
    }
    write_text(own_.path() / name / "run.json", run.dump());
  }

  LabOpening opened(const std::vector<std::string>& names) const {
    LabSource source;
    for (const std::string& name : names) source.paths.push_back(path(name));
    source.belief = path("belief.toml");
    return lab_opening(source);
  }
  static std::vector<std::string> choices(const LabOpening& opened) {
    std::vector<std::string> out;
    for (const DesignEntry& d : opened.opening.file.designs) {
      if (d.choice) out.push_back(d.name);
    }
    return out;
  }

  TemporaryFolder own_;
};

TEST_F(LabSources, DecideAmongTheDesignsOfTheRunWhereverItIsNamed) {
  const std::vector<std::string> front{"front/01", "front/02"};
  for (const std::vector<std::string>& names : {std::vector<std::string>{"run"},
                                                {"run", "third.toml"},
                                                {"third.toml", "run"},
                                                {"run", "wafer"},
                                                {"wafer", "run"}}) {
    const LabOpening lab = opened(names);
    EXPECT_EQ(choices(lab), front) << names.front();
    EXPECT_EQ(lab.opening.worth->designs, front) << names.front();
    const bool told = std::any_of(lab.notes.begin(), lab.notes.end(), [](const std::string& n) {
      return n.find("measured and not chosen among") != std::string::npos && n.ends_with(": third");
    });
    EXPECT_EQ(told, names.size() > 1) << names.front();
  }
  // A field of the design that the run has is one of it.
  EXPECT_EQ(opened({"wafer", "run"}).opening.file.fields.back().design, "front/01");
}

// A wafer has the best of a run with the numbers of its build sheet.
TEST_F(LabSources, TakeTheRoundedBestOnAWaferForTheChoiceThatItIs) {
  copy("deep.toml", "run/best/design.toml");
  const Design built = read_design(path("deep.toml"), {"texture.depth=610 nm"});
  write_design(path("run/best/build.toml"), built);
  write_design(path("wafer/designs/deep.toml"), built);
  const LabOpening lab = opened({"run", "wafer"});
  EXPECT_EQ(lab.opening.file.fields.back().design, "front/01");
  EXPECT_TRUE(lab.opening.designs.front().texture == built.texture);  // what is measured
  EXPECT_EQ(lab.opening.file.designs.size(), 3u);
}

TEST_F(LabSources, AreRefusedWithASecondRun) {
  write_run("other");
  EXPECT_NE(refusal_of([&] {
              opened({"run", "other"});
            }).find("other: a second run"),
            std::string::npos);
}

// A study with the shipped finger, whose belief has members; its [finger] is open at the end.
constexpr const char* kStudy = R"toml(schema_version = 1
[texture]
type = "hole_array"
period = "6 um"
diameter = "3 um"
depth = "350 nm"
[surface]
dielectric = [{ material = "SiO2", thickness = "1 um" }]
[drive]
amplitude = "200 V"
[design_space]
"texture.depth" = ["100 nm", "350 nm"]
[objective]
maximise = "mean(modulation)"
[finger]
base = "fingers/reference.toml"
)toml";

TEST_F(LabSources, SayThatTheFileOfARunIsDamaged) {
  const std::string whole = file_text(path("run/run.json"));
  for (const std::string& text : {whole.substr(0, whole.size() / 2), std::string("no JSON"),
                                  std::string(), std::string("[1, 2]")}) {
    write_text(own_.path() / "run/run.json", text);
    const std::string refused = refusal_of([&] { opened({"run"}); });
    EXPECT_TRUE(refused.starts_with(path("run/run.json") + " is damaged: ")) << refused;
    EXPECT_NE(refused.find("--out " + path("run") + " --resume` write it anew"), std::string::npos)
        << refused;
  }
}

TEST_F(LabSources, SayWhyARunHasNoDecision) {
  const auto refused = [&](const std::string& text) {
    write_text(own_.path() / "run/run.json", text);
    return refusal_of([&] { opened({"run"}); });
  };
  const std::string interrupted = R"({"interrupted": true})";
  EXPECT_NE(refused(interrupted).find("its run was interrupted: search again"), std::string::npos);
  write_text(own_.path() / "run/journal", "");
  EXPECT_NE(refused(interrupted)
                .find("its run was interrupted: `papilla optimize STUDY --out " + path("run") +
                      " --resume`"),
            std::string::npos);
  EXPECT_NE(refused(R"({"interrupted": false, "feasible": false, "finalists": []})")
                .find("it found no design to recommend; loosen a limit"),
            std::string::npos);
  EXPECT_NE(refused(R"({"best": "front/01"})").find("another version of this program"),
            std::string::npos);
}

// The reason is that of the run, which says what to do; where no design keeps the limits that is
// said here.
TEST_F(LabSources, SayWhatARunNeedsThatIsNotJudgedOverBelief) {
  const auto refused = [&](const std::string& front) {
    write_text(own_.path() / "run/run.json", R"({"finalists": [{"folder": ")" + front +
                                                 R"("}], "decision": {"absent": "REASON"}})");
    return refusal_of([&] { opened({"run"}); });
  };
  const std::string begin = path("run") + ": no decision by belief: REASON; ";
  EXPECT_EQ(refused("front/01"), begin + "then search again");
  EXPECT_EQ(refused(""), begin + "loosen a limit or give the search more room, and search again");
}

TEST_F(LabSources, WantLimitsKeptAsTheStudyOfTheRunDoes) {
  EXPECT_EQ(opened({"run"}).opening.file.limits, 0.9);
  write_text(own_.path() / "run/resolved.toml",
             std::string(kStudy) + "[risk]\nlimits = \"60 %\"\n");
  EXPECT_EQ(opened({"run"}).opening.file.limits, 0.6);
}

TEST_F(LabSources, DecideByTheRiskOfTheStudyOfTheRun) {
  EXPECT_EQ(opened({"run"}).opening.file.risk, "regret");
  write_text(own_.path() / "run/resolved.toml",
             std::string(kStudy) + "[risk]\nbelief = \"worst 10 %\"\n");
  const LabFile file = opened({"run"}).opening.file;
  EXPECT_EQ(file.risk, "worst 10 %");
  EXPECT_NE(lab_file_text(file).find("risk = \"worst 10 %\""), std::string::npos);
}

TEST_F(LabSources, TakeTheLimitsOfARunWithTheirProbabilities) {
  auto run = nlohmann::ordered_json::parse(file_text(path("run/run.json")));
  run["decision"]["designs"]["front/01"]["p_limits"] = {{"min_wall", 1.0},
                                                        {"worst(modulation)", 0.49}};
  write_text(own_.path() / "run/run.json", run.dump());
  const auto limits = opened({"run"}).opening.worth->limits;
  ASSERT_EQ(limits.size(), 2u);
  ASSERT_EQ(limits[0].size(), 2u);
  EXPECT_EQ(limits[0][1].name, "worst(modulation)");
  EXPECT_EQ(limits[0][1].probability, 0.49);
  EXPECT_TRUE(limits[1].empty());
}

TEST_F(LabSources, AreRefusedWhereAPinTouches) {
  write_design(path("pin.toml"), read_design(find_design("clutch/brass.toml")));
  EXPECT_NE(refusal_of([&] {
              opened({"deep.toml", "pin.toml"});
            }).find("pin: a pin is in the place of the finger"),
            std::string::npos);
}

TEST_F(LabSources, SayTheConditionsOfFieldsInTheirManifestAlone) {
  const auto refused = [&](std::string LabSource::*option) {
    LabSource source;
    source.paths = {path("wafer")};
    source.belief = path("belief.toml");
    source.*option = "1";
    return refusal_of([&] { lab_opening(source); });
  };
  for (const auto& [name, option] :
       {std::pair("--load", &LabSource::load), std::pair("--humidity", &LabSource::humidity),
        std::pair("--voltage", &LabSource::voltage),
        std::pair("--frequency", &LabSource::frequency), std::pair("--state", &LabSource::states)})
    EXPECT_TRUE(refused(option).starts_with(std::string(name) + ": the manifest of a wafer says"))
        << refused(option);
}

TEST_F(LabSources, AreRefusedWithAFieldOfTwoWafersOrDesigns) {
  const std::string head = "field,design,load_N,humidity_percent,voltage_V,state\n";
  copy("shallow.toml", "other/designs/shallow.toml");
  write_text(own_.path() / "other/manifest.csv", head +
                                                     "A2,designs/shallow.toml,0.2,35,200,clean\n"
                                                     "A3,designs/shallow.toml,0.2,35,200,clean\n");
  const auto refused = [&](const std::vector<std::string>& names) {
    return keyed_refusal_of([&] { opened(names); });
  };
  EXPECT_EQ(refused({"wafer", "other"}),
            "field: A2: also on the wafer of " + path("wafer") +
                "/manifest.csv; a reading that is told by its field could be of either. Open a "
                "lab for each wafer, or name a copy of this manifest, beside it, with labels of "
                "its own (2A2)\n");
  EXPECT_TRUE(refused({"wafer", "wafer"}).starts_with("field: A1, A2: also on the wafer of "));
  write_text(own_.path() / "other/second.csv", head +
                                                   "2A2,designs/shallow.toml,0.2,35,200,clean\n"
                                                   "2A3,designs/shallow.toml,0.2,35,200,clean\n");
  EXPECT_EQ(opened({"wafer", "other/second.csv"}).opening.file.fields.size(), 4u);
  copy("deep.toml", "other/designs/deep.toml");
  write_text(own_.path() / "other/manifest.csv", head +
                                                     "A2,designs/shallow.toml,0.2,35,0,clean\n"
                                                     "A2,designs/shallow.toml,0.2,35,200,clean\n"
                                                     "A2,designs/deep.toml,0.2,75,200,clean\n");
  EXPECT_EQ(refused({"other"}), "design: A2 holds designs/shallow.toml in a line before\n");
}

// "front/01" of the run and front_01.toml would be one file of the lab.
TEST_F(LabSources, KeepEachDesignInAFileOfItsOwn) {
  copy("third.toml", "front_01.toml");
  const LabFile file = opened({"run", "front_01.toml"}).opening.file;
  ASSERT_EQ(file.designs.size(), 3u);
  EXPECT_EQ(file.designs[0].file, "designs/front_01.toml");
  EXPECT_EQ(file.designs[2].file, "designs/front_01-2.toml");
}

}  // namespace
}  // namespace papilla::tests::source_test
