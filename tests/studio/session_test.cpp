// The one state that all pages see: changes, the way back, pins, and what is on disk of them.
#include "studio/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "config/describe.h"
#include "tests/temporary.h"

namespace papilla::tests::session_test {
namespace {

const std::string kHoles = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";

double depth(const Session& session) {
  return get_number(session.view().study.design, "texture.depth");
}

TEST(Session, SetsAKeyAndGoesBackAndForth) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  const auto before = session.view().revision;
  EXPECT_GT(session.set("texture.depth", "262 nm", 0), before);
  EXPECT_DOUBLE_EQ(depth(session), 262e-9);
  session.set("texture.depth", "0.3", 0);  // bare: in the unit of the key
  EXPECT_DOUBLE_EQ(depth(session), 0.3e-9);
  session.undo();
  EXPECT_DOUBLE_EQ(depth(session), 262e-9);
  session.undo();
  EXPECT_DOUBLE_EQ(depth(session), 600e-9);
  EXPECT_FALSE(session.view().can_undo());
  session.redo();
  session.redo();
  EXPECT_DOUBLE_EQ(depth(session), 0.3e-9);
  EXPECT_FALSE(session.view().can_redo());
}

TEST(Session, GoesToAnyStepOfItsHistory) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  session.set("texture.depth", "262 nm", 0);
  session.set("texture.diameter", "4 um", 0);
  session.reset("texture.depth");
  session.undo();
  SessionView now = session.view();
  EXPECT_EQ(now.steps, (std::vector<std::string>{"depth 262 nm", "diameter 4 um",
                                                 "depth as the file has it"}));
  EXPECT_EQ(now.done, 2u);
  session.go_to(0);
  EXPECT_DOUBLE_EQ(depth(session), 600e-9);
  EXPECT_EQ(session.view().steps, now.steps);
  EXPECT_FALSE(session.view().can_undo());
  session.go_to(1);
  EXPECT_DOUBLE_EQ(depth(session), 262e-9);
  session.go_to(3);
  EXPECT_DOUBLE_EQ(depth(session), 600e-9);
  EXPECT_FALSE(session.view().can_redo());
  EXPECT_THROW(session.go_to(4), InputError);
  // It is on disk as it is at hand; another change from the middle ends what was undone.
  session.go_to(1);
  EXPECT_EQ(Session(place.path(), kHoles).view().steps, now.steps);
  session.set("texture.depth", "100 nm", 0);
  EXPECT_EQ(session.view().steps, (std::vector<std::string>{"depth 262 nm", "depth 100 nm"}));
}

TEST(Session, OneGestureIsOneStepBack) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  for (int nm = 500; nm > 400; nm -= 10)
    session.set("texture.depth", std::to_string(nm) + " nm", 7);
  EXPECT_DOUBLE_EQ(depth(session), 410e-9);
  session.undo();
  EXPECT_DOUBLE_EQ(depth(session), 600e-9);
}

TEST(Session, StaysAsItWasWhenAValueIsRefused) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  const auto before = session.view();
  for (const auto& [path, text] : std::vector<std::pair<std::string, std::string>>{
           {"texture.depth", "fast"},
           {"texture.depth", "3 V"},
           {"texture.depth", "-1 nm"},
           {"texture.diameter", "7 um"},  // larger than the period
           {"texture.depth", "1 nm\nbase = \"/etc/passwd\""},
           {"base", "other.toml"},
           {"finger.base", "/etc/passwd"},
           {"finger.skin.map", "/etc/passwd"},
           {"texture.nothing", "1"},
           {"schema_version", "2"}}) {
    EXPECT_THROW(session.set(path, text, 0), InputError) << path << " = " << text;
  }
  EXPECT_EQ(session.view().revision, before.revision);
  EXPECT_EQ(session.view().study.design, before.study.design);
}

TEST(Session, AnotherKindKeepsTheMeasuresThatItShares) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  session.set("texture.period", "5 um", 0);
  session.set_kind("pillar_array");
  const Design pillars = session.view().study.design;
  EXPECT_EQ(texture_name(pillars.texture), "pillar_array");
  EXPECT_DOUBLE_EQ(get_number(pillars, "texture.period"), 5e-6);
  EXPECT_DOUBLE_EQ(get_number(pillars, "texture.height"), 600e-9);
  session.set("texture.height", "400 nm", 0);
  session.set_kind("hole_array");
  EXPECT_DOUBLE_EQ(depth(session), 400e-9);
  EXPECT_THROW(session.set_kind("measured"), InputError);
}

TEST(Session, IsFoundAgainAfterItsEnd) {
  const TemporaryFolder place;
  {
    Session session(place.path(), kHoles);
    session.set("drive.amplitude", "120 V", 0);
    session.pin("first try");
    session.set("texture.depth", "350 nm", 0);
  }
  Session again(place.path(), kHoles);
  EXPECT_DOUBLE_EQ(depth(again), 350e-9);
  ASSERT_EQ(again.view().pins.size(), 1u);
  EXPECT_EQ(again.view().pins[0].name, "first try");
  again.undo();
  EXPECT_DOUBLE_EQ(depth(again), 600e-9);
  again.take(again.view().pins[0].number);
  EXPECT_DOUBLE_EQ(get_number(again.view().study.design, "drive.amplitude"), 120);
}

TEST(Session, PinsAndTheWayBackKeepTheirDesignsWhenTheirFileIsSaved) {
  const TemporaryFolder place;
  const std::string file = place.path() / "mine.toml";
  write_bytes(file, "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n");
  Session session(place.path(), file);
  session.pin("as opened");
  session.set("texture.depth", "350 nm", 0);
  session.save_as(file, [&](const Draft&, const Study&) {
    write_bytes(
        file,
        "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[texture]\ndepth = \"350 nm\"\n");
  });
  EXPECT_TRUE(session.view().draft.changes.empty());
  EXPECT_DOUBLE_EQ(get_number(session.view().opened, "texture.depth"), 350e-9);
  EXPECT_DOUBLE_EQ(get_number(study_of(session.view().pins[0].draft).design, "texture.depth"),
                   600e-9);
  session.undo();
  EXPECT_DOUBLE_EQ(depth(session), 600e-9);
}

TEST(Session, BeginsAnewWhereItsFileIsDamaged) {
  const TemporaryFolder place;
  { Session session(place.path(), kHoles); }
  write_bytes(place.path() / ".studio/session.json", "{\"draft\": 3");
  Session session(place.path(), kHoles);
  EXPECT_DOUBLE_EQ(depth(session), 600e-9);
}

// Any other step, none at all, or a way back between them begins a new one.
TEST(Session, OnlyTheSameGestureIsTheSameStep) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  const auto at = [&](int nm, std::uint64_t step) {
    session.set("texture.depth", std::to_string(nm) + " nm", step);
  };
  const auto back = [&] {
    session.undo();
    return std::lround(1e9 * depth(session));
  };
  at(510, 0), at(520, 0), at(530, 7), at(540, 7), at(550, 8), at(560, 8);
  EXPECT_EQ(back(), 540);
  at(570, 8);  // after the way back
  EXPECT_FALSE(session.view().can_redo());
  at(580, 8);
  session.pin("between");
  EXPECT_EQ(back(), 540);
  EXPECT_EQ(back(), 520);
  EXPECT_EQ(back(), 510);
  EXPECT_EQ(back(), 600);
  const auto revision = session.view().revision;
  EXPECT_EQ(session.undo(), revision);  // there is nothing before
  for (const int nm : {510, 520, 540, 580}) {
    session.redo();
    EXPECT_EQ(std::lround(1e9 * depth(session)), nm);
  }
  EXPECT_EQ(session.redo(), session.view().revision);
}

TEST(Session, WhatChangesNothingIsNoStep) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  session.set("texture.depth", "500 nm", 0);
  const auto revision = session.view().revision;
  EXPECT_EQ(session.set("texture.depth", "0.5 um", 0), revision);
  EXPECT_EQ(session.reset("drive.amplitude"), revision);
  EXPECT_EQ(session.become(session.view().draft), revision);
  EXPECT_EQ(session.reset("texture.depth"), revision + 1);
  EXPECT_TRUE(session.view().draft.changes.empty());
  session.undo();
  EXPECT_EQ(session.view().draft.changes,
            (std::vector<studio::Change>{{"texture.depth", "500 nm"}}));
  session.become({PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml", {}});
  EXPECT_EQ(texture_name(session.view().study.design.texture), "flat");
  EXPECT_EQ(texture_name(session.view().opened.texture), "flat");
  EXPECT_FALSE(session.view().can_redo());
  session.undo();
  EXPECT_DOUBLE_EQ(depth(session), 500e-9);
  EXPECT_DOUBLE_EQ(get_number(session.view().opened, "texture.depth"), 600e-9);
}

TEST(Session, PinsAtMostEightUnderNumbersThatNeverComeAgain) {
  const TemporaryFolder place;
  {
    Session session(place.path(), kHoles);
    EXPECT_EQ(session.pin(""), 1);
    EXPECT_EQ(session.pin(std::string(60, 'a')), 2);
    EXPECT_EQ(session.pin(std::string(60, 'b') + "c"), 3);
    for (int number = 4; number <= 8; ++number) EXPECT_EQ(session.pin("more"), number);
    EXPECT_THROW(session.pin("too many"), InputError);
    EXPECT_EQ(session.view().pins.size(), 8u);
    session.unpin(2);
    session.unpin(17);  // nobody
    EXPECT_EQ(session.pin(""), 9);
    session.unpin(4);
  }
  Session again(place.path(), kHoles);
  std::vector<std::pair<int, std::string>> pins;
  for (const PinnedDesign& p : again.view().pins) pins.emplace_back(p.number, p.name);
  EXPECT_EQ(pins, (std::vector<std::pair<int, std::string>>{{1, "design 1"},
                                                            {3, std::string(60, 'b')},
                                                            {5, "more"},
                                                            {6, "more"},
                                                            {7, "more"},
                                                            {8, "more"},
                                                            {9, "design 9"}}));
  EXPECT_EQ(again.pin("next"), 10);
  EXPECT_THROW(again.take(2), InputError);
  EXPECT_THROW(again.pin("too many"), InputError);
}

nlohmann::json kept_in(const TemporaryFolder& place) {
  return nlohmann::json::parse(read_bytes(place.path() / ".studio/session.json"));
}

TEST(Session, KeepsTwoHundredStepsTheNewest) {
  const TemporaryFolder place;
  { Session session(place.path(), kHoles); }
  nlohmann::json kept = kept_in(place);
  EXPECT_EQ(kept,
            (nlohmann::json{{"schema", 1},
                            {"draft", {{"file", kHoles}, {"changes", nlohmann::json::array()}}},
                            {"past", nlohmann::json::array()},
                            {"future", nlohmann::json::array()},
                            {"pins", nlohmann::json::array()},
                            {"others", nlohmann::json::array()},
                            {"wishes", nlohmann::json::array()}}));
  const auto step = [](int nm) {
    const nlohmann::json change = {"texture.depth", std::to_string(nm) + " nm"};
    return nlohmann::json{{"file", kHoles}, {"changes", nlohmann::json::array({change})}};
  };
  for (int i = 0; i < 199; ++i) kept["past"].push_back(step(100 + i));
  kept["draft"] = step(299);
  write_bytes(place.path() / ".studio/session.json", kept.dump());
  Session session(place.path(), kHoles);
  session.set("texture.depth", "300 nm", 0);
  kept = kept_in(place);
  EXPECT_EQ(kept["past"].size(), 200u);
  EXPECT_EQ(kept["past"][0], step(100));
  session.set("texture.depth", "301 nm", 0);
  kept = kept_in(place);
  EXPECT_EQ(kept["past"].size(), 200u);
  EXPECT_EQ(kept["past"][0], step(101));
  EXPECT_EQ(kept["past"][199], step(300));
  EXPECT_EQ(kept["draft"], step(301));
  session.undo();
  kept = kept_in(place);
  EXPECT_EQ(kept["past"].size(), 199u);
  EXPECT_EQ(kept["future"], nlohmann::json::array({step(301)}));
}

TEST(Session, KeepsTheDraftOfEachFileThatWasOpened) {
  const TemporaryFolder place;
  const std::string flat = PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml";
  {
    Session session(place.path(), kHoles);
    session.set("texture.depth", "350 nm", 0);
    session.pin("mine");
  }
  {
    Session session(place.path(), flat);
    EXPECT_EQ(session.view().draft, (Draft{flat, {}}));
    EXPECT_EQ(session.view().pins.size(), 1u);
    EXPECT_FALSE(session.view().can_undo());
    session.set("drive.amplitude", "120 V", 0);
  }
  Session again(place.path(), kHoles);
  EXPECT_DOUBLE_EQ(depth(again), 350e-9);
  again.undo();
  EXPECT_DOUBLE_EQ(depth(again), 600e-9);
  Session other(place.path(), flat);
  EXPECT_DOUBLE_EQ(get_number(other.view().study.design, "drive.amplitude"), 120);
  other.take(1);
  EXPECT_DOUBLE_EQ(depth(other), 350e-9);
  EXPECT_DOUBLE_EQ(get_number(other.view().opened, "texture.depth"), 600e-9);
}

// A draft that was left on a file is gone once another design is saved under that file's name.
TEST(Session, ReopensWhatWasSavedLastUnderAName) {
  const TemporaryFolder place;
  const std::string mine = (place.path() / "mine.toml").string();
  write_bytes(mine, "schema_version = 1\nbase = \"m3_samples/flat.toml\"\n");
  {
    Session session(place.path(), mine);
    session.set("drive.amplitude", "77 V", 0);
  }
  {
    Session session(place.path(), kHoles);
    session.save_as(mine, [&](const Draft&, const Study&) {
      write_bytes(mine, "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n");
    });
    session.set("drive.amplitude", "88 V", 0);
  }
  Session again(place.path(), mine);
  EXPECT_DOUBLE_EQ(get_number(again.view().study.design, "drive.amplitude"), 88);
  EXPECT_DOUBLE_EQ(depth(again), 350e-9);
}

TEST(Session, AKindThatIsOnlyLookedAtLosesNothing) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  session.set("texture.diameter", "2.2 um", 0);
  const Design before = session.view().study.design;
  session.set_kind("waves");  // has no diameter
  session.set_kind("grating");
  session.set_kind("hole_array");
  EXPECT_EQ(session.view().study.design, before);
  session.set_kind("waves");
  session.set("texture.period", "5 um", 0);  // a measure that is shared goes along
  session.set_kind("hole_array");
  EXPECT_DOUBLE_EQ(get_number(session.view().study.design, "texture.period"), 5e-6);
}

// What its file says of 600 nm is no longer all of it.
TEST(Session, IsTitledByWhatWasChanged) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  const std::string title = session.view().study.design.title;
  session.set("texture.depth", "350 nm", 0);
  session.set("environment.relative_humidity", "35", 0);  // the same design, asked elsewhere
  EXPECT_EQ(session.view().study.design.title, title + "; texture.depth 350 nm");
  EXPECT_EQ(session.view().draft.changes.size(), 2u);
  session.undo();
  session.undo();
  EXPECT_EQ(session.view().study.design.title, title);
}

TEST(Session, ASliderEndsWhereTheDesignEnds) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  EXPECT_THROW(session.set("texture.diameter", "9 um", 3), InputError);  // period 6 um
  session.set_toward("texture.diameter", "9 um", 3);
  const double end = get_number(session.view().study.design, "texture.diameter");
  EXPECT_GT(end, 5.98e-6);
  EXPECT_LT(end, 6e-6);
  session.undo();
  EXPECT_DOUBLE_EQ(get_number(session.view().study.design, "texture.diameter"), 3e-6);
  EXPECT_THROW(session.set_toward("texture.lattice", "round", 0), InputError);
  EXPECT_THROW(session.set_toward("texture.nothing", "1", 0), InputError);
  EXPECT_THROW(session.set_toward("texture.diameter", "wide", 0), InputError);
}

TEST(Session, KeepsTheWishOfItsFileAndKind) {
  const TemporaryFolder place;
  {
    Session session(place.path(), kHoles);
    EXPECT_EQ(session.wish(), "");
    session.set_wish(R"({"evaluations":37})");
  }
  Session again(place.path(), kHoles);
  EXPECT_EQ(again.wish(), R"({"evaluations":37})");
  EXPECT_THROW(again.set_wish(std::string(200000, ' ')), InputError);
  again.set_kind("waves");
  again.set_wish(R"({"evaluations":11})");
  again.become({PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml", {}});
  EXPECT_EQ(again.wish(), "");
  again.set_wish(R"({"evaluations":5})");
  again.undo();
  EXPECT_EQ(again.wish(), R"({"evaluations":11})");
  again.set_kind("hole_array");
  EXPECT_EQ(again.wish(), R"({"evaluations":37})");
  again.forget_wish();
  EXPECT_EQ(again.wish(), "");
  again.become({PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml", {}});
  EXPECT_EQ(again.wish(), R"({"evaluations":5})");
}

TEST(Session, KeepsTwentyWishesTheNewest) {
  const TemporaryFolder place;
  { Session session(place.path(), kHoles); }
  nlohmann::json kept = kept_in(place);
  for (int i = 0; i < 30; ++i) {
    kept["wishes"].push_back(
        {{"file", std::to_string(i) + ".toml"}, {"kind", "waves"}, {"text", "{}"}});
  }
  write_bytes(place.path() / ".studio/session.json", kept.dump());
  Session session(place.path(), kHoles);
  session.set_wish("{}");
  kept = kept_in(place);
  ASSERT_EQ(kept["wishes"].size(), 20u);
  EXPECT_EQ(kept["wishes"][0]["file"], "11.toml");
  EXPECT_EQ(kept["wishes"][19]["file"], kHoles);
}

// So a design of another kind, picked from the front, is steered within the same limits.
TEST(Session, TakesWhatIsWantedAlongToAnotherKind) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  session.set_wish(
      R"({"kinds":["hole_array","waves"],"limits":[{"name":"min_wall","limit":"1.7 um"}],"variables":[]})");
  session.set_kind("waves");
  EXPECT_EQ(session.wish(),
            R"({"kinds":["hole_array","waves"],"limits":[{"name":"min_wall","limit":"1.7 um"}]})");
  session.set_wish(R"({"kinds":["waves"]})");
  session.set_kind("grating");
  EXPECT_EQ(session.wish(), R"({"kinds":["grating"]})");
  session.set_wish("damaged");
  session.set_kind("cap_array");
  EXPECT_EQ(session.wish(), "");
}

TEST(Session, TakesItsWishAlongWhereItIsSaved) {
  const TemporaryFolder place;
  const std::string mine = (place.path() / "mine.toml").string();
  const auto write = [&](const Draft&, const Study&) {
    write_bytes(mine, "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n");
  };
  {
    Session session(place.path(), kHoles);
    session.set_wish(R"({"evaluations":37})");
    session.save_as(mine, write);
    EXPECT_EQ(session.wish(), R"({"evaluations":37})");
  }
  Session again(place.path(), mine);
  EXPECT_EQ(again.wish(), R"({"evaluations":37})");
  // One of another file stays where it is.
  again.become({PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml", {}});
  again.save_as(mine, write);
  EXPECT_EQ(again.wish(), R"({"evaluations":37})");
  again.become({PAPILLA_DESIGNS_DIR "/m3_samples/flat.toml", {}});
  again.save_as((place.path() / "flat.toml").string(), [&](const Draft&, const Study&) {
    write_bytes(place.path() / "flat.toml",
                "schema_version = 1\nbase = \"m3_samples/flat.toml\"\n");
  });
  EXPECT_EQ(again.wish(), "");
}

// The other pins and the work on every file are not lost with it.
TEST(Session, KeepsAPinWhoseFileIsGone) {
  const TemporaryFolder place;
  const std::string old = (place.path() / "old.toml").string(),
                    text = "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n";
  write_bytes(old, text);
  {
    Session session(place.path(), old);
    session.pin("old");
    session.become({kHoles, {}});
    session.set("texture.depth", "262 nm", 0);
    session.pin("new");
    session.set_wish(R"({"evaluations":37})");
  }
  std::filesystem::remove(old);
  {
    Session session(place.path(), kHoles);
    EXPECT_DOUBLE_EQ(depth(session), 262e-9);
    EXPECT_TRUE(session.view().can_undo());
    EXPECT_EQ(session.wish(), R"({"evaluations":37})");
    ASSERT_EQ(session.view().pins.size(), 2u);
    EXPECT_THROW(session.take(1), InputError);
    EXPECT_DOUBLE_EQ(depth(session), 262e-9);
  }
  write_bytes(old, text);
  Session session(place.path(), kHoles);
  session.take(1);
  EXPECT_DOUBLE_EQ(depth(session), 350e-9);
}

TEST(Session, StaysAsItWasWhereItsFileCannotBeSaved) {
  const TemporaryFolder place;
  Session session(place.path(), kHoles);
  session.set("texture.depth", "350 nm", 0);
  const SessionView before = session.view();
  EXPECT_THROW(
      session.save_as(kHoles, [](const Draft&, const Study&) { throw InputError("full"); }),
      InputError);
  EXPECT_EQ(session.view().draft, before.draft);
  EXPECT_EQ(session.view().revision, before.revision);
}

TEST(Changes, MakeOneDesignOfAnother) {
  const Design from = read_design(kHoles);
  for (const char* other :
       {"/m3_samples/flat.toml", "/texture_families/study.toml", "/hydrophobic_glass/study.toml",
        "/coatings/crowded.toml", "/two_level_glass/study.toml"}) {
    const Design to = read_design(std::string(PAPILLA_DESIGNS_DIR) + other);
    Design reached = study_of({kHoles, changes_between(from, to)}).design;
    reached.title = to.title;  // which follows from the changes
    EXPECT_EQ(reached, to) << other;
  }
}

// The design of a study, without the study: fewer parts than that varies would be refused.
std::string two_levels(const TemporaryFolder& place) {
  const std::string file = (place.path() / "levels.toml").string();
  write_design(file, read_design(PAPILLA_DESIGNS_DIR "/two_level_glass/study.toml"));
  return file;
}

// What is not there has no key: a list with other items is set as a whole. Options of the model
// that nobody set follow the finger.
TEST(Changes, SayListsOfOtherItemsAndOtherDefaults) {
  const TemporaryFolder place;
  const std::string levels = two_levels(place);
  const Design from = read_design(levels);
  Design fewer = from, more = from, kinds = from, depth = from, fitted = from;
  const auto parts = [](Design& design) -> std::vector<Texture>& {
    return *roles(design.texture).parts;
  };
  ASSERT_EQ(parts(fewer).size(), 2u);
  parts(fewer).pop_back();
  more.surface.dielectric.push_back(more.surface.dielectric.front());
  Grating grooves;
  grooves.period = 2e-6, grooves.width = 1e-6;
  parts(kinds).back() = Texture{grooves};
  depth.surface.dielectric.front().thickness = 700e-9;
  fitted.finger.calibrated_for.water = WaterModel::Threshold;
  for (const auto& [to, changed] : {std::pair{&fewer, "texture.parts"},
                                    {&more, "surface.dielectric"},
                                    {&kinds, "texture.parts"},
                                    {&depth, "surface.dielectric.0.thickness"}}) {
    const std::vector<studio::Change> changes = changes_between(from, *to);
    ASSERT_EQ(changes.size(), 1u) << changed;
    EXPECT_EQ(changes.front().path, changed);
    EXPECT_EQ(study_of({levels, changes}).design, *to) << changed;
  }
  const std::vector<studio::Change> changes = changes_between(from, fitted);
  EXPECT_TRUE(std::any_of(changes.begin(), changes.end(), [](const studio::Change& c) {
    return c == studio::Change{"model.water", "droplets"};
  }));
}

// The form knows the items of such a list as changed, and each of them takes the list back.
TEST(Session, TakesAListThatWasSetAsAWholeBackAsAWhole) {
  const TemporaryFolder place;
  const std::string levels = two_levels(place);
  Session session(place.path(), levels);
  const Design before = session.view().study.design;
  Design fewer = before;
  std::vector<Texture>* parts = roles(fewer.texture).parts;
  parts->pop_back();
  session.become({levels, changes_between(before, fewer)});
  EXPECT_EQ(session.view().steps, std::vector<std::string>{"parts changed"});
  const SessionView view = session.view();
  for (const auto& row : form_json(view.study, view.opened, view.draft.changes)) {
    const bool part = row["path"].get<std::string>().starts_with("texture.parts.");
    EXPECT_EQ(row["changed"], part) << row["path"];
    EXPECT_EQ(row["place"] == "changed here", part) << row["path"];
  }
  session.set("texture.parts.0.depth", "90 nm", 0);
  session.reset("texture.parts.0.depth");
  EXPECT_EQ(session.view().draft.changes, std::vector<studio::Change>{});
  EXPECT_EQ(session.view().study.design, before);
}

TEST(Form, NamesEveryNumberWithItsUnitAndRange) {
  const Design design = read_design(kHoles);
  const std::vector<FormKey> keys = form_keys(design);
  const auto at = std::find_if(keys.begin(), keys.end(),
                               [](const FormKey& k) { return k.path == "texture.depth"; });
  ASSERT_NE(at, keys.end());
  EXPECT_EQ(at->value, "600 nm");
  EXPECT_DOUBLE_EQ(at->shown, 600);
  EXPECT_EQ(at->unit, "nm");
  EXPECT_DOUBLE_EQ(at->low, 0);
  EXPECT_DOUBLE_EQ(at->high, 1e5);
  Design copy = design;
  for (const NumberField& number : number_fields(copy)) {
    const bool listed = std::any_of(keys.begin(), keys.end(), [&](const FormKey& k) {
      return number.path == k.path || number.path.starts_with(k.path + ".");
    });
    EXPECT_TRUE(listed) << number.path;
  }
}

}  // namespace
}  // namespace papilla::tests::session_test
