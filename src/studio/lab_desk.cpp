#include "studio/lab_desk.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "studio/child.h"

namespace papilla::studio {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char *kLab = "lab", *kMeasured = "lab_measured", *kSaid = "lab_said.md",
                     *kNoted = "lab_log.txt";

std::string last_line(const std::string& text) {
  std::string out;
  for (const std::string& line : split(text, '\n')) {
    if (!line.empty()) out = line;
  }
  return out;
}

}  // namespace

LabDesk::LabDesk(std::filesystem::path folder, std::string program, std::function<void()> told)
    : folder_(folder), program_(std::move(program)), told_(std::move(told)) {}

LabDesk::~LabDesk() { close(); }

void LabDesk::close() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void LabDesk::plan(const std::string& results, int touches) {
  if (results.empty()) throw InputError("no search has results yet: a lab is of its finalists");
  const Folder of = folder_.below(results);
  const bool open = of.has(std::string(kLab) + "/lab.toml");
  std::vector<std::string> words{program_, "next"};
  if (open)
    words.push_back(of.path(kLab));
  else
    words.insert(words.end(), {of.path(), "--lab", of.path(kLab)});
  words.insert(words.end(), {"--count", std::to_string(touches)});
  begin(results, "plan", std::move(words));
}

void LabDesk::tell(const std::string& results, const std::vector<std::string>& files,
                   bool replace) {
  if (files.empty()) throw InputError("choose a table, or records of a tribometer");
  if (results.empty() || !folder_.has(results + "/" + kLab + "/lab.toml"))
    throw InputError("plan measurements first: a table is told to a lab");
  const Folder of = folder_.below(results);
  std::vector<std::string> words{program_, "tell", of.path(kLab)};
  for (const std::string& name : files)
    words.push_back(of.file(std::string(kMeasured) + "/" + name));
  if (replace) words.emplace_back("--replace");
  begin(results, "tell", std::move(words));
}

void LabDesk::keep(const std::string& results, const std::string& name,
                   const std::string& bytes) const {
  if (results.empty()) throw InputError("no search has results yet: a lab is of its finalists");
  if (name.find('/') != std::string::npos || !name.ends_with(".csv") || name.starts_with('.'))
    throw InputError({Problem{name, 0, 0, "",
                              "expected a .csv: a table of frictions, or the record of one "
                              "experiment"}});
  folder_.below(results).made_below(kMeasured).write(name, bytes);
}

void LabDesk::stop() {
  {
    const std::lock_guard lock(mutex_);
    if (doing_.empty()) return;
    stopping_ = true;
  }
  changed_.notify_all();
}

void LabDesk::begin(const std::string& results, std::string doing, std::vector<std::string> words) {
  {
    const std::lock_guard lock(mutex_);
    if (!doing_.empty()) throw InputError("the lab is at work: wait for it, or stop it");
    doing_ = std::move(doing);
    trouble_.clear();
    stopping_ = false;
  }
  if (thread_.joinable()) thread_.join();  // it has ended, and tells the last of it
  thread_ = std::thread([this, results, words = std::move(words)] { work(results, words); });
}

void LabDesk::work(const std::string& results, const std::vector<std::string>& words) {
  bool done = false;
  try {
    const Folder of = folder_.below(results);
    Child child(words, emptied(of, kSaid), emptied(of, kNoted));
    told_();
    std::string noted;
    while (!child.ended()) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kLook, [&] { return stopping_ && !child.asked_to_end(); });
        if (stopping_) child.ask_to_end();
      }
      if (std::string line = last_line(of.read(kNoted)); line != noted) {
        noted = std::move(line);
        told_();
      }
    }
    done = child.ended() == 0;
  } catch (const InputError& error) {
    const std::lock_guard lock(mutex_);
    trouble_ = error.what();
    trouble_of_ = results;
  }
  ended(results, done);
  told_();
}

void LabDesk::ended(const std::string& results, bool done) {
  const std::lock_guard lock(mutex_);
  doing_.clear();
  if (!trouble_.empty() || stopping_ || done) return;
  const std::string log = results + "/" + kNoted;
  trouble_ = folder_.has(log) ? visible(why_failed(folder_.read(log))) : "the lab failed";
  trouble_of_ = results;
}

Json LabDesk::json(const std::string& results) const {
  const std::lock_guard lock(mutex_);
  Json out{{"folder", results}, {"doing", doing_}, {"trouble", ""}, {"lab", nullptr}};
  if (results.empty()) return out;
  const auto text = [&](const std::string& name) {
    const std::string file = results + "/" + name;
    return folder_.has(file) ? visible(folder_.read(file)) : std::string();
  };
  if (trouble_of_ == results) out["trouble"] = trouble_;
  out["said"] = doing_.empty() ? text(kSaid) : "";
  out["noted"] = doing_.empty() ? "" : last_line(text(kNoted));
  const std::string lab = std::string(kLab) + "/";
  try {
    if (const std::string state = text(lab + "lab.json"); !state.empty())
      out["lab"] = Json::parse(state);
  } catch (const Json::exception&) {  // it is being written
  }
  if (out["lab"].is_null()) return out;
  const std::string table = fmt::format("plan_{:02}.csv", out["lab"]["plans"].size());
  out["table"] = {{"name", table}, {"text", text(lab + table)}};
  return out;
}

}  // namespace papilla::studio
