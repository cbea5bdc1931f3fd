// The real server over the loopback: who is answered, what two pages see.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/studio/loopback.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

class Server : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const Studio studio_{studio_options(folder_.path().string())};
  const Place place_{studio_.address()};
};

TEST_F(Server, AnswersItsOwnPage) {
  const Reply page = replied(place_, place_.own("GET", ""));
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.text.find("<title>Papilla studio</title>"), std::string::npos);
  EXPECT_NE(page.text.find("script-src 'self'"), std::string::npos);
  for (const char* file : {"page/studio.js", "plots/curves.js", "chart.js", "page/studio.css"})
    EXPECT_EQ(replied(place_, place_.own("GET", file)).status, 200) << file;
}

TEST_F(Server, RefusesOtherOriginsHostsAndTokens) {
  const std::string set = R"({"path":"texture.depth","value":"1 nm"})";
  EXPECT_EQ(replied(place_, place_.request("POST", place_.root + "set", set, "http://evil.example"))
                .status,
            403);
  EXPECT_EQ(
      replied(place_, place_.request("POST", "/0123/set", set, "http://" + place_.host())).status,
      404);
  std::string rebound = place_.own("GET", "state");
  rebound.replace(rebound.find(place_.host()), place_.host().size(), "evil.example");
  EXPECT_EQ(replied(place_, rebound).status, 403);
  const Reply state = replied(place_, place_.own("GET", "state"));
  EXPECT_NE(state.text.find(R"("path":"texture.depth","type":"number","value":"600 nm")"),
            std::string::npos);
  const auto parts = nlohmann::json::parse(state.text.substr(state.text.find("\r\n\r\n") + 4));
  EXPECT_TRUE(parts.at("session").contains("undo"));
  EXPECT_TRUE(parts.at("search").contains("state"));
  EXPECT_FALSE(parts.at("files").contains("undo"));
  EXPECT_FALSE(parts.at("wish").contains("state"));
}

TEST_F(Server, SaysWhatIsWrongWithARequest) {
  EXPECT_EQ(replied(place_, place_.own("POST", "set", "{")).status, 400);
  EXPECT_EQ(replied(place_, place_.own("POST", "set", "[1]")).status, 400);
  EXPECT_EQ(replied(place_, place_.own("POST", "set", R"({"path":3})")).status, 400);
  EXPECT_EQ(replied(place_, place_.own("POST", "nothing", "{}")).status, 404);
  const Reply refused =
      replied(place_, place_.own("POST", "set", R"({"path":"texture.depth","value":"3 V"})"));
  EXPECT_EQ(refused.status, 200);
  EXPECT_NE(refused.text.find("\"error\""), std::string::npos);
  EXPECT_NE(refused.text.find("a length"), std::string::npos);
  EXPECT_EQ(replied(place_, place_.own("POST", "set", std::string(2 << 20, 'x'))).status, 413);
}

TEST_F(Server, TellsAllPagesOfAChangeAndItsAnswer) {
  Connection first(place_.port), second(place_.port);
  for (Connection* page : {&first, &second}) page->send(place_.own("GET", "events"));
  const Reply set =
      replied(place_, place_.own("POST", "set", R"({"path":"texture.depth","value":"262 nm"})"));
  ASSERT_EQ(set.status, 200);
  const std::string revision = set.text.substr(set.text.rfind("\"revision\":"));
  for (Connection* page : {&first, &second}) {
    const std::string seen = page->read_until(
        "event: response\ndata: {" + revision.substr(0, revision.find('}')) + ",", 60);
    EXPECT_NE(seen.find("\"value\":\"262 nm\""), std::string::npos);
    EXPECT_NE(seen.find("event: response\ndata: {" + revision.substr(0, revision.find('}'))),
              std::string::npos);
  }
  // One that comes later is told all that is.
  Connection third(place_.port);
  third.send(place_.own("GET", "events"));
  EXPECT_NE(third.read_until("\"262 nm\"", 20).find("\"262 nm\""), std::string::npos);
}

TEST_F(Server, ReportsASearchThatIsNotFinishedAsThat) {
  EXPECT_EQ(replied(place_, place_.own("GET", "report/searches/001")).status, 404);
  const Reply started = replied(
      place_,
      place_.own("POST", "search/start",
                 R"~({"variables":[{"path":"texture.depth","low":"100 nm","high":"900 nm",)~"
                 R"~("excluding":"300 to 400 nm"}],"maximise":["mean(modulation)"]})~"));
  EXPECT_NE(started.text.find(R"("state":"running")"), std::string::npos) << started.text;
  const Reply report = replied(place_, place_.own("GET", "report/searches/001"));
  EXPECT_EQ(report.status, 200);
  EXPECT_NE(report.text.find("a search that is not finished"), std::string::npos);
  EXPECT_NE(report.text.find("script-src 'unsafe-inline'"), std::string::npos);
  EXPECT_EQ(replied(place_, place_.own("GET", "report/searches/002")).status, 404);
}

// 64 KiB are read and what came with the last of them, no more.
TEST_F(Server, CutsALongHead) {
  const auto request = [&](std::size_t size) {
    std::string out = "GET " + place_.root + "state HTTP/1.1\r\nHost: " + place_.host() +
                      "\r\nOrigin: http://" + place_.host() + "\r\nConnection: close\r\n";
    const std::string end = "\r\n";
    while (out.size() + end.size() < size) {
      const std::size_t room = size - out.size() - end.size();
      const std::size_t line = room > 9000 ? 7000 : room > 7000 ? room - 4000 : room;
      out += "X-Y: " + std::string(line - 7, 'z') + "\r\n";
    }
    return out + end;
  };
  EXPECT_EQ(replied(place_, request(2000)).status, 200);
  EXPECT_EQ(replied(place_, request((64 << 10) + 1)).status, 200);
  EXPECT_NE(replied(place_, request(80 << 10)).status, 200);
}

}  // namespace
}  // namespace papilla::tests
