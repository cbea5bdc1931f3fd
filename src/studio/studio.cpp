#include "studio/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "design/scans.h"
#include "forward/appearance.h"
#include "geometry/texture.h"
#include "metrics/metric.h"
#include "report/json.h"
#include "report/page.h"
#include "report/page_data.h"
#include "report/response.h"
#include "studio/page.h"

namespace papilla::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const std::string kOpeningFile = std::string(kStudioFolder) + "/open.html";

// The file that the studio opens with: of a folder of results its best design.
std::string opened_file(const std::string& given) {
  if (given.empty()) return find_design("electroadhesive_glass/study.toml");
  const fs::path path = fs::weakly_canonical(own_or_shipped(given));
  // What cannot be opened leaves no folder behind.
  const auto sound = [](const fs::path& file) {
    read_study(file.string(), {}, DesignUse::Drawn);
    return file.string();
  };
  if (!fs::is_directory(path)) return sound(path);
  for (const char* name : {"best/design.toml", "design.toml", "study.toml"}) {
    if (fs::exists(path / name)) return sound(path / name);
  }
  throw InputError(
      {Problem{given, 0, 0, "", "neither a folder of results (best/design.toml) nor a design"}});
}

fs::path own_folder(const StudioOptions& options) {
  if (!options.folder.empty()) {
    Folder::made(options.folder);
    return fs::weakly_canonical(options.folder);
  }
  if (options.file.empty()) return fs::current_path();
  const fs::path path = fs::weakly_canonical(own_or_shipped(options.file)),
                 folder = fs::is_directory(path) ? path : path.parent_path();
  // Designs that Papilla brings stay as they are.
  for (const std::string& root : design_roots()) {
    const std::string below = folder.lexically_relative(fs::weakly_canonical(root)).string();
    if (!below.empty() && !below.starts_with("..")) return fs::current_path();
  }
  return folder;
}

Json kinds_json() {
  constexpr int kPixels = 48;
  Json out = Json::array();
  for (std::size_t k = 0; k < texture_kinds().size(); ++k) {
    if (!numbers_alone(k)) continue;
    const Texture texture = default_texture(k);
    const Heightmap h = generate(texture, patch_grid(texture, kPixels));
    out.push_back({{"kind", texture_kinds()[k]}, {"heights", picture_json(h.grid, h.z)}});
  }
  return out;
}

Json comparisons_json(const std::vector<Comparison>& comparisons) {
  Json out = Json::array();
  for (const Comparison& c : comparisons) {
    out.push_back({{"pin", c.pin},
                   {"metric", c.metric},
                   {"difference", json_number(c.difference)},
                   {"error", json_number(c.error)},
                   {"model", json_number(c.model)}});
  }
  return out;
}

// What the metrics mean.
Json words_json() {
  Json out = Json::object();
  for (const MetricInfo& m : metric_list()) out[m.name] = m.doc;
  return out;
}

Json slopes_json(const std::vector<Slope>& slopes) {
  Json out = Json::array();
  for (const Slope& s : slopes) {
    Json changes = Json::array();
    for (const Slope::Change& c : s.changes)
      changes.push_back(
          {{"metric", c.metric}, {"value", json_number(c.value)}, {"error", json_number(c.error)}});
    const double to_unit = s.unit.empty() ? 1 : find_unit(s.unit)->to_si;
    out.push_back({{"path", s.path},
                   {"unit", s.unit},
                   {"down", s.down / to_unit},
                   {"up", s.up / to_unit},
                   {"changes", changes}});
  }
  return out;
}

// What limits trust in the numbers, in the lines of papilla evaluate; evaluate refuses models that
// the finger was not fitted with, a page that is moved by hand says them beside each answer.
Json caveats_json(const Answer& answer) {
  Json out = Json::array();
  for (const std::string& line : answer.unfitted) out.push_back("warning: " + line);
  for (const std::string& line : caveats(answer.response)) out.push_back(line);
  return out;
}

std::string answer_json(const Answer& answer) {
  std::string pinned;
  for (const auto& [number, response] : answer.pinned)
    pinned += fmt::format("{}\"{}\":{}", pinned.empty() ? "" : ",", number,
                          response_json(response, false, -1));
  return fmt::format(
      R"({{"revision":{},"step":"{}","seconds":{:.4f},"comparisons":{},"pinned":{{{}}},"caveats":{},"response":{}}})",
      answer.revision, name_of(answer.step), answer.seconds,
      comparisons_json(answer.comparisons).dump(), pinned, caveats_json(answer).dump(),
      response_json(answer.response, false, -1));
}

Json look_json(const Design& design) {
  const Optics look = appearance_of(design);
  const bool refused = look.refused();
  const auto value = [&](double v) { return refused ? Json(nullptr) : json_number(v); };
  return {{"regime", text(look.regime)},
          {"warning", look.warning},
          {"haze", value(look.haze)},
          {"transmittance", value(look.transmittance)},
          {"gloss", value(look.gloss)},
          {"total_transmittance", value(look.total_transmittance)},
          {"distinctness", value(look.distinctness)},
          {"sparkle", value(look.sparkle)},
          {"colour_shift", value(look.colour_shift)}};
}

Json margins_json(const Texture& texture) {
  const FabricationMargins& margins = facts(texture).margins;
  return {{"min_hole", json_number(margins.min_hole)},
          {"min_wall", json_number(margins.min_wall)},
          {"aspect_ratio", json_number(margins.aspect_ratio)},
          {"of_parts", std::holds_alternative<Stack>(texture.kind)}};
}

// The pinned designs by their numbers. One whose file is gone, or is no design any more, is left
// out.
std::map<int, Design> pinned_designs(const std::vector<PinnedDesign>& pins) {
  std::map<int, Design> out;
  for (const PinnedDesign& pin : pins) {
    try {
      out[pin.number] = study_of(pin.draft).design;
    } catch (const InputError&) {
    }
  }
  return out;
}

HttpAnswer refusal(int status, const InputError& error) {
  Json problems = Json::array();
  for (const Problem& p : error.problems())
    problems.push_back({{"key", p.key}, {"message", p.message}});
  return {status, "application/json",
          Json{{"error", error.what()}, {"problems", problems}}.dump(
              -1, ' ', false, Json::error_handler_t::replace)};
}

}  // namespace

struct Studio::Asked {
  const HttpRequest& request;
  Json body;

  std::string text(const char* key) const { return body.at(key).get<std::string>(); }
  std::string text_or(const char* key) const { return body.value(key, std::string()); }
  bool flag(const char* key) const { return body.value(key, false); }
  int whole(const char* key) const { return body.at(key).get<int>(); }
};

Studio::Studio(const StudioOptions& options) : Studio(options, opened_file(options.file)) {}

Studio::Studio(const StudioOptions& options, const std::string& file)
    : files_(own_folder(options)),
      lock_(files_.handle().made_below(kStudioFolder), "lock", "another studio is working"),
      session_(files_.folder(), file) {
  add_routes();
  lab_ = std::make_unique<LabDesk>(files_.folder(), options.program,
                                   [this] { events_.tell(Topic::Lab, lab_json()); });
  desk_ = std::make_unique<SearchDesk>(files_.folder(), options.program, [this] {
    events_.tell(Topic::Search, desk_->json().dump());
    events_.tell(Topic::Lab, lab_json());
  });
  evaluator_ = std::make_unique<Evaluator>(listener());
  server_ = std::make_unique<HttpServer>(options.port, options.limits, events_,
                                         [this](const HttpRequest& r) { return answer(r); });
  events_.tell(Topic::Search, desk_->json().dump());
  events_.tell(Topic::Lab, lab_json());
  design_changed();
}

// Pages first, then who works for them. A desk that works asks both desks for what it tells.
Studio::~Studio() {
  server_->stop();
  evaluator_.reset();
  lab_->close();
  desk_->close();
  try {
    files_.handle().remove(kOpeningFile);
  } catch (const InputError&) {  // its token opens nothing any more
  }
}

std::string Studio::address() const { return server_->door().address(); }

std::string Studio::opening_file() const {
  files_.handle().write_secret(
      kOpeningFile, fmt::format("<!doctype html><meta charset=\"utf-8\"><title>Papilla</title>\n"
                                "<meta name=\"referrer\" content=\"no-referrer\">\n"
                                "<meta http-equiv=\"refresh\" content=\"0;url={0}\">\n"
                                "<a href=\"{0}\">The studio</a>\n",
                                address()));
  return files_.handle().path(kOpeningFile);
}

Listener Studio::listener() {
  Listener out;
  out.answer = [this](const Answer& a) { events_.tell(Topic::Response, answer_json(a)); };
  out.shape = [this](std::uint64_t revision, const Design& design) {
    Json shape = shape_json(design.texture);
    shape["margins"] = margins_json(design.texture);
    shape["revision"] = revision;
    events_.tell(Topic::Shape, shape.dump());
  };
  out.look = [this](std::uint64_t revision, const Design& design) {
    Json look = look_json(design);
    look["revision"] = revision;
    events_.tell(Topic::Look, look.dump());
  };
  out.refining = [this](std::uint64_t revision, const std::string& what, double share) {
    events_.tell(Topic::Refinement,
                 Json{{"revision", revision}, {"what", what}, {"share", share}}.dump());
  };
  out.slopes = [this](std::uint64_t revision, const std::vector<Slope>& slopes) {
    events_.tell(Topic::Slopes,
                 Json{{"revision", revision}, {"slopes", slopes_json(slopes)}}.dump());
  };
  out.failed = [this](std::uint64_t revision, const std::string& why) {
    events_.tell(Topic::Notice, Json{{"revision", revision}, {"error", why}}.dump());
  };
  return out;
}

void Studio::design_changed() {
  const std::lock_guard lock(telling_);
  const SessionView view = session_.view();
  const std::map<int, Design> pinned = pinned_designs(view.pins);
  evaluator_->wish({view.revision, view.study.design, pinned});
  Json session = session_json(view, pinned), rows = std::move(session["keys"]);
  std::optional<Json> moved = moved_since(form_told_, rows);
  if (!moved) {
    form_told_ = std::move(rows);
    events_.tell(Topic::Form, Json{{"form", ++forms_told_}, {"keys", form_told_}}.dump());
  }
  session["form"] = forms_told_;
  session["keys"] = moved.value_or(Json::array());
  events_.tell(Topic::Session, session.dump());
}

std::string Studio::changed(std::uint64_t revision) {
  design_changed();
  return Json{{"revision", revision}}.dump();
}

Json Studio::session_json(const SessionView& view, const std::map<int, Design>& pinned) const {
  Json pins = Json::array();
  for (const PinnedDesign& p : view.pins)
    pins.push_back(
        {{"number", p.number}, {"name", p.name}, {"readable", pinned.contains(p.number)}});
  Json changes = Json::array();
  for (const Change& c : view.draft.changes) changes.push_back({c.path, c.text});
  const fs::path file(view.draft.file);
  const std::string below = file.lexically_relative(files_.folder()).generic_string();
  return Json{{"revision", view.revision},
              {"title", view.study.design.title},
              {"file", visible(below.starts_with("..") ? file.filename().string() : below)},
              {"in_folder", !below.starts_with("..")},
              {"kind", texture_name(view.study.design.texture)},
              {"driven", view.study.design.drive.driven()},
              {"changes", changes},
              {"undo", view.can_undo()},
              {"redo", view.can_redo()},
              {"steps", view.steps},
              {"done", view.done},
              {"pins", pins},
              {"keys", form_json(view.study, view.opened, view.draft.changes)}};
}

std::string Studio::state() const {
  static const std::string kinds = kinds_json().dump(), words = words_json().dump();
  const SessionView view = session_.view();
  return fmt::format(
      R"({{"version":"{}","kinds":{},"words":{},"files":{},"session":{},"wish":{},"search":{},"lab":{}}})",
      PAPILLA_VERSION, kinds, words, files_.list().dump(),
      session_json(view, pinned_designs(view.pins)).dump(),
      proposed_wish(view.study, session_.wish()).dump(), desk_->json().dump(), lab_json());
}

std::string Studio::lab_json() const {
  return lab_->json(desk_->results()).dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Studio::add_routes() {
  routes_["GET /state"] = [this](const Asked&) { return state(); };
  add_design_routes();
  add_file_routes();
  add_search_routes();
  add_lab_routes();
}

void Studio::add_design_routes() {
  // A slider ends where the design ends: what it was drawn to beyond is answered with the reason.
  routes_["POST /set"] = [this](const Asked& a) {
    const std::string path = a.text("path"), value = a.text("value");
    const auto step = a.body.value("step", std::uint64_t{0});
    try {
      return changed(session_.set(path, value, step));
    } catch (const InputError& error) {
      if (!a.flag("slider")) throw;
      const std::uint64_t revision = session_.set_toward(path, value, step);
      design_changed();
      return Json{{"revision", revision}, {"ends", error.problems().front().message}}.dump();
    }
  };
  routes_["POST /kind"] = [this](const Asked& a) {
    return changed(session_.set_kind(a.text("kind")));
  };
  routes_["POST /reset"] = [this](const Asked& a) {
    return changed(session_.reset(a.text("path")));
  };
  routes_["POST /undo"] = [this](const Asked&) { return changed(session_.undo()); };
  routes_["POST /redo"] = [this](const Asked&) { return changed(session_.redo()); };
  routes_["POST /history"] = [this](const Asked& a) {
    const int done = a.whole("done");
    if (done < 0) throw InputError("the history has no step of that number");
    return changed(session_.go_to(static_cast<std::size_t>(done)));
  };
  routes_["POST /pin"] = [this](const Asked& a) {
    const int number = session_.pin(a.text_or("name"));
    design_changed();
    return Json{{"pin", number}}.dump();
  };
  routes_["POST /unpin"] = [this](const Asked& a) {
    session_.unpin(a.whole("pin"));
    return changed(session_.view().revision);
  };
  routes_["POST /take"] = [this](const Asked& a) { return changed(session_.take(a.whole("pin"))); };
  routes_["POST /slopes"] = [this](const Asked& a) {
    evaluator_->want_slopes(a.flag("wanted"));
    return Json::object().dump();
  };
  routes_["POST /maps"] = [this](const Asked& a) {
    const SessionView view = session_.view();
    if (const std::string why = why_unanswered(view.study.design); !why.empty())
      throw InputError(why);
    const auto& humidities = view.study.design.environment.relative_humidity;
    const double wanted = a.body.at("humidity").get<double>();
    const auto nearest = std::min_element(
        humidities.begin(), humidities.end(),
        [&](double x, double y) { return std::abs(x - wanted) < std::abs(y - wanted); });
    const std::lock_guard one(computing_);
    Json maps = maps_json(view.study.design, fidelity_level("draft"), *nearest);
    maps["revision"] = view.revision;
    return maps.dump();
  };
}

void Studio::add_file_routes() {
  routes_["POST /files"] = [this](const Asked&) { return files_.list().dump(); };
  routes_["POST /open"] = [this](const Asked& a) {
    return changed(session_.become({files_.open(a.text("name")), {}}));
  };
  routes_["POST /save"] = [this](const Asked& a) {
    const std::string file = files_.target(a.text("name"), a.flag("overwrite"));
    session_.save_as(
        file, [&](const Draft& draft, const Study& study) { files_.save(draft, study, file); });
    design_changed();
    return Json{{"file", fs::path(file).lexically_relative(files_.folder()).generic_string()}}
        .dump();
  };
  routes_["POST /export/preview"] = [this](const Asked&) {
    return files_.export_preview(session_.view().study).dump();
  };
  routes_["POST /export"] = [this](const Asked& a) {
    const std::lock_guard one(computing_);
    return files_.export_files(session_.view().study, a.text("name"), a.flag("overwrite")).dump();
  };
  routes_["POST /scan"] = [this](const Asked& a) {
    return files_.keep_scan(a.request.query, a.request.body).dump();
  };
  routes_["POST /scan/view"] = [this](const Asked& a) {
    const std::lock_guard one(computing_);
    return files_.scan_view(a.text("name"), a.text_or("size"), a.flag("fill"), a.flag("as_is"))
        .dump();
  };
  routes_["POST /scan/use"] = [this](const Asked& a) {
    return changed(
        session_.become(files_.with_scan(session_.view().draft, a.text("name"), a.text_or("size"),
                                         a.flag("fill"), a.flag("as_is"))));
  };
}

void Studio::add_search_routes() {
  const auto told = [this] {
    const std::string now = desk_->json().dump();
    events_.tell(Topic::Search, now);
    return now;
  };
  routes_["POST /search/start"] = [this, told](const Asked& a) {
    const SessionView view = session_.view();
    desk_->start(view.draft, view.study, search_wish(a.body), a.flag("steer"));
    return told();
  };
  routes_["POST /search/propose"] = [this](const Asked&) {
    return proposed_wish(session_.view().study, session_.wish()).dump();
  };
  routes_["POST /search/wish"] = [this](const Asked& a) {
    session_.set_wish(a.body.dump());
    return Json::object().dump();
  };
  routes_["POST /search/forget"] = [this](const Asked&) {
    session_.forget_wish();
    return proposed_wish(session_.view().study).dump();
  };
  routes_["POST /search/pause"] = [this, told](const Asked&) {
    desk_->pause();
    return told();
  };
  routes_["POST /search/resume"] = [this, told](const Asked&) {
    desk_->resume();
    return told();
  };
  routes_["POST /search/stop"] = [this, told](const Asked&) {
    desk_->stop();
    return told();
  };
  routes_["POST /search/show"] = [this, told](const Asked& a) {
    desk_->show(a.whole("number"));
    events_.tell(Topic::Lab, lab_json());
    return told();
  };
  routes_["POST /search/pick"] = [this](const Asked& a) {
    return changed(session_.become(
        a.body.contains("front") ? desk_->design_of(a.text("front"))
                                 : desk_->design_of(a.body.at("evaluation").get<std::size_t>())));
  };
}

void Studio::add_lab_routes() {
  routes_["POST /lab/plan"] = [this](const Asked& a) {
    constexpr int kMostTouches = 1000;  // as the command takes
    const int touches = a.whole("touches");
    if (touches < 1 || touches > kMostTouches)
      throw InputError(fmt::format("expected 1 to {} touches", kMostTouches));
    lab_->plan(desk_->results(), touches);
    return lab_json();
  };
  routes_["POST /lab/keep"] = [this](const Asked& a) {
    lab_->keep(desk_->results(), a.request.query, a.request.body);
    return Json::object().dump();
  };
  routes_["POST /lab/tell"] = [this](const Asked& a) {
    lab_->tell(desk_->results(), a.body.at("files").get<std::vector<std::string>>(),
               a.flag("replace"));
    return lab_json();
  };
  routes_["POST /lab/stop"] = [this](const Asked&) {
    lab_->stop();
    return lab_json();
  };
}

// Of a finished search its page; of the present one what it has so far.
HttpAnswer Studio::report(const std::string& folder) const {
  try {
    const fs::path page = inside(files_.folder(), folder + "/" + kPageName);
    const Json search = desk_->json();
    const bool present = search.value("folder", "") == folder;
    const bool unfinished = present && search["state"] != "finished";
    return {200, "text/html; charset=utf-8",
            unfinished ? unfinished_page(page.parent_path().string(), search)
                       : files_.handle().read(folder + "/" + kPageName),
            true};
  } catch (const InputError& error) {
    return refusal(404, error);
  }
}

HttpAnswer Studio::answer(const HttpRequest& request) {
  if (request.method == "GET") {
    if (const auto file = page_file(request.path))
      return {200, file->type, std::string(file->text)};
    if (request.path.starts_with("/report/")) return report(request.path.substr(8));
  }
  const auto route = routes_.find(request.method + " " + request.path);
  if (route == routes_.end()) return {404, "application/json", R"({"error":"nothing here"})"};
  try {
    Asked asked{request, Json::object()};
    if (request.method == "POST" && request.query.empty() && !request.body.empty())
      asked.body = Json::parse(request.body);
    if (!asked.body.is_object())
      return {400, "application/json", R"({"error":"expected an object"})"};
    return {200, "application/json", route->second(asked)};
  } catch (const InputError& error) {
    return refusal(200, error);  // an answer like others: browsers log failures as errors of a page
  } catch (const Json::exception&) {
    return {400, "application/json", R"({"error":"not what this address takes"})"};
  } catch (const std::exception&) {  // whose words may hold names of files
    return {500, "application/json", R"({"error":"the studio could not do that"})"};
  }
}

}  // namespace papilla::studio
