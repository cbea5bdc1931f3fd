#include "studio/safety.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/check.h"
#include "base/error.h"

namespace papilla::studio {
namespace {

namespace fs = std::filesystem;

// Takes as long for a wrong first letter as for a wrong last one.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

bool plain(const std::string& part) {
  constexpr std::size_t kLongest = 200;
  return !part.empty() && part.size() <= kLongest && part.front() != '.' &&
         std::none_of(part.begin(), part.end(), [](unsigned char c) {
           return c < 0x20 || c == 0x7f || c == '\\' || c == ':';
         });
}

}  // namespace

std::string make_token() {
  std::array<std::uint8_t, 16> bytes{};
  const ssize_t got = ::getrandom(bytes.data(), bytes.size(), 0);
  PAPILLA_CHECK(got == static_cast<ssize_t>(bytes.size()), "random bytes of the system");
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : bytes) {
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

Door::Door(std::string token, int port) : token_(std::move(token)), port_(port) {}

Entry Door::judge(const Sender& sender) const {
  const std::string port = std::to_string(port_);
  const bool known = sender.host == "127.0.0.1:" + port || sender.host == "localhost:" + port;
  if (!known) return Entry::WrongHost;
  // A browser always names the origin of a request that changes something.
  if (!sender.origin.empty() && sender.origin != "http://" + sender.host) return Entry::WrongOrigin;
  const std::size_t end = sender.path.find('/', 1);
  const bool comes = sender.visits && !sender.changes && end == sender.path.size() - 1;
  if (!comes && !sender.fetch_site.empty() && sender.fetch_site != "same-origin" &&
      (sender.changes || sender.fetch_site != "none"))
    return Entry::WrongOrigin;
  if (end == std::string::npos || !same(std::string_view(sender.path).substr(1, end - 1), token_))
    return Entry::WrongToken;
  return Entry::Admitted;
}

std::string Door::below_token(const std::string& path) const {
  return path.substr(1 + token_.size());
}

std::string Door::address() const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/" + token_ + "/";
}

fs::path inside(const fs::path& folder, const std::string& name) {
  const auto refuse = [&](const char* why) -> fs::path {
    throw InputError({Problem{name, 0, 0, "", why}});
  };
  const fs::path given(name);
  if (name.empty() || given.is_absolute())
    return refuse("expected a name inside the folder of the studio");
  for (const fs::path& part : given) {
    if (!plain(part.string()))
      return refuse("expected a name of plain letters inside the folder of the studio");
  }
  fs::path place = fs::weakly_canonical(folder);
  for (const fs::path& part : given) {
    place /= part;
    std::error_code none;
    if (fs::is_symlink(fs::symlink_status(place, none)))
      return refuse("is behind a link, and those of its folder the studio does not follow");
  }
  return place;
}

}  // namespace papilla::studio
