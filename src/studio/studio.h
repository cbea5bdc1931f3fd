// The studio as a whole: one session, one evaluator, one desk of searches behind one address.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "base/rooms.h"
#include "studio/evaluator.h"
#include "studio/events.h"
#include "studio/files.h"
#include "studio/http.h"
#include "studio/lab_desk.h"
#include "studio/search_desk.h"
#include "studio/session.h"

namespace papilla::studio {

struct StudioOptions {
  std::string file;     // a design, a study, or a folder of results; empty: the shipped hole array
  std::string folder;   // that is read and written, made if it is not there; empty: the file's
  std::string program;  // papilla, for searches
  int port = 0;         // 0: any that is free
  Limits limits;
};

class Studio {
 public:
  explicit Studio(const StudioOptions& options);  // throws InputError
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  std::string address() const;
  // A page that leads there, for its owner's eyes alone, while the studio lives. Everybody on the
  // machine sees the words that a program is started with: a browser is given this file's name, not
  // the address with its token.
  std::string opening_file() const;
  // What a page asks. Thread safe; exposed for tests.
  HttpAnswer answer(const HttpRequest& request);

 private:
  Studio(const StudioOptions& options, const std::string& file);
  struct Asked;  // a request with its body read
  using Route = std::function<std::string(const Asked&)>;

  void add_routes();
  void add_design_routes();
  void add_file_routes();
  void add_search_routes();
  void add_lab_routes();
  HttpAnswer report(const std::string& folder) const;
  Listener listener();
  void design_changed();
  std::string changed(std::uint64_t revision);
  std::string state() const;
  // pinned: those whose file can be read.
  nlohmann::ordered_json session_json(const SessionView& view,
                                      const std::map<int, Design>& pinned) const;
  std::string lab_json() const;

  Events events_;
  Files files_;
  FolderLock lock_;  // of its folder: two would overwrite each other's sessions and searches
  Session session_;
  std::map<std::string, Route> routes_;
  std::mutex computing_;  // what takes seconds, one at a time
  // Of the session, one change at a time and never an earlier one after a later: pages get what is
  // another than in the form that they were told.
  std::mutex telling_;
  nlohmann::ordered_json form_told_;
  int forms_told_ = 0;
  std::unique_ptr<SearchDesk> desk_;
  std::unique_ptr<LabDesk> lab_;
  std::unique_ptr<Evaluator> evaluator_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace papilla::studio
