#include "optim/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "base/error.h"

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

Journal::Journal(const std::string& path, const std::string& key, bool resume) : path_(path) {
  std::size_t sound = 0;  // bytes that are whole records
  {
    std::ifstream in(path, std::ios::binary);
    if (in) {
      std::stringstream buffer;
      buffer << in.rdbuf();
      const std::string text = buffer.str();
      if (text.size() >= header(key).size() || !header(key).starts_with(text)) {
        if (!text.starts_with(header(key))) {
          throw InputError(
              path + ": written for another study, seed or version; use another --out folder");
        }
        sound = header(key).size();
        while (sound < text.size()) {
          const std::size_t end = text.find('\n', sound);
          JournalRecord record;
          if (end == std::string::npos ||
              !parse_journal_line(text.substr(sound, end - sound), record))
            break;
          records_.push_back(std::move(record));
          sound = end + 1;
        }
      }
      lost_ = static_cast<int>(
          std::count(text.begin() + static_cast<std::ptrdiff_t>(sound), text.end(), '\n'));
      if (!records_.empty() && !resume) {
        throw InputError(path +
                         ": this folder holds an earlier run; continue it with --resume, or choose "
                         "another --out folder");
      }
    }
  }
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  const auto fail = [&] {
    throw InputError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  };
  if (file_ < 0) fail();
  if (::ftruncate(file_, static_cast<off_t>(sound)) != 0 || ::lseek(file_, 0, SEEK_END) < 0) fail();
  if (sound == 0) {
    const std::string first = header(key);
    if (::write(file_, first.data(), first.size()) != static_cast<ssize_t>(first.size())) fail();
  }
}

Journal::~Journal() {
  if (file_ >= 0) ::close(file_);
}

void Journal::append(const JournalRecord& record) {
  const std::string line = journal_line(record);
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t n = ::write(file_, line.data() + done, line.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw FailedWrite(fmt::format("cannot write {}: {}; free some space and use --resume", path_,
                                    std::strerror(errno)));
    done += static_cast<std::size_t>(n);
  }
  ::fdatasync(file_);
  records_.push_back(record);
}

}  // namespace papilla::optim
