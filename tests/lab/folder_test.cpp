// A lab as a folder: what is told is there once, whatever happens.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "calibrate/friction_table.h"
#include "geometry/io/files.h"
#include "report/lab_folder.h"
#include "report/lab_trace.h"
#include "report/lab_words.h"
#include "tests/cli/program.h"
#include "tests/lab/small_lab.h"
#include "tests/lab/tribometer.h"
#include "tests/support/refusal.h"

namespace papilla::tests::folder_test {
namespace {

namespace fs = std::filesystem;

class LabFolder : public testing::Test {
 protected:
  // One model run for all tests: each has a copy of the opened lab.
  static void SetUpTestSuite() {
    place_ = new TemporaryFolder;
    write_small_lab(place_->path());
    NextRun run;
    for (const char* d : {"deep", "shallow"})
      run.source.paths.push_back((place_->path() / (std::string(d) + ".toml")).string());
    run.source.belief = (place_->path() / "belief.toml").string();
    run.source.humidity = "35 %,75 %";
    run.folder = (place_->path() / "first").string();
    run.options.date = "2026-03-01";
    run.options.count = 4;
    plan_ = new NextReport(next_in_lab(run));
  }
  static void TearDownTestSuite() {
    delete plan_;
    delete place_;
  }
  void SetUp() override {
    folder_ = (own_.path() / "lab").string();
    fs::copy(place_->path() / "first", folder_, fs::copy_options::recursive);
  }

  std::string file(const std::string& name, const std::string& text) const {
    write_text(own_.path() / name, text);
    return (own_.path() / name).string();
  }
  TellReport tell(const std::vector<std::string>& files, bool replace = false,
                  const std::string& date = "2026-03-02", const std::string& design = "") const {
    TellRun run;
    run.folder = folder_;
    run.files = files;
    run.options.date = date;
    run.options.design = design;
    run.options.replace = replace;
    return tell_lab(run);
  }
  std::size_t readings() const { return Lab(folder_, 1).readings().size(); }
  std::string words(const TellReport& report) const {
    std::string out;
    for (const Problem& p : report.refused) out += p.text() + "\n";
    return out;
  }

  // The lab as of a run whose first limit is kept by the first three members, of one hypothesis.
  void stand_on_a_run() const {
    const std::vector<bool> kept{true, true, true, false, false, false};
    const std::vector<RunLimit> limits{{"worst(modulation)", 0.5}, {"min_wall", 1}};
    const RunWorth run{"mean(modulation)",
                       {"deep", "shallow"},
                       {std::vector<double>(6, 0.4), std::vector<double>(6, 0.3)},
                       {kept, kept},
                       {{}, {}},
                       {limits, limits}};
    LabFile lab_file = read_lab_file(folder_);
    lab_file.worth = run.name;
    lab_file.worth_file = "worth.json";
    write_text(folder_ + "/worth.json", run_worth_text(run));
    write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  }

  static constexpr const char* kHead =
      "design,repeat,load_N,humidity_percent,voltage_V,day,F_off_N,F_on_N\n";
  static TemporaryFolder* place_;
  static NextReport* plan_;
  TemporaryFolder own_;
  std::string folder_;
};
TemporaryFolder* LabFolder::place_ = nullptr;
NextReport* LabFolder::plan_ = nullptr;

TEST_F(LabFolder, PlansABatchWithItsReasonsAndATableToFillIn) {
  EXPECT_NE(plan_->markdown.find("Why these:"), std::string::npos);
  EXPECT_NE(plan_->markdown.find("is the best of 2 in worst(modulation) with probability"),
            std::string::npos);
  const std::string csv = file_text(folder_ + "/plan_01.csv");
  EXPECT_EQ(csv.substr(0, 23), "experiment,field,design");
  EXPECT_NE(csv.find("\nE01,,"), std::string::npos);
  for (const char* name : {"lab.md", "lab.json", "belief.toml", "readings.csv", "prior.toml"})
    EXPECT_TRUE(fs::is_regular_file(fs::path(folder_) / name)) << name;
  EXPECT_EQ(read_belief(folder_ + "/belief.toml").members.size(), 6u);
}

TEST_F(LabFolder, CountsATableOnceHoweverOftenItIsTold) {
  const std::string table = file("a.csv", std::string(kHead) +
                                              "deep,1,0.2,35,200,1,0.06,0.09\n"
                                              "deep,2,0.2,35,200,1,0.061,0.091\n"
                                              "shallow,1,0.2,75,200,1,0.08,0.12\n");
  TellReport told = tell({table});
  EXPECT_NE(told.markdown.find("3 readings told"), std::string::npos);
  EXPECT_EQ(readings(), 3u);
  const std::string belief = file_text(folder_ + "/belief.toml");
  told = tell({table, table});
  EXPECT_NE(told.markdown.find("3 readings told already"), std::string::npos);
  EXPECT_EQ(readings(), 3u);
  EXPECT_EQ(file_text(folder_ + "/belief.toml"), belief);
}

TEST_F(LabFolder, GivesEveryReadingWithItsStateToAFit) {
  tell({file("a.csv",
             "design,repeat,load_N,humidity_percent,voltage_V,day,state,F_off_N,F_on_N\n"
             "deep,1,0.2,35,200,1,clean,0.06,0.09\n"
             "deep,1,0.2,35,200,1,natural,,0.08\n")});
  const std::vector<FrictionDatum> rows = read_friction(folder_ + "/readings.csv").rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].state, FingerState::Clean);
  EXPECT_EQ(rows[0].off, 0.06);
  EXPECT_EQ(rows[1].state, FingerState::Natural);
  EXPECT_EQ(rows[1].off_sd, 0);
  EXPECT_EQ(rows[1].on, 0.08);
}

TEST_F(LabFolder, LeavesOutWhatItsBeliefIsMadeOf) {
  const std::string prior = folder_ + "/prior.toml";
  Belief belief = read_belief(prior);
  belief.readings = {reading_text(0.2, 0.37, 200, 0.06, 0.09)};
  write_text(prior, belief_text(belief));
  const std::string fitted = "deep,1,0.2,37,200,1,0.06,0.09\n";
  TellReport told = tell({file("fitted.csv", kHead + fitted)});
  EXPECT_NE(told.markdown.find("1 reading left out, since the belief is made of it"),
            std::string::npos)
      << told.markdown;
  EXPECT_EQ(readings(), 0u);
  told = tell({file("more.csv", kHead + fitted + "deep,2,0.2,37,200,1,0.061,0.09\n")});
  EXPECT_NE(told.markdown.find("1 reading told"), std::string::npos) << told.markdown;
  EXPECT_EQ(readings(), 1u);
  // What a lab has weighed is in the belief that it leaves.
  EXPECT_EQ(read_belief(folder_ + "/belief.toml").readings,
            (std::vector{belief.readings.front(), reading_text(0.2, 0.37, 200, 0.061, 0.09)}));
}

TEST_F(LabFolder, TakesHalfATableAndThenTheRestOfIt) {
  const std::string first = "deep,1,0.2,35,200,1,0.06,0.09\n", second = "deep,2,0.2,35,200,1,,\n",
                    later = "deep,2,0.2,35,200,1,0.061,0.091\n";
  TellReport told = tell({file("half.csv", kHead + first + second)});
  EXPECT_NE(told.markdown.find("1 row not measured yet"), std::string::npos);
  EXPECT_EQ(readings(), 1u);
  told = tell({file("half.csv", kHead + first + later)});
  EXPECT_NE(told.markdown.find("1 reading told already"), std::string::npos);
  EXPECT_EQ(readings(), 2u);
}

// At humidities that the lab has not asked the model about: each is evaluated by itself.
TEST_F(LabFolder, WeighsWhatIsToldInTwoCallsAsWhatIsToldInOne) {
  const std::vector<std::string> files{
      file("first.csv", std::string(kHead) + "deep,1,0.2,45,200,1,0.06,0.09\n"),
      file("second.csv", std::string(kHead) + "shallow,1,0.2,55,200,1,0.07,0.1\n"
                                              "deep,1,0.2,25,200,1,0.05,0.08\n")};
  const std::string apart = folder_;
  tell({files[0]});
  tell({files[1]});
  folder_ = (own_.path() / "together").string();
  fs::copy(place_->path() / "first", folder_, fs::copy_options::recursive);
  tell(files);
  for (const char* made : {"/belief.toml", "/lab.json", "/lab.md"})
    EXPECT_EQ(file_text(apart + made), file_text(folder_ + made)) << made;
}

TEST_F(LabFolder, KeepsNothingOfAFileThatIsRefused) {
  const std::string before = file_text(folder_ + "/lab.journal");
  const std::string good = "deep,1,0.2,35,200,1,0.06,0.09\n";
  for (const auto& [rows, why] :
       {std::pair("depe,1,0.2,35,200,1,0.06,0.09\n", "no design \"depe\", is it `deep`?"),
        std::pair("deep,1,200,35,200,1,0.06,0.09\n", "lies outside"),
        std::pair("deep,1,0.2,35,200,1,60,90\n", "are these mN?"),
        std::pair("deep,1,0.2,35,200,1,0.0", "the file is cut off")}) {
    const TellReport told = tell({file("bad.csv", kHead + good + rows)});
    EXPECT_NE(words(told).find(why), std::string::npos) << words(told);
    EXPECT_EQ(file_text(folder_ + "/lab.journal"), before);
  }
  const TellReport told = tell({file("field.csv", "field,F_off_N\nA7,0.1\n")});
  EXPECT_NE(words(told).find("no field \"A7\""), std::string::npos);
  EXPECT_EQ(readings(), 0u);
}

TEST_F(LabFolder, RefusesAContradictionUnlessItReplaces) {
  tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n")});
  const std::string other = file("b.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.066,0.1\n");
  const TellReport refused = tell({other});
  EXPECT_NE(words(refused).find("another value of repeat 1 of this experiment was told in a.csv of "
                                "2026-03-02"),
            std::string::npos);
  EXPECT_EQ(readings(), 1u);
  tell({other}, true);
  const std::vector<FrictionReading> now = Lab(folder_, 1).readings();
  ASSERT_EQ(now.size(), 1u);
  EXPECT_DOUBLE_EQ(now[0].off, 0.066);
}

// A plan leaves its days empty: what was told yesterday is not another day's today.
TEST_F(LabFolder, CountsAReadingOfNoSaidDayOnceOnTheNextDay) {
  const std::string head = "design,repeat,load_N,humidity_percent,voltage_V,F_off_N,F_on_N\n",
                    first = "deep,1,0.2,35,200,0.06,0.09\n", today = "2026-03-02",
                    tomorrow = "2026-03-03";
  const std::string half = file("half.csv", head + first + "deep,2,0.2,35,200,,\n");
  tell({half}, false, today);
  TellReport told = tell({half}, false, tomorrow);
  EXPECT_NE(told.markdown.find("1 reading told already, in half.csv of 2026-03-02"),
            std::string::npos)
      << told.markdown;
  tell({file("half.csv", head + first + "deep,2,0.2,35,200,0.061,0.091\n")}, false, tomorrow);
  tell({file("dated.csv", std::string(kHead) + "deep,1,0.2,35,200,2026-03-02,0.06,0.09\n")});
  const auto days = [&] {
    std::vector<std::string> out;
    for (const FrictionReading& r : Lab(folder_, 1).readings()) out.push_back(r.day);
    return out;
  };
  EXPECT_EQ(days(), (std::vector{today, tomorrow}));
  {
    Lab lab(folder_, 1);
    TellOptions options;
    options.date = options.day = "2026-03-04";
    const std::string grown = head + first + "deep,2,0.2,35,200,0.061,0.091\n";
    EXPECT_EQ(lab.tell(file("grown.csv", grown + "deep,3,0.2,35,200,,\n"), options, {}).already, 2);
    const Told again =
        lab.tell(file("grown.csv", grown + "deep,3,0.2,35,200,0.062,0.09\n"), options, {});
    EXPECT_EQ(again.already, 2);
    EXPECT_EQ(again.record.readings.front().day, "2026-03-04");
  }
  EXPECT_EQ(days(), (std::vector<std::string>{today, tomorrow, "2026-03-04"}));
  // Of another value nobody knows whether it is a correction or of today.
  const std::string other = file("other.csv", head + "deep,1,0.2,35,200,0.066,0.1\n");
  told = tell({other}, false, tomorrow);
  EXPECT_NE(words(told).find("say of which day it is, or --replace"), std::string::npos)
      << words(told);
  tell({other}, true, tomorrow);
  EXPECT_EQ(days(), (std::vector<std::string>{tomorrow, "2026-03-04", today}));
  tell({file("dated.csv", std::string(kHead) + "deep,1,0.2,35,200,2026-03-03,0.07,0.1\n")});
  EXPECT_EQ(days(), (std::vector<std::string>{tomorrow, "2026-03-04", today, tomorrow}));
  told = tell({file("third.csv", head + "deep,1,0.2,35,200,0.08,0.1\n")}, true, tomorrow);
  EXPECT_NE(words(told).find("day: not said, and repeat 1 of this experiment was told of "
                             "2026-03-02 and of 2026-03-03"),
            std::string::npos)
      << words(told);
}

TEST_F(LabFolder, GoesBackToAnEarlierValue) {
  const std::string first = file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n"),
                    second = file("b.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.066,0.1\n");
  tell({first});
  tell({second}, true);
  tell({first});  // the same file as before: nothing is new
  EXPECT_EQ(Lab(folder_, 1).readings().front().off, 0.066);
  tell({first}, true);
  const std::vector<FrictionReading> now = Lab(folder_, 1).readings();
  ASSERT_EQ(now.size(), 1u);
  EXPECT_EQ(now[0].off, 0.06);
}

TEST_F(LabFolder, TakesBackWhatARecordWasToldAs) {
  Tribometer t;
  t.off = 0.06;
  t.on = 0.09;
  t.strokes = 6;
  const std::string record = file("run.csv", t.record());
  tell({record}, false, "2026-03-02", "deep");
  tell({record}, false, "2026-03-03", "shallow");
  EXPECT_EQ(Lab(folder_, 1).readings().front().experiment.design, 0u);
  const TellReport told = tell({record}, true, "2026-03-03", "shallow");
  EXPECT_NE(told.markdown.find("no longer counted: 1 reading that this file was told as before"),
            std::string::npos)
      << told.markdown << words(told);
  const std::vector<FrictionReading> now = Lab(folder_, 1).readings();
  ASSERT_EQ(now.size(), 1u);
  EXPECT_EQ(now[0].experiment.design, 1u);
  EXPECT_EQ(now[0].day, "2026-03-02");
  tell({record}, true, "2026-03-04", "shallow");
  EXPECT_EQ(readings(), 1u);
}

TEST_F(LabFolder, NumbersTheTouchesOfAPlanAfterThoseBefore) {
  const auto repeats = [&] {
    const Lab lab(folder_, 1);
    PlanRecord plan;
    plan.experiments = {lab.planned().front()};
    plan.experiments.front().id = "E99";
    plan.experiments.front().repeats = 2;
    std::vector<std::string> out;
    for (const std::string& line : split(lab_plan_csv(lab, plan), '\n'))
      if (line.starts_with("E99")) out.push_back(split(line, ',')[3]);
    return out;
  };
  const int planned = Lab(folder_, 1).planned().front().repeats;
  EXPECT_EQ(repeats(), (std::vector{std::to_string(planned + 1), std::to_string(planned + 2)}));
  tell({file("a.csv", "experiment,repeat,F_off_N\nE01,9,0.06\n")});
  EXPECT_EQ(repeats(), (std::vector<std::string>{"10", "11"}));
}

TEST_F(LabFolder, TakesARecordAsAReadingWithAPicture) {
  Tribometer t;
  t.off = 0.06;
  t.on = 0.09;
  const std::string record = file("E01_run.csv", t.record("# finger: Ada\n"));
  TellReport told = tell({record});
  const std::vector<FrictionReading> now = Lab(folder_, 1).readings();
  ASSERT_EQ(now.size(), 1u) << words(told);
  EXPECT_EQ(now[0].finger, "Ada");
  EXPECT_NEAR(now[0].off, 0.06, 0.001);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ + "/traces"), {}), 1);
  told = tell({record});
  EXPECT_NE(told.markdown.find("told already"), std::string::npos);
  EXPECT_EQ(readings(), 1u);
}

// Ten touches say what the next one will, and no scatter that none of them has stated.
TEST_F(LabFolder, ExpectsOfATouchWhatThoseBeforeItHadRead) {
  std::string rows = kHead;
  for (int repeat = 1; repeat <= 10; ++repeat)
    rows += fmt::format("deep,{},0.2,35,200,2026-03-02,0.06,0.09\n", repeat);
  const TellReport told = tell({file("ten.csv", rows)});
  EXPECT_NE(told.markdown.find("F_off 60 mN, F_on 90 mN"), std::string::npos) << told.markdown;
  NextOptions options;
  options.aim = Aim::Decision;
  options.date = "2026-03-03";
  options.count = 2;
  const PlanRecord plan = Lab(folder_, 1).next(options);
  ASSERT_FALSE(plan.experiments.empty());
  for (const PlannedExperiment& p : plan.experiments) {
    for (const auto& [expected, thirds] :
         {std::pair(p.expected_off, p.off), std::pair(p.expected_on, p.on)}) {
      ASSERT_EQ(thirds.size(), 3u);
      EXPECT_GT(expected.at(0), thirds[1].low) << p.id;  // the median lies in the middle third
      EXPECT_LT(expected.at(0), thirds[1].high) << p.id;
    }
  }
}

TEST_F(LabFolder, MovesWeightToTheHypothesisThatTheReadingsSpeakFor) {
  Lab lab(folder_, 1);
  const Standing& s = lab.standing();
  const double before = s.p_hypothesis[1];
  // Readings as a member of the second hypothesis says them.
  const std::size_t member = 4;
  std::string rows = kHead;
  MemberModel model(lab.belief(), folder_, 1);
  for (std::size_t d = 0; d < 2; ++d) {
    for (const double rh : {0.35, 0.75}) {
      const MemberFriction f =
          model.friction(lab.designs()[d], {0.2, rh, 200, 0, FingerState::Clean});
      for (int repeat = 1; repeat <= 3; ++repeat)
        rows += fmt::format("{},{},0.2,{},200,1,{:.6f},{:.6f}\n", lab.designs()[d].name, repeat,
                            100 * rh, f.off.at[member], f.on.at[member]);
    }
  }
  TellOptions options;
  options.date = "2026-03-02";
  const Told told = lab.tell(file("model.csv", rows), options, {});
  EXPECT_EQ(told.record.readings.size(), 12u);
  EXPECT_GT(told.after->p_hypothesis[1], before + 0.2);
  EXPECT_LT(told.after->regret, told.before->regret + 1e-12);
}

TEST_F(LabFolder, CutsOffADamagedRecordAndKeepsACopy) {
  tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n")});
  tell({file("b.csv", std::string(kHead) + "deep,2,0.2,35,200,1,0.061,0.09\n")});
  std::string journal = file_text(folder_ + "/lab.journal");
  const std::size_t last = journal.rfind('\n', journal.size() - 2);
  journal[last + 40] = '~';
  write_text(folder_ + "/lab.journal", journal);
  const Lab lab(folder_, 1);
  EXPECT_EQ(lab.lost(), 1);
  EXPECT_EQ(lab.readings().size(), 1u);
  EXPECT_TRUE(fs::is_regular_file(lab.kept_copy()));
}

TEST_F(LabFolder, RefusesASecondOneThatWorksInIt) {
  const Lab lab(folder_, 1);
  EXPECT_NE(refusal_of([&] { const Lab second(folder_, 1); }).find("another papilla next or tell"),
            std::string::npos);
}

TEST_F(LabFolder, OpensAnewALabWhoseFirstPlanFailed) {
  NextRun run;
  run.source.paths = {(place_->path() / "deep.toml").string()};
  run.source.belief = (place_->path() / "belief.toml").string();
  run.folder = (own_.path() / "new").string();
  run.options.date = "2026-03-01";
  run.options.aim = Aim::Decision;  // of one design there is none
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("nothing is decided"), std::string::npos);
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("nothing is decided"), std::string::npos);
  run.source.values = {"instrument.repeatability=2 %", "costs.reading:=90"};
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("nothing is decided"), std::string::npos);
  EXPECT_EQ(read_lab_file(run.folder).instrument.repeatability, 0.02);
  EXPECT_EQ(read_lab_file(run.folder).costs.reading, 90);
  run.source.values = {"instrument.repeatability=2 V"};
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("instrument.repeatability"),
            std::string::npos);
  run.source.values = {"belief=other.toml"};
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("is not set like this"), std::string::npos);
  run.source.values.clear();
  run.folder = folder_;  // one with a plan stays
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("is a lab already"), std::string::npos);
}

// The state of the finger is a condition of the table that the calibration fits, as load and
// humidity are.
TEST_F(LabFolder, PlansInTheStatesOfTheTableThatItsCalibrationFits) {
  file("measured.csv",
       "design,load_N,humidity_percent,voltage_V,frequency_Hz,state,F_off_N,F_off_sd_N,F_on_N,"
       "F_on_sd_N\ndeep.toml,0.2,35,0,0,natural,0.06,0.003,,\n"
       "deep.toml,0.2,75,0,0,wet,0.05,0.003,,\n");
  fs::copy(place_->path() / "deep.toml", own_.path() / "deep.toml");
  NextRun run;
  run.source.paths = {file("fit.toml",
                           "schema_version = 1\nfinger = \"fingers/reference.toml\"\n"
                           "data = \"measured.csv\"\n[parameters]\n\"skin.layer_modulus\" = "
                           "{ low = \"10 MPa\", high = \"500 MPa\", prior = \"66 MPa\", factor = "
                           "2.0 }\n")};
  run.source.belief = (place_->path() / "belief.toml").string();
  run.folder = (own_.path() / "new").string();
  run.options.aim = Aim::Decision;  // refused: the plan is not what is looked at here
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("nothing is decided"), std::string::npos);
  EXPECT_EQ(read_lab_file(run.folder).conditions.states,
            (std::vector<std::string>{"natural", "wet"}));
}

// What a lab was opened with is in its files: said again it would change nothing.
TEST_F(LabFolder, RefusesConditionsOfALabThatGoesOn) {
  NextRun run;
  run.source.paths = {folder_};
  run.source.humidity = "55 %";
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("lab.toml"), std::string::npos);
}

// Two designs that differ by .01 at every member: sure where the run knew it, not where each is
// known to .02 by skins of its own.
TEST_F(LabFolder, KnowsWhatTheSkinsOfItsRunLeftOpen) {
  const auto p_best = [&](const std::vector<std::vector<double>>& by_skin) {
    RunWorth run{"worst(modulation)", {"deep", "shallow"}, {{}, {}}, {}, by_skin};
    for (const double worth : {0.28, 0.29, 0.30, 0.31, 0.32, 0.33}) {
      run.worth[0].push_back(worth);
      run.worth[1].push_back(worth - 0.01);
    }
    run.kept.assign(2, std::vector<bool>(6, true));
    LabFile file = read_lab_file(folder_);
    file.worth_file = "worth.json";
    write_text(folder_ + "/worth.json", run_worth_text(run));
    write_text(folder_ + "/lab.toml", lab_file_text(file));
    Lab lab(folder_, 1);
    return lab.standing().prospects[0].p_best;
  };
  EXPECT_GT(p_best({{}, {}}), 0.99);
  EXPECT_GT(p_best({{0.02}, {0.02}}), 0.99);  // the same skins move both alike
  EXPECT_NEAR(p_best({{0.02, 0}, {0, 0.02}}), 0.5 * std::erfc(-0.01 / 0.04), 0.05);
}

PlanRecord stopped(StopReason reason) {
  PlanRecord plan;
  plan.stop = true;
  plan.stop_reason = reason;
  return plan;
}

TEST_F(LabFolder, SaysWhereItStopsThatItsChoiceMayBreakALimit) {
  stand_on_a_run();
  Lab lab(folder_, 1);
  for (const StopReason reason : {StopReason::Regret, StopReason::NoChange}) {
    const std::string text = lab_plan_text(lab, stopped(reason));
    const std::size_t stop = text.find("Stop: ");
    ASSERT_NE(stop, std::string::npos) << text;
    for (const std::string& part :
         {std::string("To stop does not mean that the design is good enough."),
          std::string("deep keeps every limit of its study with probability 50 %, where 90 % are "
                      "wanted (`limits` in lab.toml). It may break, with the probability that the "
                      "run gave to keeping it: worst(modulation) (50 %)."),
          "`papilla next " + folder_ + " --for hypotheses`"})
      EXPECT_NE(text.find(part, stop), std::string::npos) << part << "\n" << text;
    EXPECT_EQ(text.find("min_wall"), std::string::npos) << text;
    EXPECT_EQ(text.find("Search again"), std::string::npos) << text;  // no readings yet
  }
  EXPECT_NE(lab_page(lab).find("| p(every limit) |"), std::string::npos) << lab_page(lab);
  const auto standing = nlohmann::json::parse(lab_state_json(lab))["standing"];
  EXPECT_EQ(standing["keeps_limits"], false);
  EXPECT_EQ(standing["limits_wanted"], 0.9);
}

TEST_F(LabFolder, SaysNothingOfLimitsThatItsChoiceKeeps) {
  stand_on_a_run();
  LabFile lab_file = read_lab_file(folder_);
  lab_file.limits = 0.4;
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  Lab lab(folder_, 1);
  const std::string text = lab_plan_text(lab, stopped(StopReason::Regret));
  EXPECT_EQ(text.find("good enough"), std::string::npos) << text;
  EXPECT_EQ(text.find("where 40 % are wanted"), std::string::npos) << text;
}

// Friction without voltage tells nothing of the hypotheses, so the limit stays in question.
TEST_F(LabFolder, AdvisesToSearchAgainWithItsReadings) {
  stand_on_a_run();
  tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,\n")});
  Lab lab(folder_, 1);
  ASSERT_EQ(lab.readings().size(), 1u);
  ASSERT_FALSE(lab.standing().keeps_limits());
  const std::string text = lab_plan_text(lab, stopped(StopReason::Regret));
  EXPECT_NE(text.find("`belief = \"" + folder_ + "/belief.toml\"` in the study's [finger]"),
            std::string::npos)
      << text;
}

TEST_F(LabFolder, SaysBeforeItsFirstReadingWhyItsProbabilityIsNotThatOfTheRun) {
  stand_on_a_run();
  const char* const reason = "p(best) and regret are not quite those of the run";
  {
    Lab lab(folder_, 1);
    EXPECT_NE(lab_standing_text(lab).find(reason), std::string::npos) << lab_standing_text(lab);
  }
  const TellReport told =
      tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n")});
  EXPECT_EQ(told.markdown.find(reason), std::string::npos) << told.markdown;
}

// A lab of an older program: its worth.json says all limits together, and no name of one.
TEST_F(LabFolder, ReadsARunsWorthThatNamesNoLimits) {
  stand_on_a_run();
  nlohmann::json worth = nlohmann::json::parse(file_text(folder_ + "/worth.json"));
  worth.erase("limits");
  write_text(folder_ + "/worth.json", worth.dump());
  Lab lab(folder_, 1);
  const std::string text = lab_standing_text(lab);
  EXPECT_NE(text.find("with probability 50 %, where 90 % are wanted"), std::string::npos) << text;
  EXPECT_EQ(text.find("It may break"), std::string::npos) << text;
}

// What a bench has to set stands in the plan, though the lab knows it as the design's own.
TEST_F(LabFolder, SaysTheFrequencyOfTheDesignInItsPlan) {
  const std::string plan = file_text(folder_ + "/plan_01.csv");
  const double own = Lab(folder_, 1).designs().front().design.drive.frequency;
  EXPECT_NE(plan.find(fmt::format(",200,{:.6g},clean", own)), std::string::npos) << plan;
  tell(
      {file("a.csv", fmt::format("design,repeat,load_N,humidity_percent,voltage_V,frequency_Hz,day,"
                                 "F_off_N,F_on_N\ndeep,1,0.2,35,200,{:.6g},1,0.06,0.09\n",
                                 own))});
  EXPECT_EQ(Lab(folder_, 1).readings().front().experiment.at.frequency, 0);
}

// Labs that say the design's own frequency by 0 have always opened.
TEST_F(LabFolder, ReadsAFrequencyOfZeroAsThatOfItsDesigns) {
  LabFile lab_file = read_lab_file(folder_);
  EXPECT_EQ(carrier_frequencies(lab_file.conditions), std::vector{0.0});
  lab_file.conditions.frequency = {0};
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  EXPECT_EQ(carrier_frequencies(read_lab_file(folder_).conditions), std::vector{0.0});
}

TEST_F(LabFolder, SaysWhatIsWrongInLabToml) {
  std::string text = file_text(folder_ + "/lab.toml");
  const std::size_t at = text.find("repeatability");
  text.insert(at, "repeatabilty = \"3 %\"\n");
  write_text(folder_ + "/lab.toml", text);
  EXPECT_NE(refusal_of([&] { const Lab lab(folder_, 1); }).find("repeatability"),
            std::string::npos);
}

// Measurements are valued by expected regret, whatever decides.
TEST_F(LabFolder, SaysWhereMeasurementsAreValuedByAnotherCriterionThanItsOwn) {
  stand_on_a_run();
  const auto plan = [&] {
    Lab lab(folder_, 1);
    return lab_plan_text(lab, stopped(StopReason::Regret));
  };
  const char* const said = "by the least expected regret alone, not by `risk` = \"worst 10 %\"";
  EXPECT_EQ(plan().find("not by"), std::string::npos);
  LabFile lab_file = read_lab_file(folder_);
  lab_file.risk = "worst 10 %";
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  EXPECT_NE(plan().find(said), std::string::npos) << plan();
  EXPECT_NE(plan().find("It is chosen by `risk` = \"worst 10 %\" of lab.toml"), std::string::npos);
  // A lab of an older program says none.
  std::string text = lab_file_text(lab_file);
  const std::size_t at = text.find("risk = ");
  ASSERT_NE(at, std::string::npos);
  text.erase(at, text.find('\n', at) + 1 - at);
  write_text(folder_ + "/lab.toml", text);
  EXPECT_EQ(read_lab_file(folder_).risk, "regret");
  text.insert(at, "risk = \"luck\"\n");
  write_text(folder_ + "/lab.toml", text);
  EXPECT_NE(refusal_of([&] { read_lab_file(folder_); }).find("expected \"regret\", \"mean\""),
            std::string::npos);
}

// A lab.toml by which a design can be chosen that the run says nothing of.
TEST_F(LabFolder, RefusesAChoiceThatItsRunDoesNotKnow) {
  const RunWorth run{"worst(modulation)",
                     {"deep"},
                     {std::vector<double>(6, 0.3)},
                     {std::vector<bool>(6, true)},
                     {{}}};
  LabFile lab_file = read_lab_file(folder_);
  lab_file.worth_file = "worth.json";
  write_text(folder_ + "/worth.json", run_worth_text(run));
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  EXPECT_NE(refusal_of([&] {
              Lab(folder_, 1).standing();
            }).find("\"shallow\" is decided among, but worth.json does not say"),
            std::string::npos);
}

TEST_F(LabFolder, KeepsItsRecordsOfADesignThatIsNoLongerAChoice) {
  const auto plans = [&] {
    Lab lab(folder_, 1);
    return nlohmann::json::parse(lab_state_json(lab))["plans"].dump();
  };
  const std::string before = plans();
  EXPECT_NE(before.find("\"choice\":"), std::string::npos) << before;
  LabFile lab_file = read_lab_file(folder_);
  lab_file.designs[0].choice = false;
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  EXPECT_EQ(plans(), before);
  EXPECT_NE(decisions_svg(Lab(folder_, 1)).find("deep, no longer a choice"), std::string::npos);
  const TellReport told =
      tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n")});
  EXPECT_NE(told.markdown.find("1 reading told"), std::string::npos) << words(told);
}

// Another order of lab.toml, and one design less.
TEST_F(LabFolder, KeepsReadingsWithTheirDesignWhereverItStandsInTheList) {
  const std::string rows = std::string(kHead) +
                           "deep,1,0.2,35,200,1,0.06,0.09\n"
                           "shallow,1,0.2,75,200,1,0.08,0.12\n";
  tell({file("a.csv", rows)});
  const auto told = [&] {
    const Lab lab(folder_, 1);
    std::vector<std::string> out;
    for (const PlannedExperiment& p : lab.planned())
      out.push_back(p.id + " " + lab.designs()[p.experiment.design].name);
    for (const FrictionReading& r : lab.readings())
      out.push_back(fmt::format("{} {}", lab.designs()[r.experiment.design].name, r.off));
    return out;
  };
  const std::vector<std::string> before = told();
  EXPECT_EQ(before.back(), "shallow 0.08");
  LabFile lab_file = read_lab_file(folder_);
  std::swap(lab_file.designs[0], lab_file.designs[1]);
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  EXPECT_EQ(Lab(folder_, 1).designs().front().name, "shallow");
  EXPECT_EQ(told(), before);
  const TellReport grown = tell({file("b.csv", rows + "deep,2,0.2,35,200,1,0.061,0.091\n")});
  EXPECT_NE(grown.markdown.find("b.csv: 1 reading told\n"), std::string::npos) << words(grown);
  EXPECT_NE(grown.markdown.find("2 readings told already"), std::string::npos) << grown.markdown;
  // What came of the files stands before the heading of what the lab says now (the studio cuts
  // there).
  EXPECT_LT(grown.markdown.find("2 readings told already"),
            grown.markdown.find("\n# Where the lab stands\n\n"))
      << grown.markdown;
  lab_file.designs.erase(lab_file.designs.begin());
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  EXPECT_NE(refusal_of([&] {
              const Lab lab(folder_, 1);
            }).find("\"shallow\" was planned or measured and is not in the list any more"),
            std::string::npos);
}

TEST_F(LabFolder, SaysHowMuchIsLeftToAskTheModel) {
  std::vector<std::string> noted;
  Lab lab(folder_, 1, [&](const std::string& text) { noted.push_back(text); });
  TellOptions options;
  options.date = "2026-03-02";
  lab.tell(file("a.csv", std::string(kHead) +
                             "deep,1,0.2,35,200,1,0.06,0.09\n"  // as planned: it is known
                             "deep,1,0.2,45,200,1,0.06,0.09\n"
                             "shallow,1,0.2,55,200,1,0.07,0.1\n"),
           options, {});
  EXPECT_EQ(noted, (std::vector<std::string>{
                       "1 of 2: deep, 45 % RH, 0.2 N, 200 V, clean, at 6 members",
                       "2 of 2: shallow, 55 % RH, 0.2 N, 200 V, clean, at 6 members"}));
}

TEST_F(LabFolder, KeepsNoAnswerOfAMapThatWasWrittenAnew) {
  const std::string map = (own_.path() / "map.npy").string();
  const Grid grid{32, 32, 20e-6, 20e-6};
  Heightmap dots{grid, std::vector<double>(grid.size(), 0)};
  for (std::size_t i = 0; i < grid.size(); i += 7) dots.z[i] = 100e-9;
  write_npy(map, dots);
  Measured3d measured;
  measured.file = map, measured.width = 20e-6, measured.patch = 12e-6;
  LabDesign scan = Lab(folder_, 1).designs().front();
  scan.design.texture = Texture{measured};
  Belief belief = Lab(folder_, 1).belief();
  belief.members.resize(1);
  MemberModel model(belief, own_.path().string(), 1);
  const Conditions at{0.2, 0.35};
  model.friction(scan, at);
  EXPECT_TRUE(model.kept_friction(scan, at));
  fs::last_write_time(map, fs::last_write_time(map) + std::chrono::seconds(1));
  EXPECT_FALSE(model.kept_friction(scan, at));
}

// Of a worth that is minimised: 53.3 mN at every member, not -0.0533.
TEST_F(LabFolder, SaysAWorthThatIsMinimisedInItsUnit) {
  RunWorth run{"mean(friction)",
               {"deep", "shallow"},
               {std::vector<double>(6, -0.0533), std::vector<double>(6, -0.06)},
               {std::vector<bool>(6, true), std::vector<bool>(6, true)},
               {{}, {}}};
  LabFile lab_file = read_lab_file(folder_);
  lab_file.worth = run.name;
  lab_file.worth_file = "worth.json";
  write_text(folder_ + "/worth.json", run_worth_text(run));
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  Lab lab(folder_, 1);
  const std::string text = lab_standing_text(lab);
  EXPECT_NE(text.find("worth [mN], median (95 %)"), std::string::npos) << text;
  EXPECT_NE(text.find("53.3 (53.3 to 53.3)"), std::string::npos) << text;
  EXPECT_EQ(text.find("-0.05"), std::string::npos) << text;
  const auto standing = nlohmann::json::parse(lab_state_json(lab))["standing"];
  EXPECT_NEAR(standing["best_worth"].get<double>(), 0.0533, 1e-9);
  EXPECT_NEAR(standing["designs"][1]["worth"].get<double>(), 0.06, 1e-9);
  EXPECT_NEAR(standing["designs"][1]["worth_mean"].get<double>(), 0.06, 1e-9);
}

// Its regrets are shares of the worth of then.
TEST_F(LabFolder, SaysTheReasonOfAPlanAsItWasWhateverIsToldLater) {
  const auto why = [&] {
    Lab lab(folder_, 1);
    return nlohmann::json::parse(lab_state_json(lab))["why"].get<std::string>();
  };
  const std::string before = why();
  EXPECT_NE(before.find(" %)"), std::string::npos) << before;
  tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.03,0.09\n")});
  EXPECT_EQ(why(), before);
}

TEST_F(LabFolder, SumsUpInTheWordsOfItsPage) {
  stand_on_a_run();
  {
    Lab lab(folder_, 1);
    const std::string summary = lab_summary_text(lab);
    EXPECT_TRUE(summary.starts_with("deep is the best with probability ")) << summary;
    for (const char* part :
         {"too few to rely on", " deep keeps every limit of its study with probability 50 %"})
      EXPECT_NE(summary.find(part), std::string::npos) << part << "\n" << summary;
    for (const char* part : {" told.", " (before "})  // nothing was told yet
      EXPECT_EQ(summary.find(part), std::string::npos) << part << "\n" << summary;
    EXPECT_EQ(nlohmann::json::parse(lab_state_json(lab))["summary"], summary);
  }
  tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n")});
  Lab lab(folder_, 1);
  const std::string summary = lab_summary_text(lab), text = lab_standing_text(lab);
  EXPECT_NE(summary.find(" (before "), std::string::npos) << summary;
  EXPECT_NE(summary.find("; 1 reading of 1 file told. "), std::string::npos) << summary;
  const std::size_t at = text.find("The members explain all readings with probability");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_NE(summary.find(text.substr(at, text.find('\n', at) - at)), std::string::npos) << summary;
}

// A plan since then keeps a decision of its own, which is not what was before the file.
TEST_F(LabFolder, SumsUpWhatWasBeforeTheLastFileThoughAPlanFollowed) {
  const auto head = [&] {
    Lab lab(folder_, 1);
    const std::string out = lab_summary_text(lab);
    return out.substr(0, out.find(", expected regret"));
  };
  tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,200,1,0.06,0.09\n")});
  const std::string told = head();
  EXPECT_NE(told.find(" (before "), std::string::npos) << told;
  NextRun plan;
  plan.source.paths = {folder_};
  plan.options.date = "2026-03-03";
  plan.options.count = 1;
  next_in_lab(plan);
  EXPECT_EQ(head(), told);
}

TEST_F(LabFolder, SaysThatAFitIsOfOneOfItsFingers) {
  const auto said = [&] {
    Lab lab(folder_, 1);
    return lab_standing_text(lab).find("`data_finger`");
  };
  const std::string head = std::string("finger,") + kHead;
  tell({file("a.csv", head + "Ada,deep,1,0.2,35,200,1,0.06,0.09\n")});
  EXPECT_EQ(said(), std::string::npos);
  tell({file("b.csv", head + "Ben,deep,1,0.2,35,200,1,0.06,0.09\n")});
  EXPECT_NE(said(), std::string::npos);
}

// The film does not stand 2,000 V at any member.
TEST_F(LabFolder, PlansNoVoltageUnderWhichAMemberHasNoFriction) {
  NextRun run;
  run.source.paths = {(place_->path() / "deep.toml").string()};
  run.source.belief = (place_->path() / "belief.toml").string();
  run.source.humidity = "35 %";
  run.source.voltage = "2000 V,0 V";
  run.folder = folder_ = (own_.path() / "high").string();
  run.options.date = "2026-03-01";
  run.options.count = 3;
  next_in_lab(run);
  const std::vector<PlannedExperiment> planned = Lab(folder_, 1).planned();
  EXPECT_FALSE(planned.empty());
  for (const PlannedExperiment& p : planned)
    EXPECT_TRUE(!p.experiment.at.driven() || !p.expected_on.empty()) << p.id;
  // What was measured there all the same is not lost.
  const TellReport told =
      tell({file("a.csv", std::string(kHead) + "deep,1,0.2,35,2000,1,0.06,0.09\n")});
  EXPECT_NE(told.markdown.find("F_on of deep, 35 % RH, 0.2 N, 2000 V, clean is kept but has no "
                               "weight"),
            std::string::npos)
      << told.markdown << words(told);
  ASSERT_EQ(readings(), 1u);
  EXPECT_EQ(Lab(folder_, 1).readings().front().on, 0.09);
}

TEST_F(LabFolder, GoesOnInNoOtherFolder) {
  NextRun run;
  run.source.paths = {folder_};
  run.folder = (own_.path() / "other").string();
  EXPECT_NE(refusal_of([&] { next_in_lab(run); }).find("is a lab, which goes on in its own folder"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(run.folder));
}

TEST_F(LabFolder, SaysThatNothingFitsIntoItsTime) {
  LabFile lab_file = read_lab_file(folder_);
  lab_file.stop = 0;  // no regret is too small to go on
  write_text(folder_ + "/lab.toml", lab_file_text(lab_file));
  NextRun run;
  run.source.paths = {folder_};
  run.options.date = "2026-03-02";
  run.options.seconds = 45 * 60;  // a touch with all that it needs takes an hour
  const NextReport next = next_in_lab(run);
  EXPECT_NE(next.markdown.find("Nothing fits into the time that was given: the shortest experiment "
                               "that tells anything takes 1 h 0 min."),
            std::string::npos)
      << next.markdown;
  EXPECT_NE(next.json.find("\"ended\": \"time\""), std::string::npos);
  EXPECT_FALSE(next.stop);
}

}  // namespace
}  // namespace papilla::tests::folder_test
