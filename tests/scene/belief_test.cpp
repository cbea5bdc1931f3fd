#include "scene/belief.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "config/reader.h"
#include "config/writer.h"
#include "design/design.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::belief_test {
namespace {

constexpr const char* kTwo = R"(schema_version = 1
[fitted]
"skin.rms" = "256 nm"
[[member]]
weight = 0.25
hypothesis = "uniform"
set = { "skin.rms" = "128 nm", "water.scale" = 2.0 }
[[member]]
weight = 0.75
hypothesis = "persson"
[member.set]
"model.closure" = "persson"
"model.droplet_step" = "50 nm"
"water.volume.1" = "0.5 um3"
)";

class BeliefFile : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path) << text;
    return path;
  }
  std::vector<Problem> problems(const std::string& text) const {
    return problems_of([&] { read_belief(write("belief.toml", text)); });
  }

  const TemporaryFolder folder_;
};

TEST_F(BeliefFile, ReadsItsMembersAndTheirWeights) {
  const Belief b = read_belief(write("belief.toml", kTwo));
  ASSERT_EQ(b.members.size(), 2u);
  EXPECT_EQ(b.members[1].hypothesis, "persson");
  EXPECT_NEAR(b.members[0].weight, 0.25, 1e-15);
  EXPECT_NEAR(b.effective_members(), 1 / (0.0625 + 0.5625), 1e-12);
  Belief measured = b;
  measured.readings = {reading_text(0.5, 0.45, 0, 0.31, 0),
                       reading_text(0.5, 0.45, 200, 0.31, 0.45123567)};
  EXPECT_EQ(measured.readings[1], "0.5 N, 45 %, 200 V, off 0.31 N, on 0.451236 N");
  const Belief again = read_belief(write("again.toml", belief_text(measured)));
  EXPECT_EQ(again.readings, measured.readings);
  ASSERT_EQ(again.members.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const MemberScene a = with_member(b, b.members[k], {}, {}),
                      c = with_member(again, again.members[k], {}, {});
    EXPECT_EQ(a.finger, c.finger);
    EXPECT_EQ(a.model, c.model);
  }
}

TEST_F(BeliefFile, AMemberSetsValuesAndModelOptions) {
  const Belief b = read_belief(write("belief.toml", kTwo));
  const Finger reference;
  const MemberScene first = with_member(b, b.members[0], reference, {});
  EXPECT_NEAR(first.finger.skin.rms, 103.5e-9, 1e-18);
  EXPECT_NEAR(first.finger.water.volume[3], 2 * 7.1e-18, 1e-27);
  EXPECT_EQ(first.model, ModelOptions{});
  const MemberScene second = with_member(b, b.members[1], reference, {});
  EXPECT_EQ(second.model.closure, Closure::Persson);
  EXPECT_NEAR(second.model.droplet_step, 50e-9, 1e-18);
  EXPECT_NEAR(second.finger.water.volume[1], 0.5e-18, 1e-27);
  EXPECT_EQ(second.finger.skin, reference.skin);
}

// Of a person whose skin is twice as rough as the fitted finger's, a member halves the same share.
TEST_F(BeliefFile, AnotherFingerIsMovedByTheSameFactor) {
  const Belief b = read_belief(write("belief.toml", kTwo));
  Finger rough;
  rough.skin.rms = 512e-9;
  EXPECT_NEAR(with_member(b, b.members[0], rough, {}).finger.skin.rms, 256e-9, 1e-18);
  // What `fitted` does not name replaces the finger's own.
  rough.water.volume[1] = 3e-18;
  EXPECT_NEAR(with_member(b, b.members[1], rough, {}).finger.water.volume[1], 0.5e-18, 1e-27);
}

TEST_F(BeliefFile, MistakesAreToldWithTheirPlaces) {
  const auto wrong = [&](const std::string& set, const std::string& words, int line) {
    const auto found =
        problems("schema_version = 1\n[[member]]\nweight = 1.0\nhypothesis = \"a\"\nset = { " +
                 set + " }\n");
    ASSERT_EQ(found.size(), 1u) << set;
    EXPECT_NE(found[0].message.find(words), std::string::npos) << found[0].text();
    EXPECT_EQ(found[0].line, line) << found[0].text();
  };
  wrong("\"skin.rmss\" = \"1 nm\"", "unknown key `rmss`", 5);
  wrong("\"skin.rms\" = \"1 m\"", "outside", 5);
  wrong("\"skin.rms\" = 3.0", "needs a unit", 5);
  wrong("\"model.closure\" = \"perssn\"", "did you mean \"persson\"", 5);
  wrong("\"load\" = \"1 N\"", "a condition of the experiment", 5);
  wrong("\"water.scale\" = -1.0", "outside", 5);
}

TEST_F(BeliefFile, ReadingsAreAListOfTexts) {
  const auto found = problems(std::string("readings = [0.5]\n") + kTwo);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("a list of texts"), std::string::npos) << found[0].text();
}

TEST_F(BeliefFile, WeightsAreAboveZeroAndSumToOne) {
  const auto of = [&](const char* first, const char* second) {
    return problems(std::string("schema_version = 1\n[[member]]\nweight = ") + first +
                    "\n[[member]]\nweight = " + second + "\n");
  };
  EXPECT_TRUE(of("0.4", "0.6").empty());
  ASSERT_EQ(of("-0.5", "1.0").size(), 1u);
  EXPECT_EQ(of("-0.5", "1.0")[0].line, 3);
  EXPECT_NE(of("0.0", "1.0")[0].message.find("leave such a member out"), std::string::npos);
  EXPECT_NE(of("0.4", "0.4")[0].message.find("sum to 0.8"), std::string::npos);
  EXPECT_NE(problems("schema_version = 1\n")[0].message.find("[[member]]"), std::string::npos);
}

TEST_F(BeliefFile, OfOtherModelOptionsThanTheFingersIsRefused) {
  write("belief.toml", std::string(kTwo));
  const std::string finger = write(
      "finger.toml",
      "schema_version = 1\nbelief = \"belief.toml\"\n[calibrated_for]\nair_limit = \"emission\"\n");
  const auto found = problems_of([&] { read_finger(finger); });
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("other model options"), std::string::npos) << found[0].text();
  const Finger good =
      read_finger(write("good.toml", "schema_version = 1\nbelief = \"belief.toml\"\n"));
  EXPECT_EQ(belief_of(good).members.size(), 2u);
  EXPECT_NE(problems_of([&] {
              read_finger(write("none.toml", "schema_version = 1\nbelief = \"no.toml\"\n"));
            })[0]
                .message.find("no such file"),
            std::string::npos);
}

// A finger is read on any machine that has the shipped designs: their files are written by their
// names below them.
TEST_F(BeliefFile, AShippedFileIsWrittenByItsNameBelowTheDesigns) {
  Finger finger;
  finger.belief = find_design("fingers/reference.toml");  // any file of theirs
  const std::string text = to_toml(finger);
  EXPECT_NE(text.find("belief = \"fingers/reference.toml\""), std::string::npos) << text;
  Document document = parse_document(text, "finger.toml", {}, design_roots());
  Finger again;
  read_section(document, "", again);
  finish(document);
  EXPECT_EQ(again, finger);
}

// A mistake in the belief is told when the finger is read, with its place there.
TEST_F(BeliefFile, AMistakeIsToldWhenTheFingerIsRead) {
  write("belief.toml",
        "schema_version = 1\n[[member]]\nweight = 1.0\nset = { \"skin.rms\" = \"1 m\" }\n");
  const auto found = problems_of(
      [&] { read_finger(write("finger.toml", "schema_version = 1\nbelief = \"belief.toml\"\n")); });
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].file.ends_with("belief.toml"));
  EXPECT_EQ(found[0].line, 4);
}

}  // namespace
}  // namespace papilla::tests::belief_test
