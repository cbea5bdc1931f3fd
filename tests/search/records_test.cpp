// Records of a journal that no run of its study wrote: each is refused before anybody counts on it.
#include "search/records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "base/error.h"
#include "search/replay.h"
#include "tests/search/small_study.h"

namespace papilla::tests::records_test {
namespace {

class Records : public ::testing::Test {
 protected:
  Point unit() const { return Point(search_.space.size(), 0.5); }
  TaskRequest request(Stage stage) const { return {stage, 0, false, unit(), 0}; }
  Outcome outcome() const {
    Outcome out;
    out.ok = true;
    out.objectives.assign(search_.objectives, -0.5);
    out.constraints.assign(search_.constraints, -1);
    return out;
  }
  TaskAnswer answer() const {
    TaskAnswer out;
    const std::size_t humidities = study_.design.environment.relative_humidity.size();
    out.objectives.assign(search_.objectives, {0.5, 0.01, std::vector<double>(humidities, 0.5)});
    out.limited.assign(problem_.goals().limited.size(), 0);
    if (problem_.goals().looks) out.look = Look{};
    return out;
  }
  JournalRecord judged(const std::function<void(TaskRequest&, Outcome&)>& change) const {
    TaskRequest r = request(Stage::Search);
    Outcome o = outcome();
    change(r, o);
    return {encode(r), encode(search::Judgement{o, 0})};
  }
  JournalRecord answered(Stage stage,
                         const std::function<void(TaskRequest&, TaskAnswer&)>& change) const {
    TaskRequest r = request(stage);
    TaskAnswer a = answer();
    change(r, a);
    return {encode(r), encode(a)};
  }
  bool sound(const JournalRecord& record) const {
    return checked_request(problem_, search_, record).has_value();
  }

  const Study study_ = small_study();
  const StudyProblem problem_{study_};
  const SearchProblem search_ = search_problem(problem_);
};

TEST_F(Records, OfTheStudyAreTaken) {
  EXPECT_TRUE(sound(judged([](TaskRequest&, Outcome&) {})));
  EXPECT_TRUE(sound(judged([](TaskRequest&, Outcome& o) {
    o = {};
    o.reason = "crashed";
    o.constraints = {0.5, -1, 2};  // of its shape
  })));
  for (const Stage stage : {Stage::Draft, Stage::Narrow, Stage::Confirm, Stage::Stability,
                            Stage::Rounding, Stage::Sensitivity, Stage::Steps}) {
    EXPECT_TRUE(sound(answered(stage, [](TaskRequest&, TaskAnswer&) {})));
    EXPECT_TRUE(sound(answered(stage, [](TaskRequest&, TaskAnswer& a) {
      a = TaskAnswer::refused(TaskStatus::Kind::Crashed, "crashed");
    })));
  }
  TaskRequest done = request(Stage::Done);
  for (const std::size_t why : {std::size_t{0}, kSearchExhausted, kSearchExhausted + 1}) {
    done.task = why;
    EXPECT_EQ(sound({encode(done), ""}), why <= kSearchExhausted);
  }
}

// Of a place beside the space only the study's own finish is asked of, where its file has it there.
TEST(RecordsBesideTheSpace, AreOfTheStudysOwnSurfaceAlone) {
  Study study = small_study();
  for (const bool beside : {false, true}) {
    if (beside) study.variables[3].low = study.design.surface.contact_angle + 0.1;
    const StudyProblem problem(study);
    const SearchProblem search = search_problem(problem);
    const Bytes refused = encode(TaskAnswer::refused(TaskStatus::Kind::Crashed, "crashed"));
    const auto sound = [&](const Point& unit) {
      const TaskRequest request{Stage::Confirm, 0, true, unit, 0};
      return checked_request(problem, search, {encode(request), refused}).has_value();
    };
    EXPECT_FALSE(sound({}));
    Point own = problem.space().with_own_finish(Point(study.variables.size(), 0.5));
    EXPECT_EQ(DesignSpace::is_beside(own), beside);
    EXPECT_TRUE(sound(own));
    EXPECT_EQ(own[3] == DesignSpace::kBeside, beside);
    for (const double nowhere : {DesignSpace::kBeside, 1.5, std::nan("")}) {
      own[0] = nowhere;  // of the texture
      EXPECT_FALSE(sound(own)) << nowhere;
    }
  }
}

TEST_F(Records, WithJudgementsOfAnotherShapeAreRefused) {
  using Change = std::function<void(TaskRequest&, Outcome&)>;
  const std::size_t objectives = search_.objectives;
  const std::vector<Change> changes{
      [](TaskRequest&, Outcome& o) { o.objectives.clear(); },
      [&](TaskRequest&, Outcome& o) { o.objectives.resize(objectives + 1); },
      [](TaskRequest&, Outcome& o) { o.objectives.resize(100000); },
      [](TaskRequest&, Outcome& o) { o.objectives[0] = std::nan(""); },
      [](TaskRequest&, Outcome& o) { o.constraints.push_back(-1); },
      [](TaskRequest&, Outcome& o) { o.residuals = {INFINITY}; },
      [](TaskRequest&, Outcome& o) { o.ok = false; },  // and yet with objectives
      [](TaskRequest& r, Outcome&) { r.unit.pop_back(); },
      [](TaskRequest& r, Outcome&) { r.unit.resize(100000); },
      [](TaskRequest& r, Outcome&) { r.unit[0] = std::nan(""); },
      [](TaskRequest& r, Outcome&) { r.task = 1000000; },
      [](TaskRequest& r, Outcome&) { r.most_seconds = -1; },
      [](TaskRequest& r, Outcome&) { r.stage = Stage::Confirm; },
      [](TaskRequest& r, Outcome&) { r.stage = Stage::Done; },
      [](TaskRequest& r, Outcome&) { r.stage = static_cast<Stage>(99); }};
  for (std::size_t i = 0; i < changes.size(); ++i) EXPECT_FALSE(sound(judged(changes[i]))) << i;
  EXPECT_FALSE(sound({"", ""}));
  EXPECT_FALSE(sound({encode(request(Stage::Search)), "1 0: 0 0 0 0x0p+0 more"}));
}

TEST_F(Records, WithAnswersOfAnotherShapeAreRefused) {
  using Change = std::function<void(TaskRequest&, TaskAnswer&)>;
  const std::vector<Change> changes{
      [](TaskRequest&, TaskAnswer& a) { a.objectives.clear(); },
      [](TaskRequest&, TaskAnswer& a) { a.objectives.resize(9); },
      [](TaskRequest&, TaskAnswer& a) { a.objectives[0].points.clear(); },
      [](TaskRequest&, TaskAnswer& a) { a.objectives[0].points.resize(100000); },
      [](TaskRequest&, TaskAnswer& a) { a.limited.resize(a.limited.size() + 1); },
      [](TaskRequest&, TaskAnswer& a) { a.samples.resize(9); },
      [](TaskRequest&, TaskAnswer& a) { a.samples.resize(a.objectives.size()); },  // each empty
      [](TaskRequest&, TaskAnswer& a) { a.model.resize(9); },
      [](TaskRequest&, TaskAnswer& a) {
        a.model.resize(a.objectives.size());
        a.model[0].belief = {{0.5, 0.5}, {{1, {1, 2}}, {1, {1}}}, {1, {1, 2}}};
      },
      [](TaskRequest& r, TaskAnswer&) { r.task = 1000000; },
      [](TaskRequest& r, TaskAnswer&) { r.unit.clear(); },
      [](TaskRequest& r, TaskAnswer&) { r.stage = Stage::Search; }};
  for (const Stage stage : {Stage::Draft, Stage::Narrow, Stage::Confirm, Stage::Rounding}) {
    for (std::size_t i = 0; i < changes.size(); ++i)
      EXPECT_FALSE(sound(answered(stage, changes[i]))) << i;
  }
}

// The reader of a run that goes on asks the same.
TEST_F(Records, AreAskedOfBeforeARunGoesOn) {
  const Folder folder = Folder::made(fresh_folder("hostile"));
  const auto replay = [&](const JournalRecord& record) {
    folder.remove(kJournalName);
    {
      Journal journal(folder, kJournalName, journal_key(problem_), false);
      journal.append(record);
    }
    return Replay(problem_, search_, folder, true, nullptr, nullptr).evaluated();
  };
  EXPECT_EQ(replay(judged([](TaskRequest&, Outcome&) {})), 1);
  for (const std::size_t count : {0u, 9u, 100000u}) {
    EXPECT_THROW(replay(judged([&](TaskRequest&, Outcome& o) { o.objectives.resize(count); })),
                 InputError);
    EXPECT_THROW(replay(answered(Stage::Confirm,
                                 [&](TaskRequest&, TaskAnswer& a) { a.objectives.resize(count); })),
                 InputError);
  }
}

}  // namespace
}  // namespace papilla::tests::records_test
