#include "studio/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "design/families.h"
#include "design/title.h"
#include "geometry/texture.h"

namespace papilla::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSessionFile = "session.json";
constexpr std::size_t kMostSteps = 200, kMostPins = 8;
constexpr std::size_t kMostOthers = 20;  // files whose drafts are kept
constexpr std::size_t kMostWishes = 20;

Json draft_json(const Draft& draft) {
  Json changes = Json::array();
  for (const Change& c : draft.changes) changes.push_back({c.path, c.text});
  return {{"file", draft.file}, {"changes", changes}};
}

Draft draft_from(const Json& json) {
  Draft out{json.at("file").get<std::string>(), {}};
  for (const Json& c : json.at("changes"))
    out.changes.push_back({c.at(0).get<std::string>(), c.at(1).get<std::string>()});
  return out;
}

Json drafts_json(const std::vector<Draft>& drafts) {
  Json out = Json::array();
  for (const Draft& d : drafts) out.push_back(draft_json(d));
  return out;
}

std::vector<Draft> drafts_from(const Json& json) {
  std::vector<Draft> out;
  for (const Json& d : json) out.push_back(draft_from(d));
  return out;
}

Json workspace_json(const Workspace& w) {
  return {{"draft", draft_json(w.draft)},
          {"past", drafts_json(w.past)},
          {"future", drafts_json(w.future)}};
}

Workspace workspace_from(const Json& json) {
  return {draft_from(json.at("draft")), drafts_from(json.at("past")),
          drafts_from(json.at("future"))};
}

Json wishes_json(const std::vector<KeptWish>& wishes) {
  Json out = Json::array();
  for (const KeptWish& w : wishes)
    out.push_back({{"file", w.file}, {"kind", w.kind}, {"text", w.text}});
  return out;
}

std::vector<KeptWish> wishes_from(const Json& json) {
  std::vector<KeptWish> out;
  for (const Json& w : json)
    out.push_back({w.at("file").get<std::string>(), w.at("kind").get<std::string>(),
                   w.at("text").get<std::string>()});
  return out;
}

// The wish for another kind of the same file: the ranges of measures are of the old kind, and so is
// a kind that was to be searched alone; what is wanted, kept and judged by is not.
std::string wish_for(const KeptWish& old, const std::string& kind) {
  Json wish = Json::parse(old.text, nullptr, false);
  if (!wish.is_object()) return {};
  wish.erase("variables");
  if (wish.value("kinds", Json()) == Json{old.kind}) wish["kinds"] = Json{kind};
  return wish.dump();
}

bool is_of_texture(const Change& change) { return change.path.starts_with("texture."); }

// The draft with one more change. One of the texture's kind takes all others of the texture away.
Draft with_change(Draft draft, const Change& change) {
  const auto known = std::find_if(draft.changes.begin(), draft.changes.end(),
                                  [&](const Change& c) { return c.path == change.path; });
  if (known != draft.changes.end())
    known->text = change.text;
  else
    draft.changes.push_back(change);
  return draft;
}

}  // namespace

Study study_of(const Draft& draft) {
  std::vector<std::string> settings;
  for (const Change& c : draft.changes) settings.push_back(c.setting());
  return read_study(draft.file, settings, DesignUse::Drawn);
}

std::string title_of(const Draft& draft, const Design& design) {
  std::vector<std::string> settings;
  for (const Change& c : draft.changes) {
    // Of a file its name alone: not where it lies on this machine.
    const bool file = c.path == "texture.file";
    settings.push_back(file ? Change{c.path, fs::path(c.text).filename().string()}.setting()
                            : c.setting());
  }
  return title_as_set(design, settings);
}

Session::Session(const fs::path& folder, const std::string& file)
    : kept_(Folder(folder).made_below(kStudioFolder)) {
  restore(file);
  keep();
}

// A state that cannot be read any more is left behind.
void Session::restore(const std::string& file) {
  adopt({file, {}});
  if (!kept_.has(kSessionFile)) return;
  try {
    constexpr std::size_t kMost = std::size_t{1} << 24;
    const Json kept = Json::parse(kept_.read(kSessionFile, kMost));
    for (const Json& p : kept.at("pins")) {
      // One whose file is gone stays: it may come back, and the others are not its business.
      pins_.push_back(
          {p.at("number").get<int>(), p.at("name").get<std::string>(), draft_from(p.at("draft"))});
      last_pin_ = std::max(last_pin_, pins_.back().number);
    }
    wishes_ = wishes_from(kept.value("wishes", Json::array()));
    for (const Json& w : kept.value("others", Json::array())) others_.push_back(workspace_from(w));
    Workspace last = workspace_from(kept);
    // Another that was left under this one's name before it was saved so.
    std::erase_if(others_, [&](const Workspace& w) { return w.draft.file == last.draft.file; });
    others_.push_back(std::move(last));
    const auto mine = std::find_if(others_.begin(), others_.end(),
                                   [&](const Workspace& w) { return w.draft.file == file; });
    if (mine == others_.end()) return;
    const Workspace found = *mine;
    others_.erase(mine);
    adopt(found.draft);
    past_ = found.past;
    future_ = found.future;
  } catch (const std::exception&) {
    past_.clear();
    future_.clear();
  }
}

void Session::keep() const {
  Json pins = Json::array(), others = Json::array();
  for (const PinnedDesign& p : pins_)
    pins.push_back({{"number", p.number}, {"name", p.name}, {"draft", draft_json(p.draft)}});
  for (std::size_t i = others_.size() > kMostOthers ? others_.size() - kMostOthers : 0;
       i < others_.size(); ++i)
    others.push_back(workspace_json(others_[i]));
  Json out = workspace_json({draft_, past_, future_});
  out.update({{"schema", 1}, {"pins", pins}, {"others", others}, {"wishes", wishes_json(wishes_)}});
  kept_.write(kSessionFile, out.dump(1, ' ', false, Json::error_handler_t::replace));
}

void Session::adopt(Draft draft) {
  Study study = study_of(draft);
  if (draft.changes.empty())
    opened_ = study.design;
  else if (draft.file != draft_.file)
    opened_ = study_of({draft.file, {}}).design;
  if (draft.file != draft_.file || !(study.design.texture == study_.design.texture))
    left_kinds_.clear();
  draft_ = std::move(draft);
  study_ = std::move(study);
  ++revision_;
}

Study Session::titled_study() const {
  Study out = study_;
  out.design.title = title_of(draft_, study_.design);
  return out;
}

SessionView Session::view() const {
  const std::lock_guard lock(mutex_);
  std::vector<const Draft*> drafts;
  for (const Draft& d : past_) drafts.push_back(&d);
  drafts.push_back(&draft_);
  for (auto d = future_.rbegin(); d != future_.rend(); ++d) drafts.push_back(&*d);
  std::vector<std::string> steps;
  for (std::size_t i = 1; i < drafts.size(); ++i)
    steps.push_back(step_text(*drafts[i - 1], *drafts[i]));
  return {revision_, draft_, titled_study(), opened_, pins_, std::move(steps), past_.size()};
}

std::uint64_t Session::replace(Draft next, std::uint64_t step) {
  if (next == draft_) return revision_;
  const Draft before = draft_;
  adopt(std::move(next));
  const bool same_gesture = step != 0 && step == last_step_;
  if (!same_gesture) past_.push_back(before);
  if (past_.size() > kMostSteps) past_.erase(past_.begin());
  future_.clear();
  last_step_ = step;
  keep();
  return revision_;
}

std::uint64_t Session::set(const std::string& path, const std::string& text, std::uint64_t step) {
  const std::lock_guard lock(mutex_);
  return replace(with_change(draft_, checked_change(form_keys(study_.design), path, text)), step);
}

std::uint64_t Session::set_toward(const std::string& path, const std::string& text,
                                  std::uint64_t step) {
  constexpr int kHalvings = 12;  // to a four-thousandth of the way
  const std::lock_guard lock(mutex_);
  const std::vector<FormKey> keys = form_keys(study_.design);
  const auto key =
      std::find_if(keys.begin(), keys.end(), [&](const FormKey& k) { return k.path == path; });
  if (key == keys.end() || key->type != KeyType::Number)
    return replace(with_change(draft_, checked_change(keys, path, text)), step);
  const double to_si = find_unit(key->unit)->to_si;
  const double wanted = parse_si(text, key->unit) / to_si;
  std::optional<Draft> furthest;
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double share = 0.5 * (low + high);
    try {
      const std::string value = significant(key->shown + share * (wanted - key->shown), 4);
      Draft next = with_change(
          draft_, checked_change(keys, path, value + (key->unit.empty() ? "" : " " + key->unit)));
      study_of(next);
      furthest = std::move(next);
      low = share;
    } catch (const InputError&) {
      high = share;
    }
  }
  if (!furthest) throw InputError({Problem{"", 0, 0, path, "the design goes no further"}});
  return replace(*std::move(furthest), step);
}

std::string Session::kind() const { return texture_name(study_.design.texture); }

std::uint64_t Session::set_kind(const std::string& kind) {
  const std::lock_guard lock(mutex_);
  const auto& kinds = texture_kinds();
  const auto at = std::find(kinds.begin(), kinds.end(), kind);
  if (at == kinds.end() || !numbers_alone(static_cast<std::size_t>(at - kinds.begin())))
    throw InputError({Problem{"", 0, 0, "texture.type", "expected a kind that numbers describe"}});
  if (kind == this->kind()) return revision_;
  std::vector<Change> own;
  std::copy_if(draft_.changes.begin(), draft_.changes.end(), std::back_inserter(own),
               is_of_texture);
  Draft next = draft_;
  std::erase_if(next.changes, is_of_texture);
  if (const auto left = left_kinds_.find(kind); left != left_kinds_.end()) {
    next.changes.insert(next.changes.end(), left->second.begin(), left->second.end());
  } else {
    Design wanted = study_.design;
    wanted.texture = of_kind(wanted.texture, kind);
    for (const Change& change : changes_between(study_of(next).design, wanted))
      next = with_change(std::move(next), change);
  }
  auto left = left_kinds_;
  left[this->kind()] = std::move(own);
  const std::uint64_t revision = replace(std::move(next), 0);
  left_kinds_ = std::move(left);
  return revision;
}

std::uint64_t Session::become(const Draft& draft) {
  const std::lock_guard lock(mutex_);
  return replace(draft, 0);
}

std::uint64_t Session::reset(const std::string& path) {
  const std::lock_guard lock(mutex_);
  Draft next = draft_;
  // Of a list that was changed as a whole no item is in the file by itself.
  const std::string list = list_of(path);
  const bool whole = std::any_of(next.changes.begin(), next.changes.end(),
                                 [&](const Change& c) { return c.path == list; });
  std::erase_if(next.changes, [&](const Change& c) {
    return c.path == path || (whole && (c.path == list || list_of(c.path) == list));
  });
  return replace(std::move(next), 0);
}

std::uint64_t Session::save_as(const std::string& file,
                               const std::function<void(const Draft&, const Study&)>& write) {
  const std::lock_guard lock(mutex_);
  // What stands on this file keeps its design when the file changes below it.
  std::vector<std::pair<Draft*, Design>> standing;
  const auto note = [&](Draft& draft) {
    if (draft.file == file) standing.emplace_back(&draft, study_of(draft).design);
  };
  for (Draft& draft : past_) note(draft);
  for (Draft& draft : future_) note(draft);
  for (PinnedDesign& pin : pins_) note(pin.draft);
  write(draft_, titled_study());
  const Design now = study_of({file, {}}).design;
  for (auto& [draft, design] : standing) draft->changes = changes_between(now, design);
  const std::string wish = wish_at_hand();
  adopt({file, {}});
  if (!wish.empty()) put_wish(wish);
  last_step_ = 0;
  keep();
  return revision_;
}

std::uint64_t Session::step_to(std::vector<Draft>& from, std::vector<Draft>& to) {
  if (from.empty()) return revision_;
  const Draft before = draft_;
  Draft next = from.back();
  adopt(std::move(next));
  from.pop_back();
  to.push_back(before);
  last_step_ = 0;
  keep();
  return revision_;
}

std::uint64_t Session::undo() {
  const std::lock_guard lock(mutex_);
  return step_to(past_, future_);
}

std::uint64_t Session::redo() {
  const std::lock_guard lock(mutex_);
  return step_to(future_, past_);
}

std::uint64_t Session::go_to(std::size_t done) {
  const std::lock_guard lock(mutex_);
  if (done > past_.size() + future_.size())
    throw InputError("the history has no step of that number");
  while (past_.size() > done) step_to(past_, future_);
  while (past_.size() < done) step_to(future_, past_);
  return revision_;
}

std::string step_text(const Draft& from, const Draft& to) {
  constexpr std::size_t kMostNamed = 3;
  if (from.file != to.file) return std::filesystem::path(to.file).filename().string() + " opened";
  // "surface.dielectric.0.thickness": dielectric 1 thickness, as the page calls it.
  const auto called = [](const std::string& path) {
    std::string out;
    for (std::string part : split(path.substr(path.find('.') + 1), '.')) {
      const bool index = part.find_first_not_of("0123456789") == std::string::npos;
      if (index) part = fmt::format("{}", std::stoul(part) + 1);
      out += (out.empty() ? "" : " ") + part;
    }
    std::replace(out.begin(), out.end(), '_', ' ');
    return out;
  };
  // Of sections, too long for a line.
  const auto is_list = [](const std::string& text) { return text.starts_with("[{"); };
  std::vector<std::string> parts;
  for (const Change& c : to.changes) {
    if (std::find(from.changes.begin(), from.changes.end(), c) == from.changes.end())
      parts.push_back(called(c.path) + " " + (is_list(c.text) ? "changed" : c.text));
  }
  for (const Change& c : from.changes) {
    if (std::none_of(to.changes.begin(), to.changes.end(),
                     [&](const Change& other) { return other.path == c.path; }))
      parts.push_back(called(c.path) + " as the file has it");
  }
  if (parts.size() > kMostNamed) {
    const std::size_t more = parts.size() - kMostNamed;
    parts.resize(kMostNamed);
    parts.push_back(fmt::format("{} more", more));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

int Session::pin(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (pins_.size() >= kMostPins)
    throw InputError(fmt::format("{} designs are pinned already: unpin one first", kMostPins));
  const int number = ++last_pin_;
  pins_.push_back(
      {number, name.empty() ? fmt::format("design {}", number) : name.substr(0, 60), draft_});
  keep();
  return number;
}

void Session::unpin(int number) {
  const std::lock_guard lock(mutex_);
  std::erase_if(pins_, [&](const PinnedDesign& p) { return p.number == number; });
  keep();
}

void Session::put_wish(std::string wish) {
  std::erase_if(wishes_,
                [&](const KeptWish& w) { return w.file == draft_.file && w.kind == kind(); });
  wishes_.push_back({draft_.file, kind(), std::move(wish)});
  while (wishes_.size() > kMostWishes) wishes_.erase(wishes_.begin());
}

void Session::set_wish(std::string wish) {
  constexpr std::size_t kLongest = 100000;
  if (wish.size() > kLongest) throw InputError("the wish is too long");
  const std::lock_guard lock(mutex_);
  put_wish(std::move(wish));
  keep();
}

void Session::forget_wish() {
  const std::lock_guard lock(mutex_);
  std::erase_if(wishes_, [&](const KeptWish& w) { return w.file == draft_.file; });
  keep();
}

std::string Session::wish_at_hand() const {
  const auto of_file = [&](const KeptWish& w) { return w.file == draft_.file; };
  const auto last = std::find_if(wishes_.rbegin(), wishes_.rend(), of_file);
  if (last == wishes_.rend()) return {};
  const auto own = std::find_if(last, wishes_.rend(),
                                [&](const KeptWish& w) { return of_file(w) && w.kind == kind(); });
  return own != wishes_.rend() ? own->text : wish_for(*last, kind());
}

std::string Session::wish() const {
  const std::lock_guard lock(mutex_);
  return wish_at_hand();
}

std::uint64_t Session::take(int number) {
  const std::lock_guard lock(mutex_);
  for (const PinnedDesign& p : pins_) {
    if (p.number == number) return replace(p.draft, 0);
  }
  throw InputError("no design is pinned under this number");
}

}  // namespace papilla::studio
