// Requests and answers between a run, its workers and its journal.
#include "search/protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace papilla::tests::protocol_test {
namespace {

TaskAnswer full_answer() {
  TaskAnswer a;
  a.objectives = {{1.0 / 3, 1e-300, {0.1, -0.0}}, {-2, 0, {}}};
  a.worst = std::numeric_limits<double>::denorm_min();
  a.look = Look{0.01, 0.9, 1, 0.002};
  a.limited = {kInfinity};
  a.samples = {{{{1, 2}, {0.5}, {}}}, {{}}};
  a.model = {{{{0.1, 0.2}, {0.3}}, {}}, {{}, {{0.4, 0.6}, {{1, {2}}, {3, {4}}}, {5, {6}}}}};
  a.report = "{\n \"points\": [1, 2]\t}: not 3 words";
  return a;
}

TEST(Protocol, AnAnswerComesBackInEveryBit) {
  const TaskAnswer a = full_answer();
  const auto back = decode_answer(encode(a));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->status, a.status);
  EXPECT_EQ(back->objectives, a.objectives);
  EXPECT_TRUE(std::signbit(back->objectives[0].points[1]));
  EXPECT_EQ(back->worst, a.worst);
  EXPECT_EQ(back->oxide_margin, kInfinity);
  EXPECT_EQ(back->look, a.look);
  EXPECT_EQ(back->limited, a.limited);
  EXPECT_EQ(back->samples[0][0].sampling, a.samples[0][0].sampling);
  EXPECT_EQ(back->samples[0][0].grid, a.samples[0][0].grid);
  EXPECT_EQ(back->samples[1].size(), 1u);
  EXPECT_EQ(back->model, a.model);
  EXPECT_EQ(back->report, a.report);
}

TEST(Protocol, ARequestAndAJudgementComeBack) {
  const TaskRequest request{Stage::Steps, 7, true, {0.1, 1.0 / 3}, 2.5};
  EXPECT_EQ(decode_request(encode(request)), request);
  const Judgement judgement{{false, "min_wall: below 0.4 um", {}, {-0.5, 2}, {}}, 0};
  const auto back = decode_judgement(encode(judgement));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->outcome, judgement.outcome);
  EXPECT_EQ(back->worst, 0);
}

TEST(Protocol, WhatIsCutOrOtherwiseWrittenIsNoAnswer) {
  const Bytes whole = encode(full_answer());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_answer(whole.substr(0, size))) << size;
  EXPECT_FALSE(decode_answer(whole + " "));
  EXPECT_FALSE(decode_answer(whole + " 0"));
  Bytes other = whole;
  other.replace(other.find("p-2"), 3, "p-02");
  EXPECT_FALSE(decode_answer(other));
  EXPECT_FALSE(decode_request("99 0 0 0 0x0p+0"));  // no such stage
  EXPECT_TRUE(decode_request("0 0 0 0 0x0p+0"));
  EXPECT_FALSE(decode_request("0 0 0 1000000000 0x0p+0"));  // a list that is not there
  EXPECT_FALSE(decode_request("0 0 2 0 0x0p+0"));
}

TEST(Protocol, AFailureOfAWorkerIsAStatus) {
  using Reason = WorkFailure::Reason;
  using Kind = TaskStatus::Kind;
  const auto kind = [](const WorkAnswer& answer) { return task_answer(answer).status.kind; };
  EXPECT_EQ(kind({{}, WorkFailure{Reason::Crashed, ""}}), Kind::Crashed);
  EXPECT_EQ(kind({{}, WorkFailure{Reason::TimedOut, ""}}), Kind::TimedOut);
  EXPECT_EQ(kind({{}, WorkFailure{Reason::OutOfMemory, ""}}), Kind::OutOfMemory);
  EXPECT_EQ(kind({{}, WorkFailure{Reason::Threw, ""}}), Kind::Threw);
  EXPECT_EQ(kind({"nonsense", {}}), Kind::Crashed);
  EXPECT_EQ(kind({encode(full_answer()), {}}), Kind::Ok);
}

}  // namespace
}  // namespace papilla::tests::protocol_test
