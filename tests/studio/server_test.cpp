// The real server over the loopback: who is answered, what two pages see.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "tests/studio/loopback.h"
#include "tests/temporary.h"

namespace papilla::tests::server_test {
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

// A tab may come from anywhere, as from the file that opens the studio; nothing else may.
TEST_F(Server, LetsATabComeFromAnotherSiteToThePageAlone) {
  const auto asked = [&](const char* method, const char* path, const char* mode, const char* dest) {
    std::string text = place_.own(method, path);
    const std::string origin = "Origin: http://" + place_.host() + "\r\n";
    text.replace(text.find(origin), origin.size(),
                 std::string("Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: ") + mode +
                     "\r\nSec-Fetch-Dest: " + dest + "\r\n");
    return replied(place_, text).status;
  };
  EXPECT_EQ(asked("GET", "", "navigate", "document"), 200);
  EXPECT_EQ(asked("GET", "", "no-cors", "script"), 403);
  EXPECT_EQ(asked("GET", "", "navigate", "iframe"), 403);
  EXPECT_EQ(asked("GET", "state", "navigate", "document"), 403);
  EXPECT_EQ(asked("GET", "report/searches/001", "navigate", "document"), 403);
  EXPECT_EQ(asked("POST", "set", "navigate", "document"), 403);
}

// Everybody sees the words that a browser is started with: the token is in a file of its owner's.
TEST_F(Server, IsOpenedByAFileThatItsOwnerAloneReads) {
  const std::string file = studio_.opening_file();
  EXPECT_EQ(file.find(place_.root), std::string::npos);
  EXPECT_EQ(std::filesystem::status(file).permissions(), static_cast<std::filesystem::perms>(0600));
  EXPECT_NE(read_bytes(file).find("url=" + studio_.address()), std::string::npos);
}

// Somebody's report may hold anything: it runs in an origin of its own.
TEST_F(Server, ShowsReportsInASandbox) {
  std::filesystem::create_directories(folder_.path() / "searches/001");
  write_bytes(folder_.path() / "searches/001/report.html", "<script>fetch('/')</script>");
  const Reply report = replied(place_, place_.own("GET", "report/searches/001"));
  EXPECT_EQ(report.status, 200);
  EXPECT_NE(report.text.find("Content-Security-Policy: sandbox allow-scripts; default-src 'none'"),
            std::string::npos)
      << report.text.substr(0, 600);
  EXPECT_EQ(report.text.find("allow-same-origin"), std::string::npos);
  const Reply page = replied(place_, place_.own("GET", ""));
  EXPECT_NE(page.text.find("Content-Security-Policy: default-src 'none'; script-src 'self'"),
            std::string::npos);
  std::filesystem::rename(folder_.path() / "searches/001", folder_.path() / "elsewhere");
  std::filesystem::create_directory_symlink("../elsewhere", folder_.path() / "searches/001");
  EXPECT_EQ(replied(place_, place_.own("GET", "report/searches/001")).status, 404);
}

// What is refused with a body ends its connection: the body is no request.
TEST_F(Server, ReadsNoBodyOfARefusedRequestAsTheNextOne) {
  const std::string hidden = place_.own("GET", "state");
  const auto answers = [&](const std::string& head) {
    const std::string text = replied(place_, head + hidden).text;
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("HTTP/1.1 ", at)) != text.npos; ++at) ++count;
    EXPECT_EQ(text.find("\"session\""), std::string::npos) << head;
    return count;
  };
  const std::string length = "Content-Length: " + std::to_string(hidden.size()) + "\r\n\r\n";
  const std::string host = "Host: " + place_.host() + "\r\n";
  for (const char* method : {"POST", "PUT", "PATCH", "DELETE", "GET", "OPTIONS"})
    EXPECT_EQ(answers(std::string(method) + " /0123/set HTTP/1.1\r\n" + host + length), 1u)
        << method;
  for (const char* method : {"PUT", "PATCH", "DELETE", "GET", "OPTIONS"})
    EXPECT_EQ(answers(std::string(method) + " " + place_.root + "set HTTP/1.1\r\n" + host + length),
              1u)
        << method;
  EXPECT_EQ(answers("POST " + place_.root + "set HTTP/1.1\r\n" + host +
                    "Content-Type: multipart/form-data; boundary=x\r\n" + length),
            1u);
}

// A body that does not end, of a method that nobody asked for, is not kept.
TEST_F(Server, TakesNoBodyOfAnotherMethod) {
  Connection connection(place_.port);
  connection.send("PUT " + place_.root + "scan?name=a.npy HTTP/1.1\r\nHost: " + place_.host() +
                  "\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "100000\r\n" + std::string(1 << 20, 'x') + "\r\n";
  int sent = 0;
  while (sent < 200 && connection.send(chunk)) ++sent;
  EXPECT_LT(sent, 20);
  EXPECT_EQ(replied(place_, place_.own("GET", "page/studio.css")).status, 200);
}

// Names of files are nobody's business who asks for what there is not.
TEST_F(Server, TellsNoPathsOfWhatItCannotDo) {
  std::filesystem::create_directories(folder_.path() / "locked");
  write_bytes(folder_.path() / "locked/a.npy", "x");
  for (const auto& [path, body] : {std::pair{"scan/view", R"({"name":"locked/a.npy"})"},
                                   {"export", R"({"name":"locked/a.npy"})"},
                                   {"save", R"({"name":"locked/a.npy/b.toml"})"},
                                   {"open", R"({"name":"none.toml"})"}}) {
    const Reply reply = replied(place_, place_.own("POST", path, body));
    EXPECT_NE(reply.status, 500) << path << reply.text;
    EXPECT_EQ(reply.text.find("EXCEPTION_WHAT"), std::string::npos);
  }
}

// One owner of a folder, one of a port.
TEST_F(Server, SharesNeitherItsFolderNorItsPort) {
  const auto second = [&](const std::string& arguments) {
    const std::string log = temporary("second");
    const int code = std::system(("timeout 20 '" PAPILLA_PROGRAM "' studio --no-open " + arguments +
                                  " > /dev/null 2> '" + log + "'")
                                     .c_str());
    EXPECT_EQ(WEXITSTATUS(code), 2) << arguments;
    return read_bytes(log);
  };
  EXPECT_NE(second("--folder '" + folder_.path().string() + "'")
                .find("another studio is working in this folder"),
            std::string::npos);
  const TemporaryFolder other;
  EXPECT_NE(second("--folder '" + other.path().string() + "' --port " + std::to_string(place_.port))
                .find("another program listens there"),
            std::string::npos);
}

TEST_F(Server, LeavesNothingOfAFileThatItCannotOpen) {
  const TemporaryFolder other;
  write_bytes(other.path() / "wrong.toml", "schema_version = 1\ntexture = 3\n");
  std::filesystem::create_directory(other.path() / "results");
  write_bytes(other.path() / "results/design.toml", "schema_version = 1\ntexture = 3\n");
  for (const char* file : {"none.toml", "wrong.toml", "results"}) {
    for (const std::string& folder : {std::string(), (other.path() / "new").string()}) {
      const int code = std::system(
          ("timeout 20 '" PAPILLA_PROGRAM "' studio --no-open '" + (other.path() / file).string() +
           "' " + (folder.empty() ? "" : "--folder '" + folder + "'") + " > /dev/null 2>&1")
              .c_str());
      EXPECT_EQ(WEXITSTATUS(code), 2) << file;
    }
  }
  for (const char* made : {".studio", "new", "results/.studio"})
    EXPECT_FALSE(std::filesystem::exists(other.path() / made)) << made;
}

// A link in the folder leads nowhere, and a name that is no UTF-8 does not end the page.
TEST_F(Server, ListsWhatItWouldOpen) {
  write_bytes(folder_.path() / "mine.toml", "schema_version = 1\n");
  write_bytes(folder_.path() / "r\xe9sum\xe9.toml", "schema_version = 1\n");
  std::filesystem::create_symlink("mine.toml", folder_.path() / "link.toml");
  const Reply state = replied(place_, place_.own("GET", "state"));
  EXPECT_EQ(state.status, 200);
  EXPECT_NE(state.text.find(R"("designs":["mine.toml"])"), std::string::npos);
}

TEST(StudioFolder, OfAStrangerOverwritesNothingThroughLinks) {
  const TemporaryFolder outside, folder;
  write_bytes(outside.path() / "mine.json", "mine");
  // `.studio` itself is refused before anything is written.
  std::filesystem::create_directory_symlink(outside.path(), folder.path() / ".studio");
  EXPECT_THROW(Studio(studio_options(folder.path().string())), InputError);
  std::filesystem::remove(folder.path() / ".studio");
  std::filesystem::create_directory(folder.path() / ".studio");
  for (const char* name : {"session.json", "session.json.part", "open.html"})
    std::filesystem::create_symlink(outside.path() / "mine.json", folder.path() / ".studio" / name);
  std::filesystem::create_directory_symlink(outside.path(), folder.path() / "searches");
  {
    const Studio studio(studio_options(folder.path().string()));
    const Place place(studio.address());
    studio.opening_file();
    const std::string wish =
        R"j({"variables":[{"path":"texture.depth","low":"100 nm","high":"800 nm"}],)j"
        R"j("maximise":["mean(modulation)"],"evaluations":4})j";
    const Reply started = replied(place, place.own("POST", "search/start", wish));
    EXPECT_NE(started.text.find("is a link"), std::string::npos) << started.text;
    replied(place, place.own("POST", "set", R"({"path":"texture.depth","value":"300 nm"})"));
  }
  EXPECT_EQ(read_bytes(outside.path() / "mine.json"), "mine");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(outside.path()), {}), 1);
  EXPECT_FALSE(std::filesystem::is_symlink(folder.path() / ".studio/session.json"));
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

TEST_F(Server, TellsTheFormWhereItsRowsChangeAndElseWhatMovesAlone) {
  Connection page(place_.port);
  page.send(place_.own("GET", "events"));
  const auto after = [&](const char* path, const char* body, const char* until) {
    const std::size_t before = page.read_until("event: session", 20).size();
    replied(place_, place_.own("POST", path, body));
    return page.read_until(until, 60).substr(before);
  };
  EXPECT_NE(page.read_until("event: session", 20).find("event: form\ndata: {\"form\":1"),
            std::string::npos);
  const std::string moved =
      after("set", R"({"path":"texture.depth","value":"263 nm"})", "\"value\":\"263 nm\"");
  EXPECT_EQ(moved.find("event: form"), std::string::npos) << moved;
  EXPECT_EQ(moved.find("\"doc\""), std::string::npos);
  EXPECT_EQ(moved.find("\"path\":\"surface.contact_angle\""), std::string::npos);
  const std::string other =
      after("kind", R"({"kind":"pillar_array"})", "\"kind\":\"pillar_array\"");
  EXPECT_NE(other.find("event: form"), std::string::npos);
  EXPECT_NE(other.find("\"path\":\"texture.height\""), std::string::npos);
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
}  // namespace papilla::tests::server_test
