#include "report/receipts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/digest.h"
#include "base/error.h"
#include "report/json.h"
#include "search/reanswer.h"
#include "search/records.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// Claims of texts in the order in which they are read, each once with its places.
class Collected {
 public:
  void text(const std::string& place, const std::string& text) {
    for (const TextPart& part : said_parts(text)) {
      if (part.number) add(place, *part.number, part.text);
    }
  }
  void json(const std::string& place, const Json& json) {
    if (json.is_string()) text(place, json.get_ref<const std::string&>());
    if (!json.is_structured()) return;
    const Json flat = json.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      if (value.is_string()) text(place + pointer, value.get_ref<const std::string&>());
    }
  }
  std::vector<Receipt> take() { return std::move(list_); }

 private:
  void add(const std::string& place, const StatedNumber& number, const std::string& text) {
    const auto same = [&](const Receipt& r) {
      return r.number.words == number.words && r.text == text &&
             json_number(r.number.value) == json_number(number.value);
    };
    auto known = std::find_if(list_.begin(), list_.end(), same);
    if (known == list_.end()) {
      list_.push_back({fmt::format("r{:02}", list_.size() + 1), number, text, {}, ""});
      known = list_.end() - 1;
    }
    if (std::find(known->places.begin(), known->places.end(), place) == known->places.end())
      known->places.push_back(place);
  }

  std::vector<Receipt> list_;
};

const Json& text_of(const Json& j) {
  if (!j.is_string()) throw InputError("");
  return j;
}

StatedError error_of(const Json& j, const std::string& name) {
  StatedError out;
  if (j.at(name).is_number()) out.size = j.at(name).get<double>();
  if (j.contains(name + "_absent")) out.absent = text_of(j.at(name + "_absent"));
  return out;
}

void add_error(const char* name, const StatedError& error, Json& out) {
  out[name] = json_number(error.size);
  if (!error.size) out[std::string(name) + "_absent"] = error.absent;
}

Receipt receipt_of(const Json& j) {
  Receipt out;
  out.id = text_of(j.at("id"));
  out.number.words = text_of(j.at("claim"));
  out.text = text_of(j.at("text"));
  if (j.at("value").is_number()) out.number.value = j.at("value").get<double>();
  out.number.unit = text_of(j.at("unit"));
  out.number.numerical = error_of(j, "u_num");
  out.number.model = error_of(j, "u_model");
  out.places = j.at("places").get<std::vector<std::string>>();
  for (const Json& name : j.at("rests_on")) {
    const auto stage = stage_named(text_of(name));
    if (!stage) throw InputError("");
    out.number.rests_on.push_back(*stage);
  }
  out.inputs = text_of(j.at("inputs"));
  return out;
}

}  // namespace

Receipts receipts_of(const ResultFiles& f, const Json& run, const std::string& summary) {
  Collected collected;
  collected.json("run.json#", run);
  collected.text("summary.md", summary);
  const Folder folder(f.folder);
  const bool finish = f.result.end == SearchEnd::Asked;
  Receipts out{PAPILLA_VERSION, f.pick, finish, "", f.study.name, collected.take()};
  if (folder.has("resolved.toml")) out.study = sha256(folder.read("resolved.toml"));
  const AskedQuestions asked(f.problem, folder);
  for (Receipt& r : out.list) r.inputs = sha256(asked.of(r.number.rests_on));
  return out;
}

std::string receipts_text(const Receipts& receipts) {
  Json rows = Json::array();
  for (const Receipt& r : receipts.list) {
    Json one{{"id", r.id},
             {"claim", r.number.words},
             {"text", r.text},
             {"value", json_number(r.number.value)},
             {"unit", r.number.unit}};
    add_error("u_num", r.number.numerical, one);
    add_error("u_model", r.number.model, one);
    one["places"] = r.places;
    one["rests_on"] = Json::array();
    for (const Stage stage : r.number.rests_on) one["rests_on"].push_back(stage_name(stage));
    one["command"] = "papilla verify . --receipt " + r.id;
    one["inputs"] = r.inputs;
    rows.push_back(std::move(one));
  }
  const Json out{
      {"schema", 1},           {"version", receipts.version}, {"command", "papilla verify ."},
      {"pick", receipts.pick}, {"finish", receipts.finish},   {"resolved.toml", receipts.study},
      {"name", receipts.name}, {"receipts", std::move(rows)}};
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Receipts read_receipts(const std::string& text, const std::string& file) {
  try {
    const Json j = Json::parse(text);
    Receipts out{text_of(j.at("version")),
                 text_of(j.at("pick")),
                 j.at("finish").get<bool>(),
                 text_of(j.at("resolved.toml")),
                 j.contains("name") ? text_of(j.at("name")) : "",
                 {}};
    for (const Json& one : j.at("receipts")) out.list.push_back(receipt_of(one));
    return out;
  } catch (const Json::exception&) {
  } catch (const InputError&) {
  }
  throw InputError({Problem{file, 0, 0, "", "these are no receipts that papilla has written"}});
}

}  // namespace papilla::report
