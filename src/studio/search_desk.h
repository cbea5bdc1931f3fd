// Searches from the page: one at a time, each in a folder of its own, by the command that a person
// would run. What it finds is in its journal, so that a page, the studio or the machine may go and
// come back.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "optim/journal.h"
#include "search/problem.h"
#include "search/protocol.h"
#include "studio/child.h"
#include "studio/session.h"

namespace papilla::studio {

// What a person wants of a search: set on the page, and steered while it runs.
struct VariableWish {
  std::string path, low, high;  // texts with units: "100 nm"; the same value twice: pinned there
  std::string excluding{};      // of them: "300 to 400 nm, 600 to 650 nm"
};
struct LimitWish {
  std::string name, limit;  // "min_hole", "1 um"
};
struct SearchWish {
  std::vector<VariableWish> variables;
  std::vector<std::string> kinds;    // of texture that compete; fewer than two: the one at hand
  std::vector<std::string> fingers;  // of the study's people, by name; empty: all of them
  std::vector<std::string> maximise, minimise;
  std::vector<LimitWish> limits;
  int evaluations = 0;  // 0: as many as the method takes
};
SearchWish search_wish(const nlohmann::ordered_json& json);  // throws InputError
// What the page proposes for a study: its own, or what a design without one could vary; with what
// a page wrote over it (text of JSON; empty: nothing).
nlohmann::ordered_json proposed_wish(const Study& study, const std::string& kept = "");

// The study file of a wish on a design; a whole file of its own. What the page has no row for stays
// as the study has it where the wish is not of it: values and levels to choose among, targets.
std::string study_text(const Study& study, const SearchWish& wish);

enum class SearchState { None, Running, Paused, Finished, Failed };

class SearchDesk {
 public:
  // program: that runs `optimize`. told: of every change, from the desk's own thread.
  SearchDesk(std::filesystem::path folder, std::string program, std::function<void()> told);
  ~SearchDesk();  // closes
  SearchDesk(const SearchDesk&) = delete;
  SearchDesk& operator=(const SearchDesk&) = delete;

  // Throws InputError for a wish that is no study, or where a search runs. steer: one that runs is
  // ended first, and the new one begins at the design at hand.
  void start(const Draft& origin, const Study& study, const SearchWish& wish, bool steer);
  void pause();
  void resume();
  // Looks for no more: the best of what was found is confirmed and reported.
  void stop();
  // A running search is ended after its journal's last record and can be resumed; nothing is told
  // any more. Before what `told` asks goes.
  void close();
  // Makes an earlier search the present one. Throws InputError where one runs, or for a number of
  // none.
  void show(int number);
  // The design of an evaluation of the search, or of its front, as a draft.
  Draft design_of(std::size_t evaluation) const;
  Draft design_of(const std::string& front) const;

  nlohmann::ordered_json json() const;  // all that the page draws
  // The folder of the present search below the studio's, "searches/001"; empty: it has no results.
  std::string results() const;

 private:
  struct Found {
    Point unit;
    search::Judgement judgement;
  };
  struct Present {
    explicit Present(const std::string& file);
    const Study study;
    const StudyProblem problem;  // refers to the study
    const SearchProblem search;
    JournalReader journal;
  };

  void watch();  // the desk's thread
  void launch(bool again, bool to_its_end = false);
  bool read_journal();
  void start_child();
  void wait_for_child();
  std::vector<int> numbers() const;
  void take_up(int number);
  std::string place() const;  // of the present search, below the folder
  std::string in_place(const char* name) const;
  Draft draft_of(const Design& design, const std::string& instead) const;
  void begin_reading();
  nlohmann::ordered_json front_json() const;
  nlohmann::ordered_json recommended_json() const;
  std::string log() const;             // of the program; empty: it said nothing
  std::string trouble_of_log() const;  // of that, for people
  void stop_child(std::unique_lock<std::mutex>& lock);

  Folder folder_;
  std::string program_;
  std::function<void()> told_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int number_ = 0;  // of the present search; 0: there was none
  SearchState state_ = SearchState::None;
  std::unique_ptr<Present> present_;
  std::vector<Found> found_;
  int total_ = 0;
  std::string stage_, trouble_;
  bool to_its_end_ = false;  // the child looks for no more than kLastWord lets it
  bool ended_ = false;       // by its journal
  std::optional<Child> child_;
  bool wants_child_ = false, again_ = false, stopping_ = false, closing_ = false;
  std::thread thread_;
};

}  // namespace papilla::studio
