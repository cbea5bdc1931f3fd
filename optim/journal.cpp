#include "optim/journal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/files.h"

namespace papilla::optim {
namespace {

std::uint64_t checksum(const std::string& text) {  // FNV-1a, 64 bits
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ULL;
  return hash;
}

constexpr char kBetween = '\t';  // key and payload

// Letters that a line cannot hold, and what stands for them behind a backslash.
constexpr std::array<std::pair<char, char>, 4> kEscapes{
    {{'\\', '\\'}, {'\n', 'n'}, {'\r', 'r'}, {kBetween, 't'}}};

std::string escaped(const std::string& bytes) {
  std::string out;
  for (char c : bytes) {
    const auto* special =
        std::find_if(kEscapes.begin(), kEscapes.end(), [c](const auto& e) { return e.first == c; });
    if (special == kEscapes.end()) {
      out += c;
    } else {
      out += {'\\', special->second};
    }
  }
  return out;
}

std::optional<std::string> unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      out += text[i];
      continue;
    }
    if (++i == text.size()) return std::nullopt;
    const auto* special = std::find_if(kEscapes.begin(), kEscapes.end(),
                                       [&](const auto& e) { return e.second == text[i]; });
    if (special == kEscapes.end()) return std::nullopt;
    out += special->first;
  }
  return out;
}

std::string header(const std::string& key) { return "papilla-journal 2 " + key + "\n"; }

}  // namespace

std::string text_hash(const std::string& text) { return fmt::format("{:016x}", checksum(text)); }

std::string journal_line(const JournalRecord& record) {
  const std::string body = escaped(record.key) + kBetween + escaped(record.payload);
  return fmt::format("{:016x} {}\n", checksum(body), body);
}

bool parse_journal_line(const std::string& line, JournalRecord& record) {
  if (line.size() < 18 || line[16] != ' ') return false;
  const std::string body = line.substr(17);
  if (fmt::format("{:016x}", checksum(body)) != line.substr(0, 16)) return false;
  const std::size_t between = body.find(kBetween);
  if (between == std::string::npos) return false;
  const auto key = unescaped(body.substr(0, between)),
             payload = unescaped(body.substr(between + 1));
  if (!key || !payload) return false;
  JournalRecord found{*key, *payload};
  if (journal_line(found) != line + "\n") return false;
  record = std::move(found);
  return true;
}

namespace {

// Takes the sound records of a text; where the first other line begins.
std::size_t take_records(std::string_view text, std::size_t from,
                         std::vector<JournalRecord>& records) {
  while (from < text.size()) {
    const std::size_t end = text.find('\n', from);
    JournalRecord record;
    if (end == std::string_view::npos ||
        !parse_journal_line(std::string(text.substr(from, end - from)), record))
      break;
    records.push_back(std::move(record));
    from = end + 1;
  }
  return from;
}

[[noreturn]] void refuse_other(const std::string& path) {
  throw InputError(
      path +
      ": written for another study, seed or version of Papilla, or for its maps as they "
      "were, which alone goes on with it and verifies it; a new run needs another "
      "folder");
}

// The journal as it is, beside it; its path.
std::string keep_copy(const Folder& folder, const std::string& name, const std::string& text) {
  std::string copy = name + ".damaged";
  for (int k = 2; folder.has(copy); ++k) {
    if (folder.read(copy) == text) return folder.path(copy);
    copy = fmt::format("{}.damaged.{}", name, k);
  }
  folder.write(copy, text);
  return folder.path(copy);
}

}  // namespace

Journal::Journal(const Folder& folder, const std::string& name, const std::string& key, bool resume)
    : path_(folder.path(name)), file_(folder.open_to_write(name)) {
  const std::string text = read_bytes(file_, path_, std::size_t{1} << 31);
  const std::string first = header(key);
  std::size_t sound = 0;  // bytes that are whole records
  if (text.size() >= first.size() || !first.starts_with(text)) {
    if (!text.starts_with(first)) refuse_other(path_);
    sound = take_records(text, first.size(), records_);
  }
  if (!records_.empty() && !resume) {
    throw InputError(path_ +
                     ": this folder holds an earlier run; continue it with --resume, or choose "
                     "another --out folder");
  }
  lost_ = static_cast<int>(
      std::count(text.begin() + static_cast<std::ptrdiff_t>(sound), text.end(), '\n'));
  // A torn line is the trace of a kill, but for one that lacks its end alone: that is damage.
  const std::string tail = text.substr(sound);
  JournalRecord whole;
  if (lost_ > 0 || (!tail.empty() && parse_journal_line(tail.substr(0, tail.size() - 1), whole)))
    copy_ = keep_copy(folder, name, text);
  if (::ftruncate(file_.get(), static_cast<off_t>(sound)) != 0 ||
      ::lseek(file_.get(), 0, SEEK_END) < 0)
    throw InputError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
  if (sound == 0) write(first);
}

// Onto the disk.
void Journal::write(std::string_view text) const {
  const auto fail = [this] {
    throw FailedWrite(fmt::format("cannot write {}: {}; free some space and use --resume", path_,
                                  std::strerror(errno)));
  };
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(file_.get(), text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail();
    done += static_cast<std::size_t>(n);
  }
  if (::fdatasync(file_.get()) != 0) fail();
}

void Journal::append(const JournalRecord& record) {
  write(journal_line(record));
  records_.push_back(record);
}

JournalReader::JournalReader(const std::string& key) : header_(header(key)) {}

std::vector<JournalRecord> JournalReader::more(const Folder& folder, const std::string& name) {
  std::vector<JournalRecord> out;
  if (!folder.has(name)) return out;
  const std::string text = folder.read_from(name, read_);
  std::size_t from = 0;
  if (read_ == 0) {
    if (text.size() < header_.size() && header_.starts_with(text)) return out;  // just begun
    if (!text.starts_with(header_)) refuse_other(folder.path(name));
    from = header_.size();
  }
  read_ += take_records(text, from, out);
  return out;
}

}  // namespace papilla::optim
