#include "studio/search_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"
#include "optim/pareto.h"
#include "report/json.h"
#include "search/decision.h"
#include "search/records.h"
#include "search/run.h"
#include "studio/child.h"

namespace papilla::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kLog = "log.txt";
constexpr const char* kLastWord = "5 min";  // of a search that is stopped

const char* name_of(SearchState state) {
  switch (state) {
    case SearchState::None:
      return "none";
    case SearchState::Running:
      return "running";
    case SearchState::Paused:
      return "paused";
    case SearchState::Finished:
      return "finished";
    case SearchState::Failed:
      return "failed";
  }
  return "";
}

const char* stage_name(Stage stage) {
  switch (stage) {
    case Stage::Search:
    case Stage::Draft:
      return "search";
    case Stage::Narrow:
      return "narrow";
    case Stage::Confirm:
      return "confirm";
    case Stage::Belief:
      return "belief";
    default:
      return "check";
  }
}

// What a search that runs says of itself: the share of the whole run that is done, seconds left.
Json progress_of(const Folder& folder, const std::string& file) {
  if (!folder.has(file)) return nullptr;
  try {
    return Json::parse(folder.read(file));
  } catch (const std::exception&) {  // it ended meanwhile
    return nullptr;
  }
}

// Of the folder of a search, "001"; 0: of something else.
int number_of(const std::string& name) {
  int out = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), out);
  const bool whole = error == std::errc{} && end == name.data() + name.size();
  return whole && name == fmt::format("{:03}", out) ? out : 0;
}

Json csv_rows(const std::string& text) {
  Json out = Json::array();
  std::vector<std::string> head;
  for (const std::string& line : split(text, '\n')) {
    if (line.empty()) continue;
    const std::vector<std::string> cells = split(line, ',');
    if (head.empty()) {
      head = cells;
      continue;
    }
    Json row = Json::object();
    for (std::size_t i = 0; i < std::min(head.size(), cells.size()); ++i) row[head[i]] = cells[i];
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace

SearchDesk::Present::Present(const std::string& file)
    : study(read_study(file)),
      problem(study),
      search(search_problem(problem)),
      journal(journal_key(problem)) {}

SearchDesk::SearchDesk(fs::path folder, std::string program, std::function<void()> told)
    : folder_(folder), program_(std::move(program)), told_(std::move(told)) {
  if (const std::vector<int> all = numbers(); !all.empty()) take_up(all.back());
  thread_ = std::thread([this] { watch(); });
}

SearchDesk::~SearchDesk() { close(); }

void SearchDesk::close() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::string SearchDesk::place() const { return fmt::format("{}/{:03}", kSearches, number_); }
std::string SearchDesk::in_place(const char* name) const { return place() + "/" + name; }

// Of all searches of the folder, in their order.
std::vector<int> SearchDesk::numbers() const {
  std::vector<int> out;
  if (!folder_.has_folder(kSearches)) return out;
  const Folder searches = folder_.below(kSearches);
  for (const std::string& name : searches.folders()) {
    if (const int number = number_of(name); number > 0 && searches.has(name + "/study.toml"))
      out.push_back(number);
  }
  std::sort(out.begin(), out.end());
  return out;
}

// As it was left.
void SearchDesk::take_up(int number) {
  number_ = number;
  try {
    begin_reading();
    if (!trouble_.empty()) return;
    // One that was interrupted has files too, but no end in its journal; one that was refused has
    // no journal, and nothing to resume.
    const bool finished = ended_ && folder_.has(in_place("run.json"));
    const bool refused = !folder_.has(in_place(kJournalName)) && says_an_error(log());
    state_ = finished ? SearchState::Finished : refused ? SearchState::Failed : SearchState::Paused;
    if (refused) trouble_ = trouble_of_log();
  } catch (const InputError& error) {
    state_ = SearchState::Failed;
    trouble_ = error.what();
  }
}

void SearchDesk::show(int number) {
  const std::lock_guard lock(mutex_);
  if (state_ == SearchState::Running) throw InputError("a search is running: pause it first");
  const std::vector<int> known = numbers();
  if (std::find(known.begin(), known.end(), number) == known.end())
    throw InputError(fmt::format("there is no search {:03}", number));
  take_up(number);
}

void SearchDesk::begin_reading() {
  present_ = std::make_unique<Present>(folder_.file(in_place("study.toml")));
  total_ = present_->search.evaluations;
  found_.clear();
  ended_ = false;
  stage_ = "search";
  trouble_.clear();
  read_journal();
}

// What was appended since; whether there was something.
bool SearchDesk::read_journal() try {
  if (!present_ || !trouble_.empty()) return false;
  const std::vector<JournalRecord> news =
      present_->journal.more(folder_.below(place()), kJournalName);
  for (const JournalRecord& record : news) {
    const auto request = checked_request(present_->problem, present_->search, record);
    if (!request)
      throw InputError(in_place(kJournalName) + ": holds what no run of its study wrote");
    stage_ = stage_name(request->stage);
    ended_ = ended_ || request->stage == Stage::Done;
    if (request->stage == Stage::Search)
      found_.push_back({request->unit, *decode_judgement(record.payload)});
  }
  return !news.empty();
} catch (const InputError& error) {
  state_ = SearchState::Failed;
  trouble_ = error.what();
  return true;
}

void SearchDesk::start(const Draft& origin, const Study& study, const SearchWish& wish,
                       bool steer) {
  std::unique_lock lock(mutex_);
  if (state_ == SearchState::Running) {
    if (!steer) throw InputError("a search is running: pause it, or steer it");
    stop_child(lock);
  }
  const std::vector<int> before = numbers();
  const int next = before.empty() ? 1 : before.back() + 1;
  const std::string name = fmt::format("{}/{:03}", kSearches, next);
  const Folder folder = folder_.made_below(name);
  try {
    folder.write("study.toml", study_text(study, wish));
    const Present judged(folder.file("study.toml"));  // refuses what cannot be judged
    Json changes = Json::array();
    for (const Change& c : origin.changes) changes.push_back({c.path, c.text});
    folder.write("origin.json", Json{{"file", origin.file}, {"changes", changes}}.dump(1));
  } catch (...) {
    folder_.remove(name);
    throw;
  }
  number_ = next;
  begin_reading();
  launch(false);
}

// Asks the desk's thread, with which a search ends; with the lock held.
void SearchDesk::launch(bool again, bool to_its_end) {
  state_ = SearchState::Running;
  again_ = again;
  to_its_end_ = to_its_end;
  wants_child_ = true;
  changed_.notify_all();
}

void SearchDesk::stop_child(std::unique_lock<std::mutex>& lock) {
  wants_child_ = false;
  if (!child_) return;
  stopping_ = true;
  child_->ask_to_end();  // after the running evaluations; its journal has all others
  changed_.wait(lock, [&] { return !child_ || closing_; });
}

void SearchDesk::pause() {
  std::unique_lock lock(mutex_);
  if (state_ != SearchState::Running) throw InputError("no search is running");
  stop_child(lock);
  if (state_ == SearchState::Running) state_ = SearchState::Paused;
}

void SearchDesk::resume() {
  const std::lock_guard lock(mutex_);
  if (state_ != SearchState::Paused) throw InputError("no search is paused");
  launch(true);
}

void SearchDesk::stop() {
  std::unique_lock lock(mutex_);
  const auto is_open = [&] {
    return state_ == SearchState::Running || state_ == SearchState::Paused;
  };
  // Before its program is asked to end: a search that is refused a stop goes on.
  if (is_open() && found_.empty())
    throw InputError("no design was judged yet: pause the search instead");
  if (state_ == SearchState::Running) stop_child(lock);
  if (!is_open()) throw InputError("no search is running");
  launch(true, true);
}

void SearchDesk::watch() {
  std::unique_lock lock(mutex_);
  while (!closing_) {
    if (wants_child_ && !child_) start_child();
    changed_.wait_for(lock, kLook, [&] { return closing_ || (wants_child_ && !child_); });
    if (!child_) continue;
    const bool news = read_journal();
    const bool before = state_ == SearchState::Running;
    wait_for_child();
    if (news || (before && state_ != SearchState::Running) || !child_) {
      lock.unlock();
      told_();
      lock.lock();
    }
  }
  child_.reset();  // at the end of the studio; its journal has all that it answered
}

void SearchDesk::start_child() try {
  wants_child_ = false;
  const Folder folder = folder_.below(place());
  std::vector<std::string> words{program_, "optimize", folder.file("study.toml"), "--out",
                                 folder.path()};
  if (again_ && folder.has(kJournalName)) words.push_back("--resume");
  if (to_its_end_) words.insert(words.end(), {"--finish", "--time", kLastWord});
  const Handle log = emptied(folder, kLog);
  child_.emplace(words, log, log);
} catch (const InputError& error) {
  state_ = SearchState::Failed;
  trouble_ = error.what();
}

void SearchDesk::wait_for_child() {
  const std::optional<int> code = child_->ended();
  if (!code) return;
  child_.reset();
  read_journal();
  const bool finished = folder_.has(in_place("run.json")) && (*code == 0 || *code == 1);
  const bool paused = stopping_ || *code >= 128;
  stopping_ = false;
  state_ = finished ? SearchState::Finished : paused ? SearchState::Paused : SearchState::Failed;
  if (state_ == SearchState::Failed && trouble_.empty()) trouble_ = trouble_of_log();
  changed_.notify_all();
}

std::string SearchDesk::log() const {
  return folder_.has(in_place(kLog)) ? folder_.read(in_place(kLog)) : "";
}

std::string SearchDesk::trouble_of_log() const { return visible(why_failed(log())); }

std::string SearchDesk::results() const {
  const std::lock_guard lock(mutex_);
  return state_ == SearchState::Finished ? place() : "";
}

Draft SearchDesk::design_of(std::size_t evaluation) const {
  const std::lock_guard lock(mutex_);
  if (!present_ || evaluation >= found_.size()) throw InputError("the search has no such design");
  return draft_of(present_->problem.space().design(found_[evaluation].unit),
                  "a design of " + place() + "/front");
}

Draft SearchDesk::design_of(const std::string& front) const {
  const std::lock_guard lock(mutex_);
  const std::string file = place() + "/" + front + "/design.toml";
  if (!present_ || !folder_.has(file)) throw InputError("the search has no such design");
  return draft_of(read_design(folder_.file(file)), file);
}

// The design as changes of what the search began with. Throws InputError where none make it, as of
// a study that varies parts which the design has not: another design would be shown.
Draft SearchDesk::draft_of(const Design& design, const std::string& instead) const {
  const Json origin = Json::parse(folder_.read(in_place("origin.json")));
  Draft out{origin.at("file").get<std::string>(), {}};
  out.changes = changes_between(study_of(out).design, design);
  std::string why = "another design comes out";
  try {
    Design reached = study_of(out).design;
    reached.title = design.title;
    if (reached == design) return out;
  } catch (const InputError& error) {
    const Problem& first = error.problems().front();
    why = first.key + ": " + first.message;
  }
  throw InputError(
      fmt::format("no changes of {} make this design: {}; open {} itself, and save it under a name "
                  "of its own",
                  fs::path(out.file).filename().string(), why, instead));
}

Json SearchDesk::front_json() const {
  const std::string table = in_place("pareto.csv");
  if (state_ != SearchState::Finished || !folder_.has(table)) return Json::array();
  return csv_rows(folder_.read(table));
}

// The design that the run recommends, "front/03", null where it is a surface without texture; and
// what the run says of it.
Json SearchDesk::recommended_json() const {
  Json out{{"design", nullptr}, {"words", ""}};
  if (state_ != SearchState::Finished || !folder_.has(in_place("run.json"))) return out;
  const Json run = Json::parse(folder_.read(in_place("run.json")), nullptr, false);
  if (!run.is_object()) return out;
  if (run.contains("design")) out["design"] = run["design"];
  if (run.contains("recommendation")) out["words"] = run["recommendation"];
  return out;
}

Json SearchDesk::json() const {
  const std::lock_guard lock(mutex_);
  Json out{{"state", name_of(state_)}, {"number", number_}, {"numbers", numbers()}};
  if (!present_) return out;
  const StudyProblem& problem = present_->problem;
  const std::vector<Variable>& varied = present_->study.variables;
  Json variables = Json::array(), objectives = Json::array(), points = Json::array();
  for (const Variable& v : varied) variables.push_back({{"path", v.path}, {"unit", v.unit}});
  for (const StudyObjective& o : problem.objectives()) {
    const ShownUnit shown = shown_unit(o.expression);  // values are told in SI
    objectives.push_back(
        {{"name", o.name}, {"maximise", o.maximise}, {"scale", shown.scale}, {"unit", shown.unit}});
  }
  // Of the regret by belief; the desk's runs are asked for no rule.
  const ShownUnit worth = unit_of_worth(problem, decision_rule(problem, ""));
  std::vector<Evaluation> tried;
  for (const Found& f : found_) {
    tried.push_back({f.unit, f.judgement.outcome});
    Json values = Json::array(), reached = Json::array();
    const std::vector<double> at = problem.space().value(f.unit);
    for (std::size_t i = 0; i < at.size(); ++i) values.push_back(variable_text(varied[i], at[i]));
    for (std::size_t k = 0; k < f.judgement.outcome.objectives.size(); ++k) {
      const double v = f.judgement.outcome.objectives[k];
      reached.push_back(json_number(problem.objectives()[k].maximise ? -v : v));
    }
    points.push_back({{"values", values},
                      {"objectives", reached},
                      {"ok", f.judgement.outcome.ok},
                      {"feasible", f.judgement.outcome.feasible()}});
  }
  out["folder"] = place();
  out["stage"] = stage_;
  out["done"] = found_.size();
  out["total"] = total_;
  out["trouble"] = trouble_;
  out["progress"] =
      state_ == SearchState::Running ? progress_of(folder_, in_place(kProgressFile)) : Json();
  out["variables"] = variables;
  out["fingers"] = Json::array();
  for (const auto& task : problem.tasks()) out["fingers"].push_back(task.name);
  out["objectives"] = objectives;
  out["worth"] = {{"scale", worth.scale}, {"unit", worth.unit}};
  out["points"] = points;
  out["front"] = pareto_front(tried);
  out["confirmed"] = front_json();
  out["recommended"] = recommended_json();
  return out;
}

}  // namespace papilla::studio
