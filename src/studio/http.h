// A server on the loopback, in plain types: http.cpp alone knows the library behind it
// (cpp-httplib).
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/rooms.h"
#include "studio/events.h"
#include "studio/safety.h"

namespace papilla::studio {

struct HttpRequest {
  std::string method, path;  // below the token: "/change"
  std::string query;         // of ?name=, where the page names a file
  std::string body;
};

struct HttpAnswer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  bool whole_page = false;  // a report, which brings its own scripts
};

class HttpServer {
 public:
  using Handler = std::function<HttpAnswer(const HttpRequest&)>;

  // port: 0: any that is free. Listens from now on, on 127.0.0.1 alone; GET /events is the stream
  // of events, everything else is the handler's, which several threads call at once. Throws
  // InputError where the port is taken.
  HttpServer(int port, const Limits& limits, Events& events, Handler handler);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  const Door& door() const;
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace papilla::studio
