// The server with a handler that says what it was given: limits, headers, streams.
#include "studio/http.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/studio/loopback.h"

namespace papilla::tests::http_test {
namespace {

class Http : public ::testing::Test {
 protected:
  static Limits small() {
    Limits out;
    out.text = 20, out.body = 50, out.listeners = 1;
    return out;
  }
  static HttpAnswer said(const HttpRequest& r) {
    HttpAnswer out;
    out.body = r.method + "|" + r.path + "|" + r.query + "|" + r.body;
    if (r.path == "/teapot") out.status = 418;
    if (r.path == "/report") out.whole_page = true, out.type = "text/html; charset=utf-8";
    return out;
  }
  Reply get(const std::string& path) const { return replied(place_, place_.own("GET", path)); }
  Reply post(const std::string& path, const std::string& body) const {
    return replied(place_, place_.own("POST", path, body));
  }
  static std::string body(const Reply& reply) {
    return reply.text.substr(reply.text.find("\r\n\r\n") + 4);
  }

  Events events_;
  const HttpServer server_{0, small(), events_, said};
  const Place place_{server_.door().address()};
};

TEST_F(Http, GivesARequestToItsHandlerWithoutTheToken) {
  EXPECT_EQ(place_.root, "/" + server_.door().token() + "/");
  EXPECT_EQ(body(get("")), "GET|/||");
  EXPECT_EQ(body(get("a/b")), "GET|/a/b||");
  EXPECT_EQ(body(get("a?name=b%20c&other=d")), "GET|/a|b c|");
  EXPECT_EQ(body(get("a?other=d")), "GET|/a||");
  EXPECT_EQ(body(post("a", "text")), "POST|/a||text");
  EXPECT_EQ(body(post("a?name=b", "text")), "POST|/a|b|text");
  EXPECT_EQ(get("teapot").status, 418);
}

TEST_F(Http, TakesTextsAndUploadsUpToTheirLimits) {
  EXPECT_EQ(body(post("a", std::string(20, 'x'))), "POST|/a||" + std::string(20, 'x'));
  EXPECT_EQ(post("a", std::string(21, 'x')).status, 413);
  EXPECT_EQ(body(post("a?name=b", std::string(50, 'x'))), "POST|/a|b|" + std::string(50, 'x'));
  EXPECT_EQ(post("a?name=b", std::string(51, 'x')).status, 413);
  std::string form = place_.own("POST", "a", "--x\r\n\r\n--x--");
  form.insert(form.find("Origin:"), "Content-Type: multipart/form-data; boundary=x\r\n");
  EXPECT_EQ(replied(place_, form).status, 415);
  // The next upload is taken: the one before left its place.
  EXPECT_EQ(post("a?name=b", "x").status, 200);
}

TEST_F(Http, EveryAnswerTellsTheBrowserWhatItMayDo) {
  for (const Reply& reply : {get("a"), get("report"), post("a", "b"), get("teapot")}) {
    for (const char* line :
         {"X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
          "Cross-Origin-Resource-Policy: same-origin", "Cache-Control: no-store"})
      EXPECT_NE(reply.text.find(std::string("\r\n") + line + "\r\n"), std::string::npos) << line;
  }
  EXPECT_NE(get("a").text.find("\r\nContent-Type: application/json\r\n"), std::string::npos);
  EXPECT_NE(
      get("a").text.find("\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; "
                         "style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
                         "base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"),
      std::string::npos);
  const std::string report = get("report").text;
  EXPECT_NE(report.find("\r\nContent-Type: text/html; charset=utf-8\r\n"), std::string::npos);
  EXPECT_NE(report.find("\r\nContent-Security-Policy: sandbox allow-scripts; "
                        "default-src 'none'; script-src 'unsafe-inline'; style-src "
                        "'unsafe-inline'; img-src data:; base-uri "
                        "'none'; form-action 'none'; frame-ancestors 'none'\r\n"),
            std::string::npos);
  EXPECT_EQ(report.find("'self'"), std::string::npos);
}

TEST_F(Http, SaysWhyItLetsNobodyIn) {
  const auto reply = [&](const std::string& path, const std::string& host,
                         const std::string& origin) {
    return replied(place_, "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: " + origin +
                               "\r\nConnection: close\r\n\r\n");
  };
  const std::string own = "http://" + place_.host();
  EXPECT_EQ(reply(place_.root, place_.host(), own).status, 200);
  const Reply host = reply(place_.root, "evil.example", "http://evil.example"),
              origin = reply(place_.root, place_.host(), "http://evil.example"),
              token = reply("/0123/", place_.host(), own);
  EXPECT_EQ(host.status, 403);
  EXPECT_EQ(body(host),
            "This address is not the studio's: open the one that papilla studio printed.\n");
  EXPECT_EQ(origin.status, 403);
  EXPECT_EQ(body(origin), "The page of another site may not use the studio.\n");
  EXPECT_EQ(token.status, 404);
  EXPECT_EQ(body(token), "Nothing here: open the whole address that papilla studio printed.\n");
}

TEST_F(Http, StreamsEventsToAsManyPagesAsItSays) {
  events_.tell(Topic::Session, "{\"a\":1}");
  events_.tell(Topic::Search, "{\"b\":2}");
  Connection page(place_.port);
  page.send(place_.own("GET", "events"));
  const std::string seen = page.read_until("{\"b\":2}", 20);
  EXPECT_NE(seen.find("Content-Type: text/event-stream\r\n"), std::string::npos);
  EXPECT_NE(seen.find("event: session\ndata: {\"a\":1}\n\nevent: search\ndata: {\"b\":2}"),
            std::string::npos)
      << seen;
  EXPECT_EQ(get("events").status, 503);
  EXPECT_EQ(get("a").status, 200);
  events_.tell(Topic::Notice, "{\"c\":3}");
  const std::string more = page.read_until("{\"c\":3}", 20);
  EXPECT_NE(more.find("event: notice\ndata: {\"c\":3}"), std::string::npos);
  EXPECT_EQ(more.find("{\"a\":1}", more.find("{\"b\":2}")), std::string::npos);  // told once
  events_.close();
  page.read_until("", 20);
  EXPECT_TRUE(page.closed());
}

TEST_F(Http, AnswersSeveralRequestsOfAConnection) {
  Connection page(place_.port);
  const auto ask = [&](const std::string& path) {
    std::string text = place_.own("GET", path);
    text.erase(text.find("Connection: close\r\n"), 19);
    page.send(text);
    return page.read_until("GET|/" + path + "|", 20);
  };
  for (const char* path : {"one", "two", "three"})
    EXPECT_NE(ask(path).find(std::string("GET|/") + path + "||"), std::string::npos);
  EXPECT_FALSE(page.closed());
}

}  // namespace
}  // namespace papilla::tests::http_test
